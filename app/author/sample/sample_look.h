// SPDX-License-Identifier: Apache-2.0
// Shared by the parts of the sample film: the look of a surface, and which parts may affect a region of the picture.
#pragma once

#include <cstdint>

#include "app/author/sample/lanes.h"

namespace relievo::sample {

template <class T>
struct Look {
  lanes::Vec3<T> albedo;  // linear light, BT.709 primaries
  T gloss;                // strength of the highlight
  T warmth;               // subsurface scattering, as in skin
};

template <class T>
[[nodiscard]] Look<T> plain(double r, double g, double b, double gloss, double warmth = 0) {
  return {{T(r), T(g), T(b)}, T(gloss), T(warmth)};
}
template <class T>
void paint(Look<T>& look, T share, double r, double g, double b) {
  look.albedo = lanes::mix(look.albedo, {T(r), T(g), T(b)}, share);
}
// Takes the look of the nearest part.
template <class T>
void nearest(Look<T>& look, T& distance, T other_distance, const Look<T>& other) {
  const auto closer = other_distance < distance;
  look = {lanes::select(closer, other.albedo, look.albedo), lanes::select(closer, other.gloss, look.gloss),
          lanes::select(closer, other.warmth, look.warmth)};
  distance = lanes::min(distance, other_distance);
}

// A set of parts of a scene, one bit each. Parts farther from a region of the picture than any fillet or shading effect
// reaches cannot change it and are skipped there.
using Parts = std::uint32_t;
constexpr Parts kAllParts = ~Parts{0};

struct Box2 {
  double left, right, bottom, top;
  [[nodiscard]] bool touches(const Box2& o) const {
    return left <= o.right && o.left <= right && bottom <= o.top && o.bottom <= top;
  }
  [[nodiscard]] Box2 grown(double by) const { return {left - by, right + by, bottom - by, top + by}; }
};

}  // namespace relievo::sample
