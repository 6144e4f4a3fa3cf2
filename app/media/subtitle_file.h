// SPDX-License-Identifier: Apache-2.0
// A subtitle file, read at once.
#pragma once

#include <deque>
#include <string>

#include "app/media/pair_reader.h"
#include "hal/media/subtitle_decoder.h"

namespace relievo {

// All lines of the file `path`: it is small, and they may come in any order. Blocking: reads the file.
[[nodiscard]] Result<std::deque<Subtitle>> readSubtitleFile(const std::string& path,
                                                            const PairReader::Backends& backends);

}  // namespace relievo
