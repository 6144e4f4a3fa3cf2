// SPDX-License-Identifier: Apache-2.0
// Reads from pictures' names when each was taken.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relievo::pictures {

// "1305031102.1753" -> nanoseconds, exactly: no floating point. nullopt for anything else, and beyond 9e9 seconds.
[[nodiscard]] std::optional<std::int64_t> nanosecondsIn(std::string_view seconds) noexcept;

// "40" -> 40. nullopt for anything else, and beyond 64 bits.
[[nodiscard]] std::optional<std::int64_t> integerIn(std::string_view text) noexcept;

enum class NameKind : std::uint8_t {
  Seconds,  // times, in ns
  Numbers,  // numbers that count the pictures
  Ranks,    // neither: the place in natural order
};
struct NameValues {
  NameKind kind = NameKind::Ranks;
  std::vector<std::int64_t> values;  // one for each name, all different
};

// `names` are file names without folders, of one series. Times are
//   1305031102.175304.png            seconds: the whole name, or nine digits and more with a fraction anywhere in it
//   1403636579763555584.png          19 digits are ns, 16 us, 13 ms since 1970
//   40000000.png, 80000000.png, ..   ns from the start if a million and more apart, us if ten thousand
//   100000.png, 100034.png, ..       ms, as clockUnit (clock_unit.h) says
//   0000012-000000400431.png         a number and 12 digits of us (Redwood)
// Numbers above 9e9 whose steps are of any size, such as the ids of a web site's photos, are neither.
// A number is the only run of digits that differs between names that are otherwise alike, and at most 9e9.
[[nodiscard]] NameValues valuesOf(const std::vector<std::string>& names);

// Whether names of one series differ in more than digits, or in dates ("IMG_20230101_101010") whose times are mostly
// some seconds apart, as those of photos do, or in ids.
[[nodiscard]] bool areUnrelated(const std::vector<std::string>& names);

}  // namespace relievo::pictures
