// SPDX-License-Identifier: Apache-2.0
// Each demand is compared with its limit; the first one that is not met decides.
#include "app/lab/scenario/judge.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace relievo {
namespace {

constexpr double kSceneSlewNPerS = 50;

}  // namespace

void Judge::add(const Verdict& verdict) {
  if (!first_) first_ = verdict;
  if (!verdict.pass && !failed_) failed_ = verdict;
}

void Judge::atMost(double figure, const Limit& limit, const std::string& why) {
  add({figure <= limit.value, figure, limit, why});
}

void Judge::atLeast(double figure, const Limit& limit, const std::string& why) {
  add({figure >= limit.value, figure, limit, why});
}

void Judge::bounds(std::span<const StageTick> ticks, double stiffness_n_per_mm, double peak_force_n) {
  double force = 0, slew = 0;
  const StageTick* before = nullptr;
  for (const StageTick& tick : ticks) {
    if (!tick.exchanged || !std::isfinite(glm::dot(tick.hip_mm, tick.hip_mm))) continue;
    const double size = glm::length(tick.sent_n);
    force = std::isfinite(size) ? std::max(force, size) : std::numeric_limits<double>::infinity();
    if (before != nullptr) {
      const double by_hand = stiffness_n_per_mm * glm::length(tick.hip_mm - before->hip_mm);
      slew = std::max(slew, (glm::length(tick.sent_n - before->sent_n) - by_hand) / (tick.t_s - before->t_s));
    }
    before = &tick;
  }
  atMost(force, {peak_force_n * (1 + 1e-9), "N", "derived: what the haptic task promises"}, "largest force");
  atMost(slew, {kSceneSlewNPerS * (1 + 1e-6), "N/s", "derived: what the haptic task promises"},
         "fastest change of the force by the scene");
}

}  // namespace relievo
