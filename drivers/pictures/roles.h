// SPDX-License-Identifier: Apache-2.0
// Whether a name of a file or a folder says colour or depth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace relievo::pictures {

enum class Role : std::uint8_t {
  Unsaid,
  Color,
  Depth,
  Other,  // a mask, a label, an infrared picture, ..
};

// By the words in `name`, which anything but letters parts; "d-12.pgm" and "r-12.ppm" are depth and colour. Where these
// words say nothing, by those that they join: "KinectDepth", "depthImages", "rgbframes".
[[nodiscard]] Role roleOf(std::string_view name);

// `roleOf` of many names: those that differ from the one before in their digits alone are not looked at again.
class Roles {
 public:
  [[nodiscard]] Role of(const std::string& name);

 private:
  std::string before_;  // with 0 for each digit
  Role role_ = Role::Unsaid;
};

// The names by their roles. Where all of them say depth, as "depth_guess_rgb.jpg" and "depth_guess_depth.jpg", only the
// words tell that not all begin with, if some of these say colour and some depth.
[[nodiscard]] std::map<Role, std::vector<std::string>> byRole(const std::vector<std::string>& names);

// What the names of colour and depth of one picture share: "cat" of "cat-image.jpg" and "cat-depth.png". Without the
// ending, the words of colour and depth, and what separates the others.
[[nodiscard]] std::string keyOf(std::string_view name);

// How many keys of two series are the same; 1 if none is but the series are equally long.
[[nodiscard]] std::size_t likeness(const std::vector<std::string>& names, const std::vector<std::string>& others);

// Whether a name says that what it names is painted for the eye: "vis", "colormap".
[[nodiscard]] bool isPainted(std::string_view name);

// Keeps the pictures of a folder that are of the kind of its best depth. Left out are those that the names tell to be
// another one of the same frames: "0-depth_true.png" beside "0-depth.png", and all that are painted for the eye
// ("0-depth_vis.png") beside others. "beach" and "beach_sunset" are no frames of one number. Returns how many are left
// out.
[[nodiscard]] std::size_t keepBestDepth(std::vector<std::string>& names);

// Drops the names that say "right" if others say "left".
void keepLeftView(std::vector<std::string>& names);

// The best of the `names` with this role; empty if none has it. Depth that is not painted goes first, then what is in
// the colour's view ("aligned_depth"), then what is nothing but the word, then the first in natural order.
[[nodiscard]] std::string bestOf(const std::vector<std::string>& names, Role role);

}  // namespace relievo::pictures
