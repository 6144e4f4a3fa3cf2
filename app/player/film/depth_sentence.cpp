// SPDX-License-Identifier: Apache-2.0
// One sentence for each kind of depth code.
#include "app/player/film/depth_sentence.h"

#include "platform/print.h"

namespace relievo {

std::string depthSentence(const DepthCalibration& c) {
  if (c.unit_mm) return print("distances from %.6g to %.6g mm", c.near_mm, c.far_mm);
  const bool near_high = c.polarity == DepthPolarity::NearIsHigh;
  std::string text = c.code == DepthCode::Hue ? (near_high ? "the hue: red is far" : "the hue: red is near")
                                              : (near_high ? "brighter is nearer" : "darker is nearer");
  text += print(", in %.0f steps", c.highCode() - c.lowCode() + 1);
  if (c.law == DepthLaw::Inverse) text += print(" of 1/distance from %.6g to %.6g mm", c.near_mm, c.far_mm);
  return text;
}

}  // namespace relievo
