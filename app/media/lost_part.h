// SPDX-License-Identifier: Apache-2.0
// What a film lacks because its sources were not whole, in the words and with the end that all programs give.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "platform/failure.h"

namespace relievo {

struct LostPart {
  std::string url;
  bool of_depth = false;  // `url` is the depth's alone
  Duration length{0};     // announced, and not there; 0: it is there and damaged
  std::uint64_t damaged = 0;
};

// Known after the film's end; none of a whole film.
[[nodiscard]] std::vector<LostPart> lostParts(const std::string& url, const std::string& depth_url,
                                              const PairCounters& counters);

// "film.mkv lacks at least 2.4 s: truncated or damaged", "film.mkv: 3 damaged packets or pictures were left out"
[[nodiscard]] std::string toText(const LostPart& part);

// With this ends a run that made do with the rest: what was asked for was the whole film.
[[nodiscard]] Failure failureOf(const LostPart& part);

}  // namespace relievo
