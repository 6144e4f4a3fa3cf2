// SPDX-License-Identifier: Apache-2.0
// Looks at a PNG's chunks before FFmpeg decodes it: its time for the texts grows with the square of their number, and
// what it unpacks takes memory several times.
#pragma once

#include <cstdint>

#include "drivers/ffmpeg/bounds/readable.h"

namespace relievo::ffmpeg {

// 100,000 texts take FFmpeg minutes, in which nothing can interrupt it; programs write up to a hundred.
inline constexpr int kMostTexts = 1000;
// To count them takes a second. libpng writes a chunk for 8 KiB of the picture.
inline constexpr int kMostChunks = 100000;
// Of compressed texts and colour profiles, once they are unpacked; they become up to a thousand times as long. As long
// as the profile of a JPEG may be, which has 255 parts of 64 KiB.
inline constexpr std::uint64_t kMostUnpackedBytes = 16'777'216;
inline constexpr const char* kTooMuchPng =
    "it is a PNG with more than 1000 texts, 16 MiB of compressed texts and colour profiles, or 100000 chunks, the most "
    "that it may have; save it anew without them";

// Which bound it exceeds, or null. Null for what is no PNG, and for what cannot be read: FFmpeg says what is wrong with
// it.
[[nodiscard]] const char* exceededPngBound(const Readable& picture);

}  // namespace relievo::ffmpeg
