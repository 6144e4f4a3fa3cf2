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

// Frames are counted from media time 0. If the times of successive chunks nearly match, the difference is taken as
// rounding and the chunks are joined; a real gap is a silence, and overlaps are dropped.
class SoundWindow {
 public:
  explicit SoundWindow(const AudioFormat& format) : format_(format) {}

  void add(const AudioChunk& chunk);
  // Drops pieces that end before `frame`.
  void dropBefore(std::int64_t frame);
  void clear() { pieces_.clear(); }
  // Copies frames from `first` on into `out`, with silence in the gaps and before the beginning. Returns the number of
  // frames, which is 0 from `end` on.
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
