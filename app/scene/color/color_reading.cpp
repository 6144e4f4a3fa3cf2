// SPDX-License-Identifier: Apache-2.0
// Reads a sample off the curve by its neighbours.
#include "app/scene/color/color_reading.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relievo {
namespace {

constexpr float kFarOffHues = 0.2F, kFarOffMap = 0.12F;  // from the curve; of a colour that may still count
constexpr float kBesideSeam = 0.03F;                     // of the circle of hues
constexpr float kNearBlack = 0.2F, kDarker = 0.04F;
bool isBlack(const YuvColor& color) noexcept {
  return color.y * color.y + color.u * color.u + color.v * color.v < kNearBlack * kNearBlack;
}

// Measured on hard and soft edges, H.264 4:2:0 at crf 18 and 23: how far, in s, a surface may be from where it is
// nearby, and the weight of that beside luma; the share of the other side from which on chroma speaks against a
// surface.
constexpr float kMostRise = 0.03F, kRiseWeight = 3, kOtherSide = 0.35F;

// A reading, and the squared error of the colour that it explains.
struct Explained {
  float s = 0, error = 0;
};

struct Edge {
  YuvColor own;     // the sample's luma, and chroma mixed from both sides
  YuvColor placed;  // likewise, but with chroma interpolated to the sample's place

  // How well the sample belongs to the surface that is at `s` nearby, if `other` is the colour of the other side.
  [[nodiscard]] Explained asSurface(const ColorCurve& curve, float s, const YuvColor& other) const RELIEVO_RT {
    const YuvColor there = curve.at(static_cast<double>(s)), slope = curve.slopeAt(s);
    const float fitting = (own.y - there.y) * slope.y / (slope.y * slope.y + kRiseWeight);
    const float rise = std::clamp(fitting, -kMostRise, kMostRise);
    const YuvColor here{there.y + rise * slope.y, there.u + rise * slope.u, there.v + rise * slope.v};
    const float along_u = other.u - here.u, along_v = other.v - here.v, length = along_u * along_u + along_v * along_v;
    const auto shareOfOther = [&](const YuvColor& color) {
      const float along = (color.u - here.u) * along_u + (color.v - here.v) * along_v;
      return length > 0 ? std::clamp(along / length, 0.0F, 1.0F) : 0.0F;
    };
    const float mixed = shareOfOther(own), beyond = std::max(shareOfOther(placed) - kOtherSide, 0.0F);
    const float off_u = own.u - here.u - mixed * along_u, off_v = own.v - here.v - mixed * along_v;
    const float luma = own.y - here.y, chroma = off_u * off_u + off_v * off_v + beyond * beyond * length;
    return {std::clamp(s + rise, 0.0F, 1.0F),
            luma * luma + kRiseWeight * rise * rise + ColorCurve::kChromaWeight * chroma};
  }
};

}  // namespace

ColorReading::ColorReading(const Frame& frame, DepthCode code)
    : samples_(frame),
      curve_(&curveOf(code)),
      table_(&samples_.tableOf(code)),
      cols_(frame.width),
      rows_(frame.height) {}

void ColorReading::keepApart(const CodeSet& invalid, double steps) noexcept {
  if (invalid.empty()) return;
  const auto pieces = static_cast<std::size_t>(curve_->pieces());
  for (int code = 0; code <= static_cast<int>(steps); ++code) {
    if (!invalid.contains(static_cast<std::uint32_t>(code))) continue;
    // A position of up to the next code counts as this one.
    const auto first = static_cast<std::size_t>(curve_->pieceAt(static_cast<float>(code / steps))) + 1;
    const auto behind = std::nextafter(static_cast<float>((code + 1) / steps), 0.0F);
    const auto last = static_cast<std::size_t>(curve_->pieceAt(std::min(behind, 1.0F))) + 1;
    for (std::size_t piece = first; piece <= last; ++piece) {
      apart_ |= std::uint64_t{1} << piece;
      // The corners before and behind it are counted after the pieces.
      for (const std::size_t corner : {pieces + piece - 1, pieces + piece}) {
        if (corner > pieces && corner <= table_->pieceCount()) apart_ |= std::uint64_t{1} << corner;
      }
    }
  }
}

[[gnu::noinline]] double ColorReading::unsureShareAt(int c, int r) const RELIEVO_RT {
  const YuvColor own = samples_.at(c, r);
  const ColorCurve::Point reading = curve_->nearest(own);
  return reading.distance <= ColorTable::kUnmixed && isSure(reading) ? static_cast<double>(reading.s)
                                                                     : shareBeside(c, r, own, reading);
}

[[gnu::noinline]] double ColorReading::shareBeside(int c, int r, const YuvColor& own,
                                                   const ColorCurve::Point& reading) const RELIEVO_RT {
  // Chroma is mixed over two samples, and by some encoders' filters over four.
  static constexpr int kBeside[][2] = {{-2, 0}, {2, 0}, {0, -2}, {0, 2}, {-4, 0}, {4, 0}, {0, -4}, {0, 4}};
  const float far_off = curve_->closed() ? kFarOffHues : kFarOffMap;
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const bool at_seam = reading.distance <= kOnCurve && !isSure(reading);
  float least = kNone, least_empty = kNone, share = 0, low = 1, high = 0;
  std::array<float, std::size(kBeside)> sides{};
  std::size_t count = 0;
  for (const auto& [across, down] : kBeside) {
    const int col = c + across, row = r + down;
    if (col < 0 || col >= cols_ || row < 0 || row >= rows_) continue;
    const YuvColor color = samples_.at(col, row);
    const ColorCurve::Point point = curve_->nearest(color);
    const float difference = std::abs(color.y - own.y);
    if (isSure(point)) {
      if (at_seam && std::min(point.s, 1 - point.s) > kBesideSeam) continue;
      sides[count++] = point.s;
      low = std::min(low, point.s);
      high = std::max(high, point.s);
      if (difference < least) least = difference, share = point.s;
    } else if (point.distance <= kOnCurve || (point.distance > far_off && isBlack(color))) {
      least_empty = std::min(least_empty, difference);
    }
  }
  // A dark colour whose chroma is mixed with its complement's looks black as well.
  if (!at_seam && least_empty + kDarker < least) return kHole;
  if (count == 0) return at_seam || reading.distance > far_off ? kHole : static_cast<double>(reading.s);
  if (at_seam) return static_cast<double>(share);
  return static_cast<double>(shareAtEdge(c, r, own, std::span(sides).first(count), low, high));
}

float ColorReading::shareAtEdge(int c, int r, const YuvColor& own, std::span<const float> sides, float low,
                                float high) const RELIEVO_RT {
  const Edge edge{own, samples_.interpolatedAt(c, r, cols_, rows_)};
  const YuvColor low_color = curve_->at(static_cast<double>(low)), high_color = curve_->at(static_cast<double>(high));
  const ColorCurve::Between between = curve_->between(edge.placed, low, high);
  Explained best{between.s, between.error};
  for (const float side : sides) {
    const Explained one = edge.asSurface(*curve_, side, side - low > high - side ? low_color : high_color);
    if (one.error < best.error) best = one;
  }
  return best.s;
}

}  // namespace relievo
