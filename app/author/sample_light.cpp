// SPDX-License-Identifier: Apache-2.0
// The curve from light to bytes, as a table.
#include "app/author/sample_light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relievo::sample {
namespace {

constexpr int kSteps = 8192;
constexpr double kWhite = 4.0;

std::array<std::uint8_t, kSteps + 1> makeCurve() {
  std::array<std::uint8_t, kSteps + 1> curve{};
  for (int i = 0; i <= kSteps; ++i) {
    const double x = kWhite * i / kSteps;
    const double y = x * (1 + x * 0.16) / (1 + x * 0.42);
    const double s = y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055;
    curve[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(std::clamp(s, 0.0, 1.0) * 255));
  }
  return curve;
}

}  // namespace

std::uint8_t toByte(float light) noexcept {
  static const std::array<std::uint8_t, kSteps + 1> curve = makeCurve();
  constexpr auto kScale = static_cast<float>(kSteps / kWhite);
  const float step = std::clamp(light * kScale + 0.5F, 0.0F, static_cast<float>(kSteps));
  return curve[static_cast<std::size_t>(step)];
}

}  // namespace relievo::sample
