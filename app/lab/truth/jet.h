// SPDX-License-Identifier: Apache-2.0
// Forward differentiation: a number with its first and second derivatives by x and y, for exact surfaces.
#pragma once

#include <cmath>

namespace relievo {

// The arithmetic that the shapes need, by the rules of sum, product and chain; nothing is approximated.
struct Jet {
  double v = 0;
  double x = 0, y = 0;
  double xx = 0, xy = 0, yy = 0;

  constexpr Jet() = default;
  constexpr Jet(double value) : v(value) {}  // a constant; converts where a formula has one
  constexpr Jet(double value, double by_x, double by_y) : v(value), x(by_x), y(by_y) {}
  constexpr Jet(double value, double by_x, double by_y, double by_xx, double by_xy, double by_yy)
      : v(value), x(by_x), y(by_y), xx(by_xx), xy(by_xy), yy(by_yy) {}
};

constexpr Jet operator+(const Jet& a, const Jet& b) {
  return {a.v + b.v, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}
constexpr Jet operator-(const Jet& a, const Jet& b) {
  return {a.v - b.v, a.x - b.x, a.y - b.y, a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
}
constexpr Jet operator*(const Jet& a, const Jet& b) {
  return {a.v * b.v,
          a.x * b.v + a.v * b.x,
          a.y * b.v + a.v * b.y,
          a.xx * b.v + 2 * a.x * b.x + a.v * b.xx,
          a.xy * b.v + a.x * b.y + a.y * b.x + a.v * b.xy,
          a.yy * b.v + 2 * a.y * b.y + a.v * b.yy};
}
inline Jet sqrt(const Jet& a) {
  const double root = std::sqrt(a.v);
  const double first = 0.5 / root, second = -0.25 / (root * a.v);
  return {root,
          first * a.x,
          first * a.y,
          first * a.xx + second * a.x * a.x,
          first * a.xy + second * a.x * a.y,
          first * a.yy + second * a.y * a.y};
}

constexpr double valueOf(double a) {
  return a;
}
constexpr double valueOf(const Jet& a) {
  return a.v;
}

// max(a, 0); to be raised to the third power at least, so that the second derivatives stay continuous.
constexpr double positivePart(double a) {
  return a > 0 ? a : 0;
}
constexpr Jet positivePart(const Jet& a) {
  return a.v > 0 ? a : Jet{};
}

}  // namespace relievo
