// SPDX-License-Identifier: Apache-2.0
// Draws one picture that shows the enhancement: colour, depth before and after, and the heights along a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/author/package/picture.h"
#include "app/author/preview/png_picture.h"
#include "app/enhance/depth_map.h"
#include "app/scene/display_volume.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// Depth is drawn as a relief lit from above left, so that felt roughness is visible; holes are violet. The line is the
// row whose enhanced heights span the most; below the panes it is drawn in profile, before in orange, after in blue,
// one grid line per millimetre of a film 40 mm deep. There is no text.
class Preview {
 public:
  // Call for every depth picture before its enhancement, with the colour of that time and the film's box.
  // Keeps the middle one of the film, or the first if the length is unknown.
  void before(const ColorPicture420& color, const DisplayVolume& box, const Frame& depth,
              const DepthCalibration& calibration, std::optional<std::uint64_t> expected);
  // Call for every depth picture after its enhancement, at its original time.
  void after(const Frame& depth, const DepthCalibration& calibration);

  // NotFound if no picture was seen both before and after.
  [[nodiscard]] Result<RgbPicture> draw() const;
  [[nodiscard]] Result<void> writePng(const std::string& path) const;

 private:
  std::uint64_t seen_ = 0;
  bool waits_ = false;  // until the depth of `time_` comes out
  MediaTime time_;
  DisplayVolume box_;
  ColorPicture420 color_;
  DepthMap before_, after_;
};

}  // namespace relievo
