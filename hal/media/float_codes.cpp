// SPDX-License-Identifier: Apache-2.0
// Chooses the scale of a film of floats.
#include "hal/media/float_codes.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace relievo {
namespace {

constexpr std::size_t kMostExamined = 1 << 16;  // samples of the first picture
constexpr double kOutliers = 0.002;
constexpr double kAloneFactor = 10;     // the value of "nothing there" is so many times the next smaller one
constexpr double kCodesInUse = 0x7fff;  // half of them: later pictures may reach farther

// 1, 2 or 5 times a power of ten, at least `least`.
double roundUp(double least) noexcept {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - 1e-12)) return factor * power;
  }
  return 10 * power;
}

// The evenly spaced samples that are numbers and no hole, sorted.
std::vector<float> examined(const std::function<float(std::size_t)>& sample, std::size_t count, bool& turned) {
  std::vector<float> positive, negative;
  const std::size_t step = std::max<std::size_t>(1, count / kMostExamined);
  for (std::size_t i = 0; i < count; i += step) {
    const float value = sample(i);
    if (value > 0 && value < FloatCodes::kNothingThere) positive.push_back(value);
    if (value < 0 && value > -FloatCodes::kNothingThere) negative.push_back(-value);
  }
  // A constant below zero is a way to say "nothing there".
  std::sort(negative.begin(), negative.end());
  turned = negative.size() > 4 * positive.size() && negative.front() != negative.back();
  if (turned) return negative;
  std::sort(positive.begin(), positive.end());
  return positive;
}

}  // namespace

std::optional<FloatCodes> FloatCodes::chosenFor(const std::function<float(std::size_t)>& sample, std::size_t count) {
  bool turned = false;
  std::vector<float> values = examined(sample, count, turned);
  float nothing_from = kNothingThere;
  if (!values.empty()) {
    const auto top = std::lower_bound(values.begin(), values.end(), values.back());
    if (top != values.begin() && *top >= static_cast<float>(kAloneFactor) * *(top - 1)) {
      nothing_from = static_cast<float>(std::sqrt(kAloneFactor)) * *(top - 1);
      values.erase(top, values.end());
    }
  }
  if (values.empty()) return std::nullopt;
  const auto last = static_cast<std::size_t>(std::ceil((1 - kOutliers) * static_cast<double>(values.size() - 1)));
  const double largest = std::max(static_cast<double>(values[last]), 1e-30);
  return FloatCodes((turned ? -1 : 1) * roundUp(largest / kCodesInUse), nothing_from);
}

std::uint16_t FloatCodes::codeOf(float value) const noexcept {
  const float v = positive(value);
  if (isHole(v)) return kHole;
  const double code = std::round(static_cast<double>(v) / std::abs(value_per_code_));
  return static_cast<std::uint16_t>(std::clamp(code, 1.0, static_cast<double>(kHighest)));
}

bool FloatCodes::isBeyond(float value) const noexcept {
  const float v = positive(value);
  return !isHole(v) && static_cast<double>(v) > (kHighest + 0.5) * std::abs(value_per_code_);
}

}  // namespace relievo
