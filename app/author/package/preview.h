// SPDX-License-Identifier: Apache-2.0
// One picture of what was done to the depth: colour, depth before and after, and the heights along a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/author/package/picture.h"
#include "app/author/package/png_picture.h"
#include "app/enhance/depth_map.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// Depth is drawn as a lit relief, light from above left, so that what a finger would feel is seen; holes are violet.
// The line is the row whose heights, enhanced, span the most; below them it is drawn from the side, before in orange,
// after in blue, a grid line each millimetre of a film 40 mm deep. There is no text in it.
class Preview {
 public:
  // Every depth picture before its enhancement, with the colour of its time: the middle one of the film is kept, the
  // first where nobody knows how many there will be.
  void before(const ColorPicture420& color, const Frame& depth, const DepthCalibration& calibration,
              std::optional<std::uint64_t> expected);
  // Every one after it, at the time that it had.
  void after(const Frame& depth, const DepthCalibration& calibration);

  // Both: NotFound where no picture was seen both before and after.
  [[nodiscard]] Result<RgbPicture> draw() const;
  [[nodiscard]] Result<void> writePng(const std::string& path) const;

 private:
  std::uint64_t seen_ = 0;
  bool waits_ = false;  // for the depth of `time_` to come out
  MediaTime time_;
  double aspect_ = 1;  // of the depth's samples
  ColorPicture420 color_;
  DepthMap before_, after_;
};

}  // namespace relievo
