// SPDX-License-Identifier: Apache-2.0
// What a PairReader needs to read all that the programs read.
#pragma once

#include "app/media/pair_reader.h"
#include "drivers/registry.h"

namespace relievo {

inline const PairReader::Backends kReal{.make_source = drivers::makeMediaSource,
                                        .make_decoder = drivers::makeSoftwareDecoder};

}  // namespace relievo
