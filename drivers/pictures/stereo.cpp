// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/stereo.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string_view>

#include "drivers/pictures/endings.h"
#include "hal/media/media_names.h"
#include "platform/text/lower_case.h"

namespace relievo::pictures {
namespace {

constexpr std::size_t kMostDepths = 9;
struct Layout {
  std::string_view left, right;
  std::array<std::string_view, kMostDepths> depths;  // empty at the end
  std::string_view series;                           // a picture of this name beside the views makes them a series
  Named named = Named::Pictures;                     // else of folders alone
};
constexpr std::array<std::string_view, kMostDepths> kDepths{"disp",      "disparity",      "disp_left",
                                                            "left_disp", "disparity_left", "left_disparity",
                                                            "depth",     "depth_left",     "left_depth"};
constexpr std::array<Layout, 14> kLayouts{{
    {"im2", "im6", {"disp2"}, "im3"},
    {"view1", "view5", {"disp1"}, "view2"},
    {"im0", "im1", {"disp0", "disp0gt", "depth0"}, "im2"},
    {"left", "right", kDepths, ""},
    {"left_rgb", "right_rgb", kDepths, ""},
    {"iml", "imr", {"displ", "disp", "depthl", "depth"}, ""},
    {"imgl", "imgr", {"displ", "disp", "depthl", "depth"}, ""},
    {"cam0", "cam1", {}, "cam2", Named::Folders},
    {"cam_0", "cam_1", {}, "cam_2", Named::Folders},
    {"image_left", "image_right", {}, "", Named::Folders},
    {"frame_left", "frame_right", {}, "", Named::Folders},
    {"image_00", "image_01", {}, "", Named::Folders},
    {"image_02", "image_03", {}, "", Named::Folders},
    {"image_2", "image_3", {}, "", Named::Folders},
}};

// Empty if there is none.
std::string find(const std::vector<std::string>& names, std::string_view stem) {
  std::string best;
  for (const std::string& name : names) {
    if (lowerCase(stemOf(name)) == stem && (best.empty() || depthRankOf(name) < depthRankOf(best))) best = name;
  }
  return best;
}

std::string findDepth(const std::vector<std::string>& names, const Layout& layout) {
  for (const std::string_view depth : layout.depths) {
    if (depth.empty()) break;
    if (std::string name = find(names, depth); !name.empty()) return name;
  }
  return "";
}

// Where the name has a word for the left or the right, between anything but letters.
struct Side {
  bool right = false;
  std::size_t at = 0, size = 0;
};
std::optional<Side> sideOf(std::string_view stem) {
  const auto isLetter = [](char c) { return c >= 'a' && c <= 'z'; };
  for (std::size_t at = 0, end = 0; at < stem.size(); at = end + 1) {
    end = at;
    while (end < stem.size() && isLetter(stem[end])) ++end;
    const std::string_view word = stem.substr(at, end - at);
    const bool right = word == "r" || word == "right";
    if (right || word == "l" || word == "left") return Side{right, at, word.size()};
  }
  return std::nullopt;
}

}  // namespace

std::optional<ViewSeries> viewsAmong(const std::vector<std::string>& names) {
  ViewSeries views;
  std::multiset<std::string> left, right;  // the rest of each name
  std::set<std::string> endings;           // depth may have another one
  for (const std::string& name : names) {
    std::string rest = lowerCase(stemOf(name));
    const auto side = sideOf(rest);
    const Role role = roleOf(name);
    if (!side || role == Role::Depth || role == Role::Other) return std::nullopt;
    endings.insert(endingOf(name));
    (side->right ? right : left).insert(rest.erase(side->at, side->size));
    (side->right ? views.right : views.left).push_back(name);
  }
  return left == right && endings.size() == 1 ? std::optional(std::move(views)) : std::nullopt;
}

std::optional<StereoNames> stereoAmong(const std::vector<std::string>& names, Named named) {
  std::optional<StereoNames> without_depth;
  for (const Layout& layout : kLayouts) {
    if (layout.named == Named::Folders && named == Named::Pictures) continue;
    StereoNames found{find(names, layout.left), find(names, layout.right), findDepth(names, layout)};
    if (found.left.empty() || found.right.empty()) continue;
    if (!found.depth.empty()) return found;
    if (layout.series.empty() || find(names, layout.series).empty()) without_depth = found;
  }
  return without_depth;
}

}  // namespace relievo::pictures
