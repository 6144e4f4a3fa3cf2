// SPDX-License-Identifier: Apache-2.0
// Recognises two views of one scene, and the depth of the left one, by the names that data sets use.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace relievo::pictures {

struct StereoNames {
  std::string left, right;
  std::string depth;  // disparities or distances of the left view; empty if there are none
};

enum class Named : bool { Pictures, Folders };

// Among the names of pictures, or of folders, in a folder:
//   im0, im1, disp0                  Middlebury 2014 and 2021, ETH3D
//   im2, im6, disp2                  Middlebury 2001 and 2003; the other views are left out
//   view1, view5, disp1              Middlebury 2005 and 2006, likewise
//   left, right, disp or depth       and other words for them
//   image_left, image_right          TartanAir; Spring's frame_left, frame_right
//   image_02, image_03               KITTI, else its gray image_00 and image_01
//   cam0, cam1                       EuRoC and others, unless there is a third
// The last three are folders alone: pictures of such names are a series. Of two files of disparities the one with
// numbers is taken: a PFM rather than a PNG. nullopt if these are no two views.
[[nodiscard]] std::optional<StereoNames> stereoAmong(const std::vector<std::string>& names, Named named);

struct ViewSeries {
  std::vector<std::string> left, right;
};
// The pictures of two views in one folder: "l_1.png" or "im_left_1.png" for each "r_1.png" or "im_right_1.png". nullopt
// if a name says neither, says depth or a mask, or has no partner.
[[nodiscard]] std::optional<ViewSeries> viewsAmong(const std::vector<std::string>& names);

}  // namespace relievo::pictures
