// SPDX-License-Identifier: Apache-2.0
// Distance fields of simple solids and their smooth combinations: negative inside, smooth, with a gradient of at most
// about 1.
#pragma once

#include "app/author/sample/lanes.h"

namespace relievo::lanes {

// The field of an ellipsoid: exact on the surface to first order, nowhere larger than the distance. Inside, where the
// gradient vanishes towards the centre, the last term bounds its growth; on the surface that term is zero.
template <class T>
[[nodiscard, gnu::always_inline]] inline T ellipsoid(const Vec3<T>& p, const Vec3<T>& center,
                                                     const Vec3<double>& radii) {
  const Vec3<T> per_mm = {T(1.0 / radii.x), T(1.0 / radii.y), T(1.0 / radii.z)};
  const double thin = std::min(radii.x, std::min(radii.y, radii.z));
  const Vec3<T> unit = (p - center) * per_mm;
  const Vec3<T> slope = unit * per_mm;
  const T beyond = dot(unit, unit) - T(1.0);
  return beyond * T(0.5) / sqrt(dot(slope, slope) + max(-beyond, T(0.0)) * T(1.0 / (thin * thin)));
}

template <class T>
[[nodiscard, gnu::always_inline]] inline T sphere(const Vec3<T>& p, const Vec3<T>& center, double radius) {
  return length(p - center) - T(radius);
}

// A rod from a to b whose radius goes from `radius_a` to `radius_b`.
template <class T>
[[nodiscard, gnu::always_inline]] inline T rod(const Vec3<T>& p, const Vec3<T>& a, const Vec3<T>& b, double radius_a,
                                               double radius_b) {
  const Vec3<T> along = b - a;
  const Vec3<T> from_a = p - a;
  const T s = clamp<T>(dot(from_a, along) / dot(along, along), T(0.0), T(1.0));
  return length(from_a - along * s) - (T(radius_a) + s * T(radius_b - radius_a));
}

// Union with a fillet of about `width`: the polynomial form, which changes nothing where the two differ by more.
template <class T>
[[nodiscard, gnu::always_inline]] inline T blend(T a, T b, double width) {
  const T overlap = max(T(width) - abs(a - b), T(0.0));
  return min(a, b) - overlap * overlap * T(0.25 / width);
}
// Intersection with a rounded edge.
template <class T>
[[nodiscard, gnu::always_inline]] inline T common(T a, T b, double width) {
  return -blend<T>(-a, -b, width);
}
// Difference, a without b, with a rounded edge.
template <class T>
[[nodiscard, gnu::always_inline]] inline T carve(T a, T b, double width) {
  return -blend<T>(-a, b, width);
}

}  // namespace relievo::lanes
