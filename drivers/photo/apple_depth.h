// SPDX-License-Identifier: Apache-2.0
// What the codes of a depth map in an iPhone's photo mean (Apple's pixeldatainfo in its XMP).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace relievo::photo {

// Disparities in 1/m, or distances in m, of the lowest and the highest code.
struct DepthRange {
  double low = 0, high = 0;
  bool distances = false;
};

// As the map's XMP says; nullopt if it says no range.
[[nodiscard]] std::optional<DepthRange> appleRange(std::string_view xmp);

// Whether this is the XMP of disparities or distances: that of a matte, which is a map of depth by its type too, names
// what it is besides.
[[nodiscard]] bool isAppleDepth(std::string_view xmp);

// The DEPTH_ tags of such a map of `bits`; near and far are left out if the range is unknown.
[[nodiscard]] std::map<std::string, std::string> depthTags(const std::optional<DepthRange>& range, int bits);

}  // namespace relievo::photo
