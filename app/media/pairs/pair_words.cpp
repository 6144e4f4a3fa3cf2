// SPDX-License-Identifier: Apache-2.0
// The sound and the subtitles of a film of pairs.
#include <utility>

#include "app/media/pairs/pair_film.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Duration kLongestLine = std::chrono::seconds(10);  // a seek into a line of this length still shows it
constexpr std::size_t kMostLines = 100'000;                  // of a subtitle file

}  // namespace

const StreamInfo* PairReader::Impl::streamOf(const FilmTrack& track) const {
  for (const StreamInfo& stream : sources.color()->source().streams()) {
    if (stream.index == track.stream) return &stream;
  }
  return nullptr;
}

void PairReader::Impl::openSound() {
  info.sound_codec.clear();
  info.sound_refused = nullptr;
  if (!options.sound || !backends.make_audio_decoder || !info.sound || *info.sound >= info.sounds.size()) return;
  const FilmTrack& track = info.sounds[*info.sound];
  const StreamInfo* const stream = streamOf(track);
  if (stream == nullptr) return;
  info.sound_codec = track.codec;
  const auto opened = sources.color()->listen(backends.make_audio_decoder(), *stream, *options.sound);
  if (!opened) info.sound_refused = opened.error().message;
}

void PairReader::Impl::openWords() {
  sources.color()->ignoreWords();
  words_ahead.clear();
  if (!backends.make_subtitle_decoder || !info.words || *info.words >= info.subtitles.size()) return;
  const FilmTrack& track = info.subtitles[*info.words];
  if (track.stream < 0) return readWordsOf(track.path);
  const StreamInfo* const stream = streamOf(track);
  if (stream == nullptr) return;
  const Duration before = remote ? Duration(0) : kLongestLine;
  const auto opened = sources.color()->readWords(backends.make_subtitle_decoder(), *stream, before);
  if (!opened) log(LogLevel::Warning, "media", "no subtitles: %s", opened.error().message);
}

// The whole file at once: it is small, and its lines may come in any order.
void PairReader::Impl::readWordsOf(const std::string& path) {
  const auto failed = [&path](const Error& error) {
    log(LogLevel::Warning, "media", "%s: no subtitles: %s", path.c_str(), error.message);
  };
  const auto source = backends.make_source(path);
  if (auto opened = source->open(path); !opened) return failed(opened.error());
  if (source->streams().empty()) return failed({ErrorCode::Corrupt, 0, "there is no text in it"});
  const auto decoder = backends.make_subtitle_decoder();
  if (auto opened = decoder->open(source->streams().front()); !opened) return failed(opened.error());
  const Duration start = source->senderStart().value_or(Duration(0));  // its first line's time is not the film's
  while (words_ahead.size() < kMostLines) {
    const auto packet = source->read();
    if (!packet || !*packet) return;
    auto subtitle = decoder->decode(**packet);
    if (!subtitle) continue;
    subtitle->begin += start;
    if (subtitle->end) *subtitle->end += start;
    words_ahead.push_back(std::move(*subtitle));
  }
}

}  // namespace relievo
