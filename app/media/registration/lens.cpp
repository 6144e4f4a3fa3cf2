// SPDX-License-Identifier: Apache-2.0
// Evaluates the lens, and inverts it by Newton's method.
#include "app/media/registration/lens.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relievo {
namespace {

constexpr double kRadiusStep = 0.01, kLargestRadius = 4;  // 76 degrees off the axis
constexpr int kMostSteps = 30;
constexpr double kExactTo = 1e-9;  // far below a thousandth of a pixel

}  // namespace

Lens::Lens(const Coefficients& coefficients) noexcept
    : c_(coefficients), largest_r2_(std::numeric_limits<double>::infinity()) {
  bends_ = std::ranges::any_of(c_, [](double value) { return value != 0; });
  if (!bends_) return;
  double r = 0;
  constexpr int kRadii = static_cast<int>(kLargestRadius / kRadiusStep);
  for (int i = 1; i <= kRadii; ++i) {
    const double next = i * kRadiusStep;
    const Radial there = radial(next * next);
    const double growth = there.factor + 2 * next * next * there.slope;
    if (!(growth > 0) || !(there.factor > 0) || !std::isfinite(growth)) break;
    r = next;
  }
  largest_r2_ = r * r;
}

Lens::Radial Lens::radial(double r2) const noexcept {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = c_;
  const double above = 1 + r2 * (k1 + r2 * (k2 + r2 * k3)), below = 1 + r2 * (k4 + r2 * (k5 + r2 * k6));
  const double above_slope = k1 + r2 * (2 * k2 + r2 * 3 * k3), below_slope = k4 + r2 * (2 * k5 + r2 * 3 * k6);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

Lens::Bent Lens::bend(Point ray) const noexcept {
  const auto [x, y] = ray;
  const double p1 = c_[2], p2 = c_[3], r2 = x * x + y * y;
  const auto [f, slope] = radial(r2);
  return {.point = {x * f + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * f + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y},
          .dxx = f + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x,
          .dxy = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y,
          .dyy = f + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x};
}

std::optional<Lens::Seen> Lens::see(Point ray) const noexcept {
  if (!bends_) return Seen{.point = ray};
  if (!(ray.x * ray.x + ray.y * ray.y <= largest_r2_)) return std::nullopt;
  const Bent bent = bend(ray);
  return Seen{.point = bent.point, .scale_x = std::abs(bent.dxx), .scale_y = std::abs(bent.dyy)};
}

std::optional<Lens::Point> Lens::rayAt(Point seen) const noexcept {
  if (!bends_) return seen;
  Point ray = seen;
  for (int step = 0; step < kMostSteps; ++step) {
    const double r2 = ray.x * ray.x + ray.y * ray.y;
    if (!std::isfinite(r2)) return std::nullopt;
    const double inward = r2 > largest_r2_ ? std::sqrt(largest_r2_ / r2) : 1;
    ray = {ray.x * inward, ray.y * inward};
    const Bent bent = bend(ray);
    const double dx = seen.x - bent.point.x, dy = seen.y - bent.point.y;
    if (std::abs(dx) < kExactTo && std::abs(dy) < kExactTo) return ray;
    const double determinant = bent.dxx * bent.dyy - bent.dxy * bent.dxy;
    ray.x += (bent.dyy * dx - bent.dxy * dy) / determinant;
    ray.y += (bent.dxx * dy - bent.dxy * dx) / determinant;
  }
  return std::nullopt;
}

}  // namespace relievo
