// SPDX-License-Identifier: Apache-2.0
// Stabilises disparities from picture to picture where the picture shows the same objects.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/motion/motion_field.h"
#include "app/stereo/disparity_map.h"
#include "app/stereo/quick/motion_grid.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// Each pixel is tracked along the motion of the left view. While it shows the same, its disparity is the mean of those
// found since it appeared, so that noise and the matcher's rounding cannot be felt. Motion toward the viewer or away
// covers an area: that part of the change is taken at once. Where another surface is found on the same object, the two
// views decide between them; a surface that keeps being found is accepted in the end. Uncovered pixels, and those that
// changed colour, take the new disparity. Use from one thread; keeps its memory.
class SteadyDisparity {
 public:
  // Call if the next map does not continue the last one.
  void begin() noexcept { before_.reset(); }
  // The views must be as large as the map.
  void steady(DisparityMap& map, const ViewPicture& left, const ViewPicture& right);

 private:
  // A pixel's values in the picture before.
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

  std::optional<GrayPicture> before_;             // small, for motion estimation
  std::vector<std::uint8_t> left_, left_before_;  // three bytes a pixel
  std::vector<std::uint8_t> left_luma_, right_luma_;
  std::vector<float> disparity_;            // steadied, of the picture before
  std::vector<std::uint8_t> age_, strays_;  // pictures, of the picture before
  std::vector<std::uint16_t> changes_;      // levels, since the picture before
  std::vector<std::uint8_t> still_;         // 1: still shows the same
  std::vector<Was> was_;
  MotionGrid towards_;
};

}  // namespace relievo
