// SPDX-License-Identifier: Apache-2.0
// Pieces of sound on a line of frames.
#include "app/player/sound/sound_window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace relievo {
namespace {

constexpr Duration kRounding = std::chrono::milliseconds(10);  // of a container's or a sender's times

}  // namespace

std::int64_t SoundWindow::frameAt(MediaTime time) const noexcept {
  return std::llround(toSeconds(time) * format_.rate_hz);
}

MediaTime SoundWindow::timeOf(std::int64_t frame) const noexcept {
  return mediaTime(static_cast<double>(frame) / format_.rate_hz);
}

std::ptrdiff_t SoundWindow::samplesOf(std::int64_t frames) const noexcept {
  return static_cast<std::ptrdiff_t>(frames * format_.channels);
}

void SoundWindow::add(const AudioChunk& chunk) {
  const auto channels = static_cast<std::int64_t>(format_.channels);
  const auto frames = static_cast<std::int64_t>(chunk.samples.size()) / channels;
  std::int64_t begin = frameAt(chunk.pts);
  std::int64_t skip = 0;
  if (!empty()) {
    const std::int64_t off = begin - end();
    const std::int64_t rounding = std::llround(toSeconds(kRounding) * format_.rate_hz);
    if (std::abs(off) <= rounding) begin = end();
    skip = std::max<std::int64_t>(end() - begin, 0);
  }
  if (skip >= frames) return;
  pieces_.push_back({begin + skip, begin + frames, {chunk.samples.begin() + samplesOf(skip), chunk.samples.end()}});
}

void SoundWindow::dropBefore(std::int64_t frame) {
  while (!pieces_.empty() && pieces_.front().end <= frame) pieces_.pop_front();
}

std::size_t SoundWindow::read(std::int64_t first, std::span<float> out) const {
  if (empty() || first >= end()) return 0;
  const auto channels = static_cast<std::int64_t>(format_.channels);
  const std::int64_t last = std::min(end(), first + static_cast<std::int64_t>(out.size()) / channels);
  std::fill(out.begin(), out.end(), 0.0F);
  for (const Piece& piece : pieces_) {
    const std::int64_t from = std::max(first, piece.begin), to = std::min(last, piece.end);
    if (from >= to) continue;
    std::copy(piece.samples.begin() + samplesOf(from - piece.begin),
              piece.samples.begin() + samplesOf(to - piece.begin), out.begin() + samplesOf(from - first));
  }
  return static_cast<std::size_t>(last - first);
}

}  // namespace relievo
