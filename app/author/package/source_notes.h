// SPDX-License-Identifier: Apache-2.0
// What the author is told of a source: what it had not, and what the film does not keep of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/author/package/depth_coder.h"
#include "app/author/package/film_writer.h"
#include "app/media/pair_reader.h"

namespace relievo {

// One line each; none where the film is all that the source was.
[[nodiscard]] std::vector<std::string> sourceNotes(const SourceOptions& source, const PairReader& reader,
                                                   const FilmFormat& format, std::uint64_t interlaced,
                                                   const DepthCoder::Counts& codes);

}  // namespace relievo
