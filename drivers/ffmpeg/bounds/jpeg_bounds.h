// SPDX-License-Identifier: Apache-2.0
// Counts a JPEG's scans before FFmpeg decodes it, which goes over the whole picture for each, however short it is.
#pragma once

#include "drivers/ffmpeg/bounds/readable.h"

namespace relievo::ffmpeg {

// Each took 2 ms in a picture of 4096 x 4096. libjpeg writes 10, and its own fuzzers end at 500.
inline constexpr int kMostScans = 500;
inline constexpr const char* kTooManyScans =
    "the JPEG has more than 500 scans, which is the limit; save it anew: jpegtran -copy all FILE > new.jpg";

// Which bound it exceeds, or null. A packet may begin with something else, and may hold two fields.
[[nodiscard]] const char* exceededJpegBound(const Readable& packet);
// Null for a file that does not begin as a JPEG.
[[nodiscard]] const char* exceededJpegFileBound(const Readable& file);

}  // namespace relievo::ffmpeg
