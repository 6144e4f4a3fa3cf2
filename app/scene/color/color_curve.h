// SPDX-License-Identifier: Apache-2.0
// A curve through the colours that stand for depth (the circle of hues, or a colour map), and its inverse: the point of
// the curve that is nearest to a colour.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "app/scene/codes/depth_code.h"
#include "platform/realtime.h"

namespace relievo {

// A colour as luma (0 to 1) and chroma (-1/2 to 1/2) of BT.709. Codecs add their errors in such coordinates.
struct YuvColor {
  float y = 0, u = 0, v = 0;
};
[[nodiscard]] YuvColor toYuv(double red, double green, double blue) noexcept;

// Straight pieces of equal length in s. The piece nearest to a colour is looked up in a cube of 32 x 32 x 32 cells;
// then the colour is projected on that piece or on one beside it.
class ColorCurve {
 public:
  struct Point {
    float s = 0;         // 0 at the first knot, 1 at the last
    float distance = 0;  // of the colour from the curve
  };

  // Knots are 0xRRGGBB, 2 to 53 of them. If the last is the first, the curve is closed.
  explicit ColorCurve(std::span<const std::uint32_t> knots);

  // In the header: `s` is then known before the distance's root is.
  [[nodiscard]] Point nearest(const YuvColor& color) const RELIEVO_RT;
  // The point of the curve from `low` to `high` that is nearest to the colour if an error of chroma counts less than
  // one of luma, as where chroma is mixed; and the squared distance in that metric.
  struct Between {
    float s = 0, error = 0;
  };
  [[nodiscard]] Between between(const YuvColor& color, float low, float high) const RELIEVO_RT;
  // The weight of chroma in `Between::error`.
  static constexpr float kChromaWeight = 0.3F;
  // The colour at s, 0 to 1.
  [[nodiscard]] YuvColor at(double s) const RELIEVO_RT;
  // How much the colour at s changes for a change of 1 in s.
  [[nodiscard]] YuvColor slopeAt(float s) const RELIEVO_RT;
  [[nodiscard]] bool closed() const RELIEVO_RT { return closed_; }
  [[nodiscard]] bool isAtSeam(float s, float half_width) const RELIEVO_RT {
    return closed_ && (s < half_width || s > 1 - half_width);
  }
  [[nodiscard]] int pieces() const noexcept { return static_cast<int>(pieces_.size()); }
  // The number of the piece at s.
  [[nodiscard]] int pieceAt(float s) const noexcept {
    return std::clamp(static_cast<int>(s * static_cast<float>(pieces())), 0, pieces() - 1);
  }
  // s as a linear function of a colour near piece `k`: its slope, and its value where y, u and v are 0.
  struct Line {
    YuvColor slope;
    float at_zero = 0;
  };
  [[nodiscard]] Line lineOf(int k) const noexcept;
  // How much s changes for a change of 1 in the colour, on average.
  [[nodiscard]] double meanPerColor() const noexcept;

 private:
  static constexpr int kSide = 32;
  struct Piece {
    YuvColor from, along, per_length;  // per_length = along / |along|^2
  };
  struct Place {
    float t = 0, distance = 0;  // squared
  };
  [[nodiscard]] static Place placeOn(const Piece& piece, const YuvColor& color) RELIEVO_RT {
    const float y = color.y - piece.from.y, u = color.u - piece.from.u, v = color.v - piece.from.v;
    const YuvColor &along = piece.along, &per = piece.per_length;
    const float t = y * per.y + u * per.u + v * per.v, on = std::clamp(t, 0.0F, 1.0F);
    const float left_y = y - on * along.y, left_u = u - on * along.u, left_v = v - on * along.v;
    return {t, left_y * left_y + left_u * left_u + left_v * left_v};
  }

  // The piece that the cube has for a colour.
  [[nodiscard]] int pieceFor(float y, float u, float v) const RELIEVO_RT {
    const auto cell = [](float x) { return std::clamp(static_cast<int>(x * kSide), 0, kSide - 1); };
    const int index = (cell(y) * kSide + cell(u + 0.5F)) * kSide + cell(v + 0.5F);
    return nearest_piece_[static_cast<std::size_t>(index)];
  }

  std::vector<Piece> pieces_;
  float per_piece_ = 0;  // of s
  bool closed_ = false;
  std::array<std::uint8_t, kSide * kSide * kSide> nearest_piece_{};
};

inline ColorCurve::Point ColorCurve::nearest(const YuvColor& color) const RELIEVO_RT {
  int k = pieceFor(color.y, color.u, color.v);
  Place place = placeOn(pieces_[static_cast<std::size_t>(k)], color);
  for (int walked = 0; walked < 2 && (place.t < 0 || place.t > 1); ++walked) {
    const int count = static_cast<int>(pieces_.size());
    int beside = place.t < 0 ? k - 1 : k + 1;
    if (closed_) beside = beside < 0 ? count - 1 : beside == count ? 0 : beside;
    if (beside < 0 || beside >= count) break;
    const Place there = placeOn(pieces_[static_cast<std::size_t>(beside)], color);
    if (there.distance >= place.distance) break;
    k = beside;
    place = there;
  }
  const float s = (static_cast<float>(k) + std::clamp(place.t, 0.0F, 1.0F)) * per_piece_;
  return {s, std::sqrt(place.distance)};
}

// The curve of a code other than luma. The first call creates it, which a real-time thread must not do; later calls
// return the same object.
[[nodiscard]] const ColorCurve& curveOf(DepthCode code);

}  // namespace relievo
