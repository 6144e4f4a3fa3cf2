// SPDX-License-Identifier: Apache-2.0
// Finds the pictures that a folder, a pattern or a list names, and tells colour from depth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/error.h"

namespace relievo::pictures {

struct PictureFiles {
  std::string folder;              // with a slash at its end; empty: the working directory
  std::vector<std::string> names;  // in `folder`, in no order
};

// What an address names. Of colour and depth one may be empty, not both.
struct FoundPictures {
  PictureFiles color, depth;
  // From a list: the value of each picture, in step with the names. Else empty.
  std::vector<std::int64_t> color_values, depth_values;
  bool listed_numbers = false;  // those values are numbers, not ns
  bool paired = false;          // the list says which pictures belong together: equal values
  bool views = false;           // `depth` is no depth but the right view, `color` the left one
  std::size_t left_out = 0;     // pictures of another ending or purpose
  std::vector<std::string> notes;
};

// The path of a local address: without "file:".
[[nodiscard]] std::string pathOf(const std::string& url);

// Whether `url` is a folder, a picture or a list that exists, or a pattern of pictures' names. Reads no file.
[[nodiscard]] bool namesPictures(const std::string& url);

// A folder   with sub-folders of colour (rgb, color, image, .., or one with the depth's names) and depth (depth,
//            disparity, ..), or pictures whose names hold such words ("frame-000000.depth.png"), or two views and their
//            disparities (stereo.h), else one series; associations.txt in it is read
// A pattern  "a/b%06d.png" with any first number, or "a/*.png" in the last part of the path
// A list     associations.txt
// A picture  alone
// NotFound, with what is missing; Corrupt for a list that was named and is none.
[[nodiscard]] Result<FoundPictures> findPictures(const std::string& url);

}  // namespace relievo::pictures
