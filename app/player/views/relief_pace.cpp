// SPDX-License-Identifier: Apache-2.0
#include "app/player/views/relief_pace.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

constexpr double kShare = 0.6;       // of a picture's time
constexpr double kSmooth = 24;       // pictures a second: if there are more, not each needs a relief
constexpr double kFull = 0.9;        // of the time between two reliefs: making one must not take longer
constexpr double kSpareAgain = 0.7;  // of the same time: below it, reliefs are made more often again
constexpr double kNewest = 0.2;      // weight of the last cost

}  // namespace

Duration ReliefPace::budget() const noexcept {
  return fromSeconds(kShare * std::max(toSeconds(period_), 1 / kSmooth));
}

void ReliefPace::took(Duration cost) noexcept {
  const double cost_s = toSeconds(cost), period_s = toSeconds(period_);
  mean_s_ = mean_s_ == 0 ? cost_s : mean_s_ + kNewest * (cost_s - mean_s_);
  if (mean_s_ > kFull * stride_ * period_s) stride_ = static_cast<int>(std::ceil(mean_s_ / (kFull * period_s)));
  while (stride_ > 1 && mean_s_ < kSpareAgain * (stride_ - 1) * period_s) --stride_;
}

double ReliefPace::reliefsPerSecond() const noexcept {
  return 1 / (stride_ * toSeconds(period_));
}

bool ReliefPace::isSlow() const noexcept {
  return stride_ > 1 && reliefsPerSecond() < kSmooth;
}

}  // namespace relievo
