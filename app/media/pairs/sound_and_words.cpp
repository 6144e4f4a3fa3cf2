// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/sound_and_words.h"

#include <utility>

#include "app/media/subtitle_file.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Duration kLongestLine = std::chrono::seconds(10);  // a seek into a line of this length still shows it

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

void SoundAndWords::readWordsOf(const std::string& path) {
  auto lines = readSubtitleFile(path, film_.backends);
  if (lines) ahead_ = std::move(*lines);
  else log(LogLevel::Warning, "media", "%s: no subtitles: %s", path.c_str(), lines.error().message);
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
