// SPDX-License-Identifier: Apache-2.0
// Plain sentences, each with what is done about it.
#include "app/player/film/film_notes.h"

#include <utility>

#include "app/media/pairs/long_wait.h"
#include "app/media/tracks/film_tracks.h"
#include "app/player/film/film_changes.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {

void FilmNotes::begin(const SourceOptions& source) {
  url_ = source.url;
  depth_url_ = source.depth_url;
  slowness_told_ = wait_told_ = refuses_seeks_ = false;
  waits_since_.reset();
}

void FilmNotes::waits(MonotonicTime now) {
  if (!waits_since_) waits_since_ = now;
  if (wait_told_ || now - *waits_since_ <= kLongWait) return;
  wait_told_ = true;
  tellWait("play", url_, depth_url_);
}

void FilmNotes::opened(const FilmInfo& info) {
  if (info.has_depth) {
    const std::string line = plainLine(info.reading, info.calibration.calibration);
    log(LogLevel::Info, "play", "%s", line.c_str());
  }
  for (const std::string& line : info.notes) log(LogLevel::Info, "play", "%s", line.c_str());
  for (const std::string& change : changesOf(info)) log(LogLevel::Warning, "play", "%s", change.c_str());
  for (const std::string& offer : info.reading.offers) log(LogLevel::Info, "play", "%s", offer.c_str());
  for (const std::string& doubt : info.reading.doubts) log(LogLevel::Warning, "play", "%s", doubt.c_str());
  if (!info.has_depth) journal_.note("no depth in this film", "it plays flat, without force");
  if (info.sound_refused != nullptr) refusedSound(info, info.sound_refused);
}

void FilmNotes::refusedSound(const FilmInfo& info, const char* why) {
  const std::string track = info.sounds.size() > 1 ? " " + describeTrack(info.sounds, info.sound) : "";
  journal_.note("sound" + track + ": " + why, "the film plays without");
}

void FilmNotes::refusedWords(const FilmInfo& info, std::size_t track, const char* why) {
  journal_.note("subtitles " + describeTrack(info.subtitles, track) + ": " + why, "the film plays without");
}

void FilmNotes::happened(const FilmFeed::News& news, const FilmInfo& info) {
  using Kind = FilmFeed::News::Kind;
  const bool color = news.kind == Kind::ColorLost || news.kind == Kind::ColorBack;
  const std::string& url = color || depth_url_.empty() ? url_ : depth_url_;
  switch (news.kind) {
    case Kind::ColorLost:
      return journal_.note(
          url + " lost: " + news.why,
          print("reconnecting; the film stops after %.0f s without it", toSeconds(FilmFeed::kPatience)), news.time);
    case Kind::DepthLost:
      return journal_.note(url + " lost: " + news.why, "the film plays on without depth and force; reconnecting",
                           news.time);
    case Kind::ColorBack:
      return journal_.note(url + " found again", "the film goes on", news.time);
    case Kind::DepthBack:
      return journal_.note(url + " found again", "its depth is felt again", news.time);
    case Kind::DecoderRestarted:
      return journal_.note(news.why, news.done, news.time);
    case Kind::SoundRefused:
      return refusedSound(info, news.why);
    case Kind::WordsRefused:
      return refusedWords(info, news.track, news.why);
  }
}

void FilmNotes::refused(const Error& seek) {
  refuses_seeks_ = true;
  journal_.note(std::string("seek: ") + seek.message, "the film continues from its present position");
}

void FilmNotes::slow() {
  if (std::exchange(slowness_told_, true)) return;
  journal_.note("this computer is too slow for all pictures of the film",
                "some are left out; sound and touch go on as they are");
}

std::vector<LostPart> FilmNotes::missing(const PairCounters& pairs) {
  std::vector<LostPart> parts = lostParts(url_, depth_url_, pairs);
  for (const LostPart& part : parts) {
    journal_.note(toText(part),
                  part.of_depth ? "the rest was shown without depth and force" : "the part that exists was played");
  }
  return parts;
}

}  // namespace relievo
