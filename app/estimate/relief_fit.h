// SPDX-License-Identifier: Apache-2.0
// Fits the scale and offset that bring one picture's estimate to the known heights of its points.
#pragma once

#include <optional>
#include <vector>

namespace relievo {

struct FitSample {
  double estimate = 0;
  double height = 0;  // mean of `of` heights
  int of = 1;
  double weight = 1;
};

// height = scale * estimate + offset.
struct ReliefFit {
  double scale = 1, offset = 0;
  double rest = 0;  // standard deviation of the known heights from the fitted ones

  [[nodiscard]] double at(double estimate) const noexcept { return scale * estimate + offset; }
};

constexpr std::size_t kLeastSamples = 24;

// The fit that most samples agree on, robust if up to a third moved or were mismatched. Both estimates and heights are
// noisy, the heights less (Deming 1943): a fit that took either for exact would shrink the relief a little with each
// picture. `before`: the previous picture's fit, whose scale holds where the samples lie too flat to determine one.
// Nullopt with fewer than kLeastSamples, or where near and far seem exchanged.
[[nodiscard]] std::optional<ReliefFit> fitRelief(std::vector<FitSample> samples, const ReliefFit& before);

}  // namespace relievo
