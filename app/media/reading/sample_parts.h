// SPDX-License-Identifier: Apache-2.0
// The parts of a sample, and the numbers whose bytes they are.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "hal/media/samples.h"

namespace relievo {

// How many rows to go on by, so that a photo is examined no longer than a VGA picture, of which each row is.
inline int rowStep(const Frame& frame) noexcept {
  constexpr std::int64_t kMostExamined = 1 << 19;  // samples
  return static_cast<int>(std::max<std::int64_t>(1, std::int64_t{frame.width} * frame.height / kMostExamined));
}

inline bool isPackable(const Frame& frame) noexcept {
  return frame.model == ColorModel::Rgb && frame.components[0].bits == 8;
}

inline std::uint32_t partAt(const Frame& frame, std::size_t part, int c, int r) noexcept {
  return codeAt(frame, frame.components[part], c, r);
}

inline std::uint32_t numberAt(const Frame& frame, int c, int r) noexcept {
  return partAt(frame, 2, c, r) << 16 | partAt(frame, 1, c, r) << 8 | partAt(frame, 0, c, r);
}

// TartanAir: the bytes of a float in blue, green, red and alpha, the lowest first; metres.
inline float floatAt(const Frame& frame, int c, int r) noexcept {
  const std::uint32_t top = codeAt(frame, *frame.alpha, c, r);
  const std::uint32_t low = partAt(frame, 1, c, r) << 8 | partAt(frame, 2, c, r);
  return std::bit_cast<float>(top << 24 | partAt(frame, 0, c, r) << 16 | low);
}

}  // namespace relievo
