// SPDX-License-Identifier: Apache-2.0
// Where a simulated hand wants to be: a path of its own, or that of a script.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/failure.h"
#include "platform/realtime.h"

namespace relievo {

struct HandPoint {
  glm::dvec3 position_mm{0};  // device frame
  // How hard the hand's spring pulls along each axis at most: a hand that strokes gives way sooner than it
  // lags.
  double force_limit_n = std::numeric_limits<double>::infinity();
};

class HandPath {
 public:
  struct Row {
    double t_s = 0;
    glm::dvec3 position_mm{0};
  };

  // Rests in front of the scene, comes down to its middle (or where it was told to begin), strokes over it in a
  // Lissajous figure with a pressure that swells between 1 and 2 N, and lifts every 4 s; for ever. It aims below the
  // far plane, so that any surface stops it: what it presses with is its limit, wherever the surface is.
  HandPath() = default;

  // Straight from row to row; before the first row it is there already, and at the last one it stays. The
  // spring pulls without a limit. The rows' times increase.
  explicit HandPath(std::vector<Row> rows) : rows_(std::move(rows)) {}

  // CSV in the device frame: the line `t_s,x_mm,y_mm,z_mm`, then one row a line. InvalidArgument otherwise,
  // and the failure names the script's line.
  [[nodiscard]] static Outcome<HandPath> parse(std::string_view csv, const std::string& script_name);
  // NotFound when the file cannot be read.
  [[nodiscard]] static Outcome<HandPath> load(const std::string& path);

  // The first place that it comes down to; a script has its own.
  void beginOver(double x_mm, double y_mm) noexcept { begin_mm_ = {x_mm, y_mm}; }

  [[nodiscard]] HandPoint at(double t_s) const RELIEVO_RT;

 private:
  glm::dvec2 begin_mm_{0};
  std::vector<Row> rows_;  // none: the hand's own path
};

}  // namespace relievo
