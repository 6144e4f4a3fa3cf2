// SPDX-License-Identifier: Apache-2.0
// The tone curve from light to bytes.
#include "app/author/sample/sample_light.h"

#include <algorithm>
#include <cmath>

namespace relievo::sample {

FilmCurve::FilmCurve() noexcept {
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(kScale);
    const double y = x * (1 + x * 0.16) / (1 + x * 0.42);
    const double s = y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055;
    table_[i] = static_cast<std::uint8_t>(std::lround(std::clamp(s, 0.0, 1.0) * 255));
  }
}

}  // namespace relievo::sample
