// SPDX-License-Identifier: Apache-2.0
// Keeps disparities steady from picture to picture where the picture shows the same things.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/motion/motion_field.h"
#include "app/stereo/disparity_map.h"
#include "app/stereo/quick/motion_grid.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// Each pixel is followed along the motion of the left view. Where it shows what it showed before, its disparity is the
// mean of those that were found since, so that noise and a matcher's rounding are not felt. What moves to the viewer or
// away does so over an area: that part of the change is taken at once. Where another surface is found at the same
// thing, the two views decide between both; a surface that keeps being found is believed in the end. What has come to
// light, or changed its colour, is taken as found. Use from one thread; keeps its memory.
class SteadyDisparity {
 public:
  // The next map continues nothing.
  void begin() noexcept { before_.reset(); }
  // Views as large as the map.
  void steady(DisparityMap& map, const ViewPicture& left, const ViewPicture& right);

 private:
  // What a pixel had in the picture before.
  struct Was {
    float disparity = 0;
    std::uint8_t age = 0, strays = 0;
    bool same = false, moved = false;
  };

  void follow(DisparityMap& map, const GrayPicture& now);
  [[nodiscard]] bool agrees(const DisparityMap& map, std::size_t i) const noexcept;
  [[nodiscard]] Was movedTo(const DisparityMap& map, int c, int r, const Motion& motion) const;
  void findStill(const DisparityMap& map);
  [[nodiscard]] bool showsTheSame(const DisparityMap& map, int c, int r, int dx, int dy) const;
  void choose(DisparityMap& map, int c, int r, Was& was) const;
  [[nodiscard]] int misfit(const DisparityMap& map, int c, int r, float disparity) const;
  void findChanges(const DisparityMap& map);
  void average(DisparityMap& map);

  std::optional<GrayPicture> before_;             // small, in which motion is looked for
  std::vector<std::uint8_t> left_, left_before_;  // three bytes a pixel
  std::vector<std::uint8_t> left_luma_, right_luma_;
  std::vector<float> disparity_;            // of the picture before, as steady as it was
  std::vector<std::uint8_t> age_, strays_;  // pictures, of the picture before
  std::vector<std::uint16_t> changes_;      // levels, since the picture before
  std::vector<std::uint8_t> still_;         // 1: shows what it showed
  std::vector<Was> was_;
  MotionGrid towards_;
};

}  // namespace relievo
