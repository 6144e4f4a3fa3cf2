// SPDX-License-Identifier: Apache-2.0
// Depth pictures from two views.
#pragma once

#include <cstdint>
#include <optional>

#include "app/scene/depth_calibration.h"
#include "app/stereo/disparity_map.h"
#include "app/stereo/quick/small_view.h"
#include "app/stereo/stereo_plan.h"
#include "app/stereo/view_picture.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// The size at which views of this size are matched: smaller if many disparities in a large view would need more than
// 0.6 GB of memory. 1920 x 1080 are matched whole over up to 96 disparities, 5 % of the width, and 3840 x 2160 at that
// size over 192 of them.
[[nodiscard]] ViewSize matchedSize(ViewSize view, DisparityRange range);

// The disparity of two views that lie row by row: matched from both eyes, holes filled, steps moved to the outlines.
[[nodiscard]] DisparityMap disparityOf(const ViewPicture& left, const ViewPicture& right, DisparityRange range);

// For comparison in charts and tests: one of OpenCV's matchers alone, as its documentation uses it, on brightness; each
// hole takes the farther of its two sides in its row.
enum class PlainMatcher : std::uint8_t { SemiGlobal, Blocks };
[[nodiscard]] DisparityMap plainDisparityOf(const ViewPicture& left, const ViewPicture& right, DisparityRange range,
                                            PlainMatcher matcher = PlainMatcher::SemiGlobal);

class StereoDepth {
 public:
  explicit StereoDepth(StereoPlan plan) : plan_(std::move(plan)) {}

  // Codes of 16 bits, linear in disparity over the shot's range, near high; none is a hole.
  [[nodiscard]] static DepthCalibration calibration();
  [[nodiscard]] const StereoPlan& plan() const noexcept { return plan_; }

  // As large as the left view, with its time. Call it picture by picture: in the black of a fade or after a cut, the
  // last relief stays. Unsupported if the size is not the plan's.
  [[nodiscard]] Result<Frame> depthOf(const Frame& left, const Frame& right);

 private:
  StereoPlan plan_;
  std::optional<Frame> last_;
};

}  // namespace relievo
