// SPDX-License-Identifier: Apache-2.0
// Counts a PNG's texts before FFmpeg decodes it: its time for them grows with the square of their number, and they take
// memory several times.
#pragma once

#include <cstdint>
#include <span>

#include "platform/files/answered_file.h"

namespace relievo::ffmpeg {

// 100,000 texts take FFmpeg minutes, in which nothing can interrupt it; programs write up to a hundred.
inline constexpr int kMostTexts = 1000;
// To count them takes a second. libpng writes a chunk for 8 KiB of the picture.
inline constexpr int kMostChunks = 100000;
// Of compressed texts, which become up to a thousand times as long.
inline constexpr std::uint64_t kMostPackedBytes = 131072;
inline constexpr const char* kTooManyTexts =
    "it is a PNG with more than 1000 texts, 128 KiB of compressed ones, or 100000 chunks, the most that it may have; "
    "save it anew without them";

// False for what is no PNG, and for what cannot be read: FFmpeg says what is wrong with it.
[[nodiscard]] bool hasTooManyTexts(std::span<const std::uint8_t> picture);
[[nodiscard]] bool hasTooManyTexts(const AnsweredFile& file);

}  // namespace relievo::ffmpeg
