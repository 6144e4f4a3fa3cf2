// SPDX-License-Identifier: Apache-2.0
// What a PairReader needs to read files with FFmpeg.
#pragma once

#include <memory>
#include <string>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"

namespace relievo {

inline const PairReader::Backends kFfmpeg{[](const std::string&) { return makeFfmpegSource(); },
                                          [](const StreamInfo&) { return makeFfmpegDecoder(); }};

}  // namespace relievo
