// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/sound_and_words.h"

#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

constexpr Duration kLongestLine = std::chrono::seconds(10);  // a seek into a line of this length still shows it
constexpr std::size_t kMostLines = 100'000;                  // of a subtitle file

}  // namespace

const StreamInfo* SoundAndWords::streamOf(const FilmTrack& track) const {
  for (const StreamInfo& stream : film_.sources.color()->source().streams()) {
    if (stream.index == track.stream) return &stream;
  }
  return nullptr;
}

void SoundAndWords::openSound() {
  film_.info.sound_codec.clear();
  film_.info.sound_refused = nullptr;
  if (!film_.options.sound || !film_.backends.make_audio_decoder || !film_.info.sound ||
      *film_.info.sound >= film_.info.sounds.size())
    return;
  const FilmTrack& track = film_.info.sounds[*film_.info.sound];
  const StreamInfo* const stream = streamOf(track);
  if (stream == nullptr) return;
  film_.info.sound_codec = track.codec;
  const auto opened = film_.sources.color()->listen(film_.backends.make_audio_decoder(), *stream, *film_.options.sound);
  if (!opened) film_.info.sound_refused = opened.error().message;
}

void SoundAndWords::openWords() {
  film_.sources.color()->ignoreWords();
  ahead_.clear();
  if (!film_.backends.make_subtitle_decoder || !film_.info.words || *film_.info.words >= film_.info.subtitles.size())
    return;
  const FilmTrack& track = film_.info.subtitles[*film_.info.words];
  if (track.stream < 0) return readWordsOf(track.path);
  const StreamInfo* const stream = streamOf(track);
  if (stream == nullptr) return;
  const Duration before = film_.remote ? Duration(0) : kLongestLine;
  const auto opened = film_.sources.color()->readWords(film_.backends.make_subtitle_decoder(), *stream, before);
  if (!opened) log(LogLevel::Warning, "media", "no subtitles: %s", opened.error().message);
}

// The whole file at once: it is small, and its lines may come in any order.
void SoundAndWords::readWordsOf(const std::string& path) {
  const auto failed = [&path](const Error& error) {
    log(LogLevel::Warning, "media", "%s: no subtitles: %s", path.c_str(), error.message);
  };
  const auto source = film_.backends.make_source(path);
  if (auto opened = source->open(path); !opened) return failed(opened.error());
  if (source->streams().empty()) return failed({ErrorCode::Corrupt, 0, "there is no text in it"});
  const auto decoder = film_.backends.make_subtitle_decoder();
  if (auto opened = decoder->open(source->streams().front()); !opened) return failed(opened.error());
  const Duration start = source->senderStart().value_or(Duration(0));  // its first line's time is not the film's
  while (ahead_.size() < kMostLines) {
    const auto packet = source->read();
    if (!packet || !*packet) return;
    auto subtitle = decoder->decode(**packet);
    if (!subtitle) continue;
    subtitle->begin += start;
    if (subtitle->end) *subtitle->end += start;
    ahead_.push_back(std::move(*subtitle));
  }
}

std::optional<AudioChunk> SoundAndWords::nextSound(Duration shift) {
  auto chunk = film_.sources.color() ? film_.sources.color()->nextSound() : std::nullopt;
  if (chunk) chunk->pts += shift;
  return chunk;
}

std::optional<Subtitle> SoundAndWords::nextWords(Duration shift) {
  if (!ahead_.empty()) {
    std::optional<Subtitle> subtitle(std::move(ahead_.front()));
    ahead_.pop_front();
    return subtitle;
  }
  auto subtitle = film_.sources.color() ? film_.sources.color()->nextWords() : std::nullopt;
  if (!subtitle) return subtitle;
  subtitle->begin += shift;
  if (subtitle->end) *subtitle->end += shift;
  return subtitle;
}

}  // namespace relievo
