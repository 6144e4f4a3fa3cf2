// SPDX-License-Identifier: Apache-2.0
// Tells numbers that count pictures from times and from the ids of a web site.
#pragma once

#include <cstdint>
#include <vector>

namespace relievo::pictures {

// Every number above this is too great to count pictures; so many seconds are beyond what 64 bits of ns hold.
inline constexpr std::int64_t kMostSeconds = 9'000'000'000;

// The ns of a unit if the numbers of one series are times: ms, us or ns since 1970 after 2001; numbers above 9e9, as no
// numbers have that count pictures (ns if they are usually 4 million and more apart, else us); or at least three
// numbers in regular steps of a million (ns) or ten thousand (us), or of 33 and 34 by turns (ms). Else 0.
[[nodiscard]] std::int64_t clockUnit(std::vector<std::int64_t> values);

// Whether numbers that are too great to count pictures are the ids of a web site: they lie far apart, and their steps
// are of any size or seconds long. Times since a device was switched on may be irregular, but lie closer.
[[nodiscard]] bool areIds(std::vector<std::int64_t> values);

}  // namespace relievo::pictures
