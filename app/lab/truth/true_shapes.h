// SPDX-License-Identifier: Apache-2.0
// The shapes of the true surfaces at rest: closed forms z(x, y) in mm, for double and for Jet alike.
#pragma once

#include <cmath>

#include "app/lab/truth/jet.h"

namespace relievo::shapes {

struct Plane {
  double z0_mm = 0, slope_x = 0, slope_y = 0;

  template <class T>
  [[nodiscard]] T operator()(const T& x, const T& y) const {
    return T(z0_mm) + T(slope_x) * x + T(slope_y) * y;
  }
};

// Exactly a sphere within kExactMm of its middle; from there on it goes over into the floor, twice differentiable.
struct SphereCap {
  static constexpr double kRadiusMm = 40, kCentreZMm = -4, kFloorMm = 6;
  static constexpr double kExactMm = 28, kEndMm = 38;

  template <class T>
  [[nodiscard]] T operator()(const T& x, const T& y) const {
    using std::sqrt;
    const T r2 = x * x + y * y;
    if (valueOf(r2) >= kEndMm * kEndMm) return T(kFloorMm);
    const T sphere = T(kCentreZMm) + sqrt(T(kRadiusMm * kRadiusMm) - r2);
    if (valueOf(r2) <= kExactMm * kExactMm) return sphere;
    const T s = (r2 - T(kExactMm * kExactMm)) * T(1 / (kEndMm * kEndMm - kExactMm * kExactMm));
    const T fade = s * s * s * (T(10) + s * (T(6) * s - T(15)));
    return sphere + fade * (T(kFloorMm) - sphere);
  }
};

// An elliptic bump of finite extent: (1 - u)^4 with u = ((x - cx)/rx)^2 + ((y - cy)/ry)^2; three times differentiable.
struct Bump {
  double height_mm = 0, cx_mm = 0, cy_mm = 0, rx_mm = 1, ry_mm = 1;

  template <class T>
  [[nodiscard]] T operator()(const T& x, const T& y) const {
    const T du = (x - T(cx_mm)) * T(1 / rx_mm), dv = (y - T(cy_mm)) * T(1 / ry_mm);
    const T rest = positivePart(T(1) - du * du - dv * dv);
    const T square = rest * rest;
    return T(height_mm) * square * square;
  }
};

// A head of 33 mm with its nose, whose tip has a radius of curvature of 7 mm, and two eye sockets. Its tightest convex
// place is that tip, so that a finger pressed 5 mm deep has one closest point everywhere.
struct Face {
  static constexpr double kFloorMm = 4, kHeadMm = 26, kHeadRxMm = 60, kHeadRyMm = 52;
  static constexpr Bump kNose{7, 0, -4, 21.5, 32};
  static constexpr Bump kLeftEye{-3.5, -17, 14, 17, 17};
  static constexpr Bump kRightEye{-3.5, 17, 14, 17, 17};

  template <class T>
  [[nodiscard]] T operator()(const T& x, const T& y) const {
    const T du = x * T(1 / kHeadRxMm), dv = y * T(1 / kHeadRyMm);
    const T rest = positivePart(T(1) - du * du - dv * dv);
    const T head = T(kHeadMm) * rest * rest * rest * (T(2.5) - T(1.5) * rest);
    return T(kFloorMm) + head + kNose(x, y) + kLeftEye(x, y) + kRightEye(x, y);
  }
};

// A straight fold across a floor, (1 - (q/w)^2)^3 of the distance q to its slanted middle line: twice differentiable,
// 3 mm wide at half its height. A negative height makes a groove.
struct Fold {
  static constexpr double kFloorMm = 20, kHalfExtentMm = 3.3;
  static constexpr double kNormalX = 0.96, kNormalY = -0.28;  // a unit vector
  double height_mm = 0;

  template <class T>
  [[nodiscard]] T operator()(const T& x, const T& y) const {
    const T u = (T(kNormalX) * x + T(kNormalY) * y) * T(1 / kHalfExtentMm);
    const T rest = positivePart(T(1) - u * u);
    return T(kFloorMm) + T(height_mm) * rest * rest * rest;
  }
};

}  // namespace relievo::shapes
