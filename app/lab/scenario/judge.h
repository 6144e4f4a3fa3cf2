// SPDX-License-Identifier: Apache-2.0
// The verdict on one method in one scenario.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "app/lab/finger/touch_stage.h"

namespace relievo {

struct Limit {
  double value = 0;
  const char* unit = "";
  // Why the limit has this value: "derived: ..", "cited: ..", or "chosen: .." for a value that was picked to tell
  // methods apart. Without a comma, since it is a cell of a CSV.
  const char* origin = "";
};

struct Verdict {
  bool pass = true;
  double figure = 0;  // the figure that decided
  Limit limit;
  std::string why;  // what the figure is, one line
};

// Demands in the order of their weight: the first that is not met decides; if all are met, the first of all.
class Judge {
 public:
  // A figure that is not a number fails.
  void atMost(double figure, const Limit& limit, const std::string& why);
  void atLeast(double figure, const Limit& limit, const std::string& why);
  // Demands of every scenario: the force is finite and at most the peak, and the scene changes it no faster than the
  // slew limit. Judges the forces that were sent, not what the safety filter says of them.
  void bounds(std::span<const StageTick> ticks, double stiffness_n_per_mm, double peak_force_n = 10);
  void add(const Verdict& verdict);

  [[nodiscard]] const Verdict& verdict() const { return *(failed_ ? failed_ : first_); }

 private:
  std::optional<Verdict> first_, failed_;
};

}  // namespace relievo
