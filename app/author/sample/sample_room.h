// SPDX-License-Identifier: Apache-2.0
// The wall behind the bust of the sample film: a blue roundel in a beaded frame, rosettes in the corners.
#pragma once

#include "app/author/sample/sample_look.h"

namespace relievo::sample {

// A height field in stage millimetres, found without ray marching.
template <class T>
class Room {
 public:
  [[nodiscard]] T height(T x, T y) const {
    using namespace lanes;
    const T r = sqrt(x * x + y * y + T(1e-6));
    const T bowl = min(r * T(1.0 / kRing), T(1.0));
    T z = T(2.5) + T(2.5) * bowl * bowl;  // a shallow dish
    const T across = (r - T(kRing)) * T(1.0 / 5.0);
    const T hump = max(T(1.0) - across * across, T(0.0));
    if (any(hump > T(0.0)))
      z = z + hump * hump * (T(4.0) + T(0.8) * cosine32(x / r, y / r));  // the frame and its beads
    if (any(r > T(60.0))) z = z + T(4.2) * rosette(x, y);
    const T sweep = x * T(1.0 / 80.0);  // the wall comes forward at the sides
    return z + T(3.0) * sweep * sweep * sweep * sweep;
  }

  [[nodiscard]] Look<T> look(T x, T y) const {
    using namespace lanes;
    const T r = sqrt(x * x + y * y + T(1e-6));
    Look<T> look = plain<T>(0.52, 0.40, 0.34, 0.05);
    // Wallpaper: soft lozenges.
    const T lozenge = sine((x + y) * T(0.9)) * sine((x - y) * T(0.9));
    paint(look, smoothStep(lozenge, 0.15, 0.45) * T(0.35), 0.40, 0.27, 0.23);
    paint(look, smoothStep(rosette(x, y), 0.01, 0.06), 0.74, 0.70, 0.62);
    // Inside the frame: blue glaze with small stars.
    Look<T> glaze = plain<T>(0.055, 0.16, 0.36, 0.30);
    const T star = sine(x * T(0.62)) * sine(y * T(0.62));
    paint(glaze, smoothStep(abs(star), 0.90, 0.97), 0.60, 0.52, 0.30);
    paint(glaze, T(0.5) * smoothStep(r, 14, 44), 0.020, 0.07, 0.20);
    look.albedo = mix(glaze.albedo, look.albedo, smoothStep(r, kRing - 0.4, kRing + 0.4));
    look.gloss = mix1(glaze.gloss, look.gloss, smoothStep(r, kRing - 0.4, kRing + 0.4));
    const T on_ring = T(1.0) - smoothStep(abs(r - T(kRing)), 4.5, 5.0);
    paint(look, on_ring, 0.78, 0.74, 0.66);
    const T across = (r - T(kRing)) * T(1.0 / 3.0);
    const T bead = cosine32(x / r, y / r) - T(2.0) * across * across;
    paint(look, smoothStep(bead, -0.25, 0.05), 0.72, 0.47, 0.13);
    look.gloss = look.gloss + on_ring * T(0.35);
    return look;
  }

 private:
  static constexpr double kRing = 46.5;
  [[nodiscard]] static T mix1(T a, T b, T s) { return a + (b - a) * s; }

  // cos 32 a from the cosine and sine of a, by doubling the angle five times.
  [[nodiscard]] static T cosine32(T c, T s) {
    T d = c * c - s * s;
    for (int i = 0; i < 4; ++i) d = T(2.0) * d * d - T(1.0);
    return d;
  }
  // A flower of eight petals in each corner: 1 in its middle, 0 outside.
  [[nodiscard]] static T rosette(T x, T y) {
    using namespace lanes;
    const T u = abs(x) - T(66.0), v = abs(y) - T(40.5);
    const T r = sqrt(u * u + v * v + T(1e-6));
    const T c = u / r;
    const T c2 = T(2.0) * c * c - T(1.0), c4 = T(2.0) * c2 * c2 - T(1.0), c8 = T(2.0) * c4 * c4 - T(1.0);
    const T edge = r * (T(1.0) - c8 * T(0.13) * smoothStep(r, 0.0, 6.0)) * T(1.0 / 9.0);
    const T inside = max(T(1.0) - edge * edge, T(0.0));
    return inside * inside;
  }
};

}  // namespace relievo::sample
