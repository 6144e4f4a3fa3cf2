// SPDX-License-Identifier: Apache-2.0
// Text files that name pictures with their times: associations.txt, rgb.txt and depth.txt of the TUM layout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace relievo::pictures {

struct ListedPicture {
  std::int64_t value = 0;  // the time: ns, or a number
  std::string name;
};
struct PictureList {
  bool numbers = false;                           // the times are whole numbers that count the pictures
  std::vector<std::vector<ListedPicture>> lines;  // of one picture each, or of two that belong together
};

// Whole numbers may be times (clockUnit).
//
// Lines of "TIME PICTURE" (`pictures` 1) or "TIME PICTURE TIME PICTURE" (2), parted by blanks, tabs or commas; # begins
// a comment. Corrupt with the format if a line is anything else, or if there is none; Exhausted beyond a million lines.
[[nodiscard]] Result<PictureList> parsePictureList(std::string_view text, std::size_t pictures);

}  // namespace relievo::pictures
