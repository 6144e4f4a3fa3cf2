// SPDX-License-Identifier: Apache-2.0
// The scale and offset that bring one picture's estimate to the heights that are known of its points.
#pragma once

#include <optional>
#include <vector>

namespace relievo {

struct FitSample {
  double estimate = 0;
  double height = 0;  // the mean of so many
  int of = 1;
  double weight = 1;
};

// height = scale * estimate + offset.
struct ReliefFit {
  double scale = 1, offset = 0;
  double rest = 0;  // of the heights that follow it: their standard deviation

  [[nodiscard]] double at(double estimate) const noexcept { return scale * estimate + offset; }
};

constexpr std::size_t kLeastSamples = 24;

// What most samples agree on, robust against a third that moved or were taken for others. Both estimates and heights
// are noisy, the heights less (Deming 1943): a fit that took one of them for exact would shrink the relief a little
// with each picture. `before`: the fit of the picture before, whose scale holds where the samples lie too flat to tell
// one. Nullopt with fewer than kLeastSamples, or where near and far seem exchanged.
[[nodiscard]] std::optional<ReliefFit> fitRelief(std::vector<FitSample> samples, const ReliefFit& before);

}  // namespace relievo
