// SPDX-License-Identifier: Apache-2.0
// The verdict on one method in one scenario.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "app/lab/finger/touch_stage.h"

namespace relievo {

struct Verdict {
  bool pass = true;
  double figure = 0;  // what decided
  std::string unit;
  double limit = 0;
  std::string why;  // what the figure is, one line
};

// Demands in the order of their weight: the first that is not met decides; if all are met, the first of all.
class Judge {
 public:
  void atMost(double figure, double limit, const char* unit, const std::string& why);
  void atLeast(double figure, double limit, const char* unit, const std::string& why);
  // What holds in every scenario: finite, within the peak, and the scene no faster than its slew. Told by the forces
  // as they were sent, not by the filter that made them.
  void bounds(std::span<const StageTick> ticks, double stiffness_n_per_mm, double peak_force_n = 10);

  [[nodiscard]] const Verdict& verdict() const { return *(failed_ ? failed_ : first_); }

 private:
  void add(bool pass, double figure, double limit, const char* unit, const std::string& why);

  std::optional<Verdict> first_, failed_;
};

}  // namespace relievo
