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
constexpr double kLeastBelow = 0.02;      // of the values of a film that has some on both sides of 0
constexpr float kBesideZero = 1.0F / 16;  // of their range, in which there are some too, on both sides
constexpr double kLeastBesideZero = 0.005;
constexpr std::size_t kConstant = 4;     // the lowest value stands for "nothing there" if one in so many below 0 has it
constexpr double kFirstOfLifted = 1024;  // the code of its lowest value: later pictures may reach lower
constexpr double kAloneFactor = 10;      // the value of "nothing there" is so many times the next smaller one
constexpr float kSame = 0.999F;          // a far plane that was computed from a depth buffer is not exact
constexpr double kCodesInUse = 0x7fff;   // half of them: later pictures may reach farther

// 1, 2 or 5 times a power of ten, at least `least`.
double roundUp(double least) noexcept {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - 1e-12)) return factor * power;
  }
  return 10 * power;
}

// The evenly spaced samples that are numbers, sorted, by their sign and without it.
struct Examined {
  std::vector<float> positive, negative;
};
Examined examined(const std::function<float(std::size_t)>& sample, std::size_t count) {
  auto [positive, negative] = Examined{};
  const std::size_t step = std::max<std::size_t>(1, count / kMostExamined);
  for (std::size_t i = 0; i < count; i += step) {
    const float value = sample(i);
    if (value > 0 && value < FloatCodes::kNothingThere) positive.push_back(value);
    if (value < 0 && value > -FloatCodes::kNothingThere) negative.push_back(-value);
  }
  std::sort(negative.begin(), negative.end());
  std::sort(positive.begin(), positive.end());
  return {std::move(positive), std::move(negative)};
}

// The value with a share `kOutliers` of all above it.
double highestOf(const std::vector<float>& sorted) {
  const auto last = static_cast<std::size_t>(std::ceil((1 - kOutliers) * static_cast<double>(sorted.size() - 1)));
  return static_cast<double>(sorted[last]);
}

// Takes out the highest value if it lies alone, far beyond the others. Returns what is "nothing there" from there on.
float cutAlone(std::vector<float>& sorted) {
  if (sorted.empty()) return FloatCodes::kNothingThere;
  const auto top = std::lower_bound(sorted.begin(), sorted.end(), kSame * sorted.back());
  if (top == sorted.begin() || *top < static_cast<float>(kAloneFactor) * *(top - 1)) return FloatCodes::kNothingThere;
  const float from = static_cast<float>(std::sqrt(kAloneFactor)) * *(top - 1);
  sorted.erase(top, sorted.end());
  return from;
}

// Whether the values go through 0. A constant below 0 is a way to say "nothing there", and distances that are wrong or
// behind the camera leave a gap between those below 0 and the nearest one above.
bool goThroughZero(const Examined& values) {
  const auto& [positive, negative] = values;
  if (positive.empty() || negative.empty()) return false;
  const auto constant = negative.end() - std::lower_bound(negative.begin(), negative.end(), negative.back());
  const auto all = static_cast<double>(positive.size() + negative.size());
  const float beside = kBesideZero * static_cast<float>(highestOf(positive) + highestOf(negative));
  const auto areBeside = [&](const std::vector<float>& sorted) {
    const auto count = std::upper_bound(sorted.begin(), sorted.end(), beside) - sorted.begin();
    return static_cast<double>(count) >= kLeastBesideZero * all;
  };
  return kConstant * static_cast<std::size_t>(constant) < negative.size() &&
         static_cast<double>(negative.size()) >= kLeastBelow * all && areBeside(positive) && areBeside(negative);
}

}  // namespace

std::optional<FloatCodes> FloatCodes::chosenFor(const std::function<float(std::size_t)>& sample, std::size_t count) {
  Examined all = examined(sample, count);
  const float from = cutAlone(all.positive), below = cutAlone(all.negative);
  const bool turned = all.negative.size() > 4 * all.positive.size() && all.negative.front() != all.negative.back();
  if (!turned && goThroughZero(all)) {
    const double lowest = -highestOf(all.negative), highest = highestOf(all.positive);
    const double step = roundUp((highest - lowest) / (kCodesInUse - kFirstOfLifted));
    return FloatCodes(step, {-below, from}, lowest - kFirstOfLifted * step);
  }
  const std::vector<float>& values = turned ? all.negative : all.positive;
  if (values.empty()) return std::nullopt;
  const double largest = std::max(highestOf(values), 1e-30);
  return FloatCodes((turned ? -1 : 1) * roundUp(largest / kCodesInUse), {0, turned ? below : from});
}

std::optional<double> FloatCodes::placeOf(float value) const noexcept {
  const float positive = value_per_code_ < 0 ? -value : value;
  if (!(positive > valid_.above && positive < valid_.below)) return std::nullopt;
  return (static_cast<double>(positive) - value_at_zero_) / std::abs(value_per_code_);
}

std::uint16_t FloatCodes::codeOf(float value) const noexcept {
  const auto place = placeOf(value);
  if (!place) return kHole;
  return static_cast<std::uint16_t>(std::clamp(std::round(*place), 1.0, static_cast<double>(kHighest)));
}

bool FloatCodes::isBeyond(float value) const noexcept {
  return placeOf(value).value_or(0) > kHighest + 0.5;
}

}  // namespace relievo
