// SPDX-License-Identifier: Apache-2.0
// The decoded sound around the present moment, by its place on the film's time line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "hal/media/audio_decoder.h"
#include "hal/media/media_time.h"

namespace relievo {

// Frames are counted from media time 0. Times of chunks that do not quite follow one another are taken for rounded, and
// are joined without a seam; a real gap is a silence, what overlaps is left out.
class SoundWindow {
 public:
  explicit SoundWindow(const AudioFormat& format) : format_(format) {}

  void add(const AudioChunk& chunk);
  // Forgets what ends before.
  void dropBefore(std::int64_t frame);
  void clear() { pieces_.clear(); }
  // Copies frames from `first` on into `out`, with silence in the gaps and before the beginning, and returns how many
  // there are: none from `end` on.
  [[nodiscard]] std::size_t read(std::int64_t first, std::span<float> out) const;

  [[nodiscard]] bool empty() const noexcept { return pieces_.empty(); }
  // The frame after the last one. The window must not be empty.
  [[nodiscard]] std::int64_t end() const noexcept { return pieces_.back().end; }
  [[nodiscard]] std::int64_t frameAt(MediaTime time) const noexcept;
  [[nodiscard]] MediaTime timeOf(std::int64_t frame) const noexcept;

 private:
  [[nodiscard]] std::ptrdiff_t samplesOf(std::int64_t frames) const noexcept;
  struct Piece {
    std::int64_t begin = 0, end = 0;
    std::vector<float> samples;
  };
  AudioFormat format_;
  std::deque<Piece> pieces_;  // ascending, not overlapping
};

}  // namespace relievo
