// SPDX-License-Identifier: Apache-2.0
// Tells the pictures of a folder apart by the endings of their names.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "drivers/pictures/roles.h"

namespace relievo::pictures {

// The place of a picture's ending in the order of preference for depth: formats of floating-point numbers first.
[[nodiscard]] std::ptrdiff_t depthRankOf(const std::string& name);

// Whether a picture is of numbers, or of gray of 16 bits and more in PNG or TIFF. Reads its head.
[[nodiscard]] bool holdsNumbers(const std::string& path);

// Whether a name ends as a camera's photographs do, and masks do not.
[[nodiscard]] bool holdsPhotograph(const std::vector<std::string>& names);

// Keeps the names with the most frequent ending, or, of depth with several such, the preferred one; counts the others.
[[nodiscard]] std::vector<std::string> oneKind(std::vector<std::string> names, Role role, std::size_t& left_out);

// Those of one folder's pictures that are its film: without pictures that their names tell to be something else
// ("1.pgm", "1_ab.pgm"), and depth without that of another kind or ending.
[[nodiscard]] std::vector<std::string> chosen(std::vector<std::string> names, Role role, std::size_t& left_out);

// Takes depth out of `names` where colour and its depth differ in the ending alone: "1.jpg" or a "1.png" that is not
// gray of 16 bits (heads are read) beside "1.pfm", "1.dpt", "1.npz", a "1.npy" of one plane or a "1.tif" of gray of 16
// bits and more; "1.jpg" beside a gray "1.png" of 16 bits. Or PFM beside as many other pictures, or gray of 16 bits
// among PNG. Empty if there is none.
[[nodiscard]] std::vector<std::string> takeDepthOfPhotos(const std::string& folder, std::vector<std::string>& names);

}  // namespace relievo::pictures
