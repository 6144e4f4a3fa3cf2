// SPDX-License-Identifier: Apache-2.0
// A simulated hand's target over time: a built-in motion, or the path of a script.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/sim/hand_motion.h"
#include "platform/failure.h"
#include "platform/realtime.h"

namespace relievo {

class HandPath {
 public:
  struct Row {
    double t_s = 0;
    glm::dvec3 position_mm{0};
  };

  // A built-in motion, endless; for `reach` see moveHand.
  explicit HandPath(HandMotion motion = HandMotion::Stroking, double reach = 1) noexcept
      : motion_(motion), reach_(reach) {}

  // Interpolates linearly between rows; stays at the first row before its time and at the last row after it. The
  // spring pulls without a limit. The rows' times must increase.
  explicit HandPath(std::vector<Row> rows) : rows_(std::move(rows)) {}

  // CSV in the device frame: the header `t_s,x_mm,y_mm,z_mm`, then one row per line. Otherwise InvalidArgument,
  // with the number of the line.
  [[nodiscard]] static Outcome<HandPath> parse(std::string_view csv, const std::string& script_name);
  // NotFound if the file cannot be read.
  [[nodiscard]] static Outcome<HandPath> load(const std::string& path);

  [[nodiscard]] HandPoint at(double t_s) const RELIEVO_RT;

 private:
  HandMotion motion_ = HandMotion::Stroking;
  double reach_ = 1;
  std::vector<Row> rows_;  // none: the motion
};

}  // namespace relievo
