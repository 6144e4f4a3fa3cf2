// SPDX-License-Identifier: Apache-2.0
// A film of a slope, and a hand on a Falcon that presses into it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "tests/support/device/falcon_model.h"
#include "tests/support/film/clip_maker.h"

namespace relievo::test {

inline constexpr int kSlopeCols = 180, kSlopeRows = 120;
inline constexpr int kSlopePerCol = 218, kSlopePerRow = 146;  // of 65535

// Gray. Half-way up the volume in the middle, and 0.15 mm higher for each to the right and 0.1 for each down, so that
// each leg has another share of the force.
inline void makeSlope(const std::string& path, int fps = 25) {
  constexpr int kSeconds = 8;
  const auto slope = [](int, int column, int row, int) {
    const int right = column - kSlopeCols / 2, down = row - kSlopeRows / 2;
    return static_cast<std::uint32_t>(32768 + kSlopePerCol * right + kSlopePerRow * down);
  };
  const ClipTrack color{.pix_fmt = "yuv420p",
                        .width = kSlopeCols,
                        .height = kSlopeRows,
                        .fps_num = fps,
                        .frames = fps * kSeconds,
                        .sample = [](int component, int, int, int) { return component == 0 ? 180U : 128U; },
                        .tags = {{"title", "color"}}};
  ClipTrack depth = color;
  depth.pix_fmt = "gray16le";
  depth.sample = slope;
  depth.tags = {{"title", "depth"}};
  makeClip(path, {color, depth});
}

// Once it is homed, down into the slope and in circles there.
inline void circle(FalconModel& model) {
  model.grip = [&model, homing = model.grip, homed_s = 0.0](double t_s) mutable {
    if (!model.homed()) return homing(homed_s = t_s);
    const double t = t_s - homed_s;
    return glm::dvec3(6 * std::sin(t), 6 * std::cos(t), 150 - 32 * std::min(t / 2, 1.0));
  };
}

}  // namespace relievo::test
