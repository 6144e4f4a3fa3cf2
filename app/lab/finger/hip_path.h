// SPDX-License-Identifier: Apache-2.0
// The path of a finger, as a file: one row per tick.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "platform/failure.h"

namespace relievo {

struct HipTick {
  double t_s = 0;        // from the first frame's time on
  glm::dvec3 hip_mm{0};  // scene frame
};

// Header "t_s,x_mm,y_mm,z_mm", then four numbers a row, the times ascending. The failure names the line.
[[nodiscard]] Outcome<std::vector<HipTick>> readHipPath(const std::string& path);

}  // namespace relievo
