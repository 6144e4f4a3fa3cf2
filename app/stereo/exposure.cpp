// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/exposure.h"

#include <algorithm>
#include <cmath>

namespace relievo {

void ViewTone::add(const ViewPicture& view) {
  for (std::size_t i = 0; i < view.bytes.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double code = view.bytes[i + k];
      sum_[k] += code;
      squares_[k] += code * code;
    }
  }
  count_ += static_cast<double>(view.size());
}

double ViewTone::mean(std::size_t component) const {
  return count_ > 0 ? sum_[component] / count_ : 0;
}

double ViewTone::spread(std::size_t component) const {
  const double m = mean(component);
  return count_ > 0 ? std::sqrt(std::max(0.0, squares_[component] / count_ - m * m)) : 0;
}

bool isBlank(const ViewPicture& view) {
  constexpr double kBlackSpread = 3, kBlackMean = 24, kEvenSpread = 0.5;  // levels; black of limited range is 16
  ViewTone tone;
  tone.add(view);
  return tone.spread(0) < (tone.mean(0) <= kBlackMean ? kBlackSpread : kEvenSpread);
}

bool Exposure::isNeeded() const {
  constexpr double kContrast = 0.06, kLevels = 4, kMiddle = 128;
  for (std::size_t k = 0; k < 3; ++k) {
    const double shift = gain[k] * kMiddle + offset[k] - kMiddle;
    if (std::abs(shift) > kLevels || (k == 0 && std::abs(gain[k] - 1) > kContrast)) return true;
  }
  return false;
}

Exposure exposureBetween(const ViewTone& left, const ViewTone& right) {
  constexpr double kLeastSpread = 2, kLeastGain = 0.25, kMostGain = 4;
  Exposure exposure;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool told = left.spread(k) > kLeastSpread && right.spread(k) > kLeastSpread;
    exposure.gain[k] = told ? std::clamp(left.spread(k) / right.spread(k), kLeastGain, kMostGain) : 1;
    exposure.offset[k] = left.mean(k) - exposure.gain[k] * right.mean(k);
  }
  return exposure;
}

void balance(ViewPicture& right, const Exposure& exposure) {
  std::array<std::array<std::uint8_t, 256>, 3> table{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t code = 0; code < 256; ++code) {
      const double value = exposure.gain[k] * static_cast<double>(code) + exposure.offset[k] + 0.5;
      table[k][code] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
    }
  }
  for (std::size_t i = 0; i < right.bytes.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) right.bytes[i + k] = table[k][right.bytes[i + k]];
  }
}

}  // namespace relievo
