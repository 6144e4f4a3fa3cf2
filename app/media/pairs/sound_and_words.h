// SPDX-License-Identifier: Apache-2.0
// The sound and the subtitles of a film of pairs.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "app/media/pairs/open_film.h"
#include "hal/media/subtitle_decoder.h"

namespace relievo {

// Opens what FilmInfo says is chosen. A failure leaves the film without it.
class SoundAndWords {
 public:
  explicit SoundAndWords(OpenFilm& film) : film_(film) {}

  void openSound();
  void openWords();
  // As PairReader::nextSound and nextSubtitle. `shift`: added to the session's times to get the film's.
  [[nodiscard]] std::optional<AudioChunk> nextSound(Duration shift);
  [[nodiscard]] std::optional<Subtitle> nextWords(Duration shift);
  void close() noexcept { ahead_.clear(); }

 private:
  [[nodiscard]] const StreamInfo* streamOf(const FilmTrack& track) const;
  void readWordsOf(const std::string& path);

  OpenFilm& film_;
  std::deque<Subtitle> ahead_;  // of a subtitle file
};

}  // namespace relievo
