// SPDX-License-Identifier: Apache-2.0
// Four pixels at a time: a small vector of floats with the arithmetic that the sample scene needs, and the same
// functions for a plain double, so that one template gives both the fast picture and the exact reference.
#pragma once

#include <algorithm>
#include <cmath>

namespace relievo::lanes {

constexpr int kLanes = 4;
using FloatVector = float __attribute__((vector_size(16)));
using MaskVector = int __attribute__((vector_size(16)));

struct MaskLanes {
  MaskVector v;
  friend MaskLanes operator&(MaskLanes a, MaskLanes b) { return {a.v & b.v}; }
  friend MaskLanes operator|(MaskLanes a, MaskLanes b) { return {a.v | b.v}; }
  friend MaskLanes operator!(MaskLanes a) { return {~a.v}; }
};

struct FloatLanes {
  FloatVector v;
  FloatLanes() : v{} {}
  FloatLanes(FloatVector vector) : v(vector) {}  // NOLINT(google-explicit-constructor): it stands in for a number
  FloatLanes(double x) : v(FloatVector{} + static_cast<float>(x)) {}  // NOLINT(google-explicit-constructor): likewise
  [[nodiscard]] float operator[](int lane) const { return v[lane]; }
  friend FloatLanes operator+(FloatLanes a, FloatLanes b) { return {a.v + b.v}; }
  friend FloatLanes operator-(FloatLanes a, FloatLanes b) { return {a.v - b.v}; }
  friend FloatLanes operator*(FloatLanes a, FloatLanes b) { return {a.v * b.v}; }
  friend FloatLanes operator/(FloatLanes a, FloatLanes b) { return {a.v / b.v}; }
  friend FloatLanes operator-(FloatLanes a) { return {-a.v}; }
  friend MaskLanes operator<(FloatLanes a, FloatLanes b) { return {a.v < b.v}; }
  friend MaskLanes operator>(FloatLanes a, FloatLanes b) { return {a.v > b.v}; }
};

[[nodiscard, gnu::always_inline]] inline FloatLanes select(MaskLanes m, FloatLanes a, FloatLanes b) {
  return {m.v ? a.v : b.v};
}
[[nodiscard, gnu::always_inline]] inline FloatLanes min(FloatLanes a, FloatLanes b) {
  return {a.v < b.v ? a.v : b.v};
}
[[nodiscard, gnu::always_inline]] inline FloatLanes max(FloatLanes a, FloatLanes b) {
  return {a.v > b.v ? a.v : b.v};
}
[[nodiscard, gnu::always_inline]] inline FloatLanes abs(FloatLanes a) {
  return max(a, -a);
}
[[nodiscard, gnu::always_inline]] inline FloatLanes sqrt(FloatLanes a) {
  return FloatVector{std::sqrt(a.v[0]), std::sqrt(a.v[1]), std::sqrt(a.v[2]), std::sqrt(a.v[3])};
}
[[nodiscard, gnu::always_inline]] inline bool any(MaskLanes m) {
  return (m.v[0] | m.v[1] | m.v[2] | m.v[3]) != 0;
}

[[nodiscard, gnu::always_inline]] inline double select(bool m, double a, double b) {
  return m ? a : b;
}
[[nodiscard, gnu::always_inline]] inline double min(double a, double b) {
  return std::min(a, b);
}
[[nodiscard, gnu::always_inline]] inline double max(double a, double b) {
  return std::max(a, b);
}
[[nodiscard, gnu::always_inline]] inline double abs(double a) {
  return std::abs(a);
}
[[nodiscard, gnu::always_inline]] inline double sqrt(double a) {
  return std::sqrt(a);
}
[[nodiscard, gnu::always_inline]] inline bool any(bool m) {
  return m;
}

// Lane 0 is `first`, each next lane is `step` more.
[[nodiscard, gnu::always_inline]] inline FloatLanes ramp(double first, double step) {
  const auto f = static_cast<float>(first);
  const auto s = static_cast<float>(step);
  return FloatVector{f, f + s, f + 2 * s, f + 3 * s};
}

template <class T>
[[nodiscard, gnu::always_inline]] inline T clamp(T x, T low, T high) {
  return min(max(x, low), high);
}

// 0 below `low`, 1 above `high`, a smooth cubic between them.
template <class T>
[[nodiscard, gnu::always_inline]] inline T smoothStep(T x, double low, double high) {
  const T s = clamp<T>((x - T(low)) / T(high - low), T(0.0), T(1.0));
  return s * s * (T(3.0) - T(2.0) * s);
}

// Sine with an error under 3e-6 over the few turns that patterns and waves need.
[[nodiscard, gnu::always_inline]] inline double sine(double x) {
  return std::sin(x);
}
[[nodiscard, gnu::always_inline]] inline FloatLanes sine(FloatLanes x) {
  const FloatLanes turns = x * 0.15915494309189535;
  constexpr float kRoundToWhole = 12582912.0F;  // 1.5 * 2^23: adding it leaves no bits for a fraction
  const FloatVector whole = (turns.v + kRoundToWhole) - kRoundToWhole;
  const FloatLanes a = (turns - FloatLanes(whole)) * 6.283185307179586;  // in [-pi, pi]
  // sin a = sin(pi - a): folded into [-pi/2, pi/2], where the odd polynomial is good.
  const FloatLanes folded =
      select(abs(a) > 1.5707963267948966,
             select(a > 0.0, FloatLanes(3.141592653589793), FloatLanes(-3.141592653589793)) - a, a);
  const FloatLanes s = folded * folded;
  return folded * (1.0 + s * (-0.16666667 + s * (0.0083333310 + s * (-0.00019840874 + s * 2.7525562e-6))));
}

template <class T>
struct Vec3 {
  T x, y, z;
  friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
};

template <class T>
[[nodiscard, gnu::always_inline]] inline T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
[[nodiscard, gnu::always_inline]] inline T length(const Vec3<T>& a) {
  return sqrt(dot(a, a));
}
template <class T>
[[nodiscard, gnu::always_inline]] inline Vec3<T> mix(const Vec3<T>& a, const Vec3<T>& b, T share_of_b) {
  return a + (b - a) * share_of_b;
}
template <class T, class M>
[[nodiscard, gnu::always_inline]] inline Vec3<T> select(M m, const Vec3<T>& a, const Vec3<T>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

}  // namespace relievo::lanes
