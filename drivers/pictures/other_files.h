// SPDX-License-Identifier: Apache-2.0
// What is in a folder: pictures, folders, films, and files that hold depth in other forms, with how to convert them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace relievo::pictures {

inline constexpr const char* kNoPictures = "there is no picture in this folder; name a folder of pictures or a film";

struct Listing {
  std::vector<std::string> pictures, folders;
  std::size_t films = 0;
  const char* way = nullptr;  // to convert the first of the rest that can be, or the last that says depth
};
// Lists a folder, with or without a slash at its end, if this opening may list one more; else NotFound.
[[nodiscard]] Result<Listing> listingOf(const std::string& folder, std::size_t& may_list);

// One line for a user, FOLDER being the folder's name; null for a name of no such file. Of a .mat file in `folder`
// the head is read.
[[nodiscard]] const char* wayToConvert(const std::string& folder, std::string_view name);

}  // namespace relievo::pictures
