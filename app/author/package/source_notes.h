// SPDX-License-Identifier: Apache-2.0
// Notes for the author about a source: what was missing in it, and what the film does not preserve.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/author/package/depth_coder.h"
#include "app/author/package/film_writer.h"
#include "app/media/lost_part.h"
#include "app/media/pair_reader.h"

namespace relievo {

// One line each; none if the film preserves everything of the source.
[[nodiscard]] std::vector<std::string> sourceNotes(const std::vector<LostPart>& lost, const FilmInfo& info,
                                                   const PairCounters& counters, const FilmFormat& format,
                                                   const DepthCoder::Counts& codes);

// Notes for a source whose sound and subtitles were to be kept but cannot be.
[[nodiscard]] std::vector<std::string> notKept(const FilmInfo& info, const KeptWishes& keep);

}  // namespace relievo
