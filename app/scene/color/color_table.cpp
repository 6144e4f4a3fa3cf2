// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color/color_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

namespace relievo {
namespace {

constexpr int kSide = 1 << ColorTable::kBits, kWidth = 1 << (8 - ColorTable::kBits);
constexpr std::size_t kPlaces = std::size_t{kSide} * kSide * kSide;
// Of the circle: a place's middle is sqrt(3) x 2/219 from its corners, a sixth of the circle .93 long.
constexpr float kHalfPlace = 0.003F;
// How much farther than kUnmixed from the curve a place's middle may be whose samples are not mixed; its corners are
// .016 away. With 0, edges and forces are the same, and more samples are compared with their neighbours.
constexpr float kRoom = 0.01F;

float dot(const YuvColor& a, const YuvColor& b) noexcept {
  return a.y * b.y + a.u * b.u + a.v * b.v;
}
YuvColor sum(float m, const YuvColor& a, float n, const YuvColor& b) noexcept {
  return {m * a.y + n * b.y, m * a.u + n * b.u, m * a.v + n * b.v};
}

// Where two pieces meet. Subsampling and coding mix the colours on both sides, and a mixture lies inside of the corner.
// If it is the corner's colour less m times the slope of the piece before, and n times the slope of the piece behind,
// the mean position of what is mixed is n - m from the corner. Its nearest point on a piece is elsewhere: positions
// would jump where another piece becomes the nearest one.
class Corner {
 public:
  // Between the pieces `k` and k + 1.
  Corner(const ColorCurve& curve, int k) noexcept {
    const auto count = static_cast<float>(curve.pieces()), middle = static_cast<float>(k) + 0.5F;
    reach_ = kReach / count;
    at_ = (middle + 0.5F) / count;
    color_ = curve.at(static_cast<double>(at_));
    before_ = curve.slopeAt(middle / count);
    behind_ = curve.slopeAt((middle + 1) / count);
    const float a = dot(before_, before_), b = dot(behind_, behind_), both = dot(before_, behind_);
    const float area2 = a * b - both * both;
    turns_ = area2 > kLeastTurn * a * b;
    of_behind_ = sum(a / area2, behind_, -both / area2, before_);
    of_before_ = sum(-b / area2, before_, both / area2, behind_);
  }
  // Whether a colour near the corner is mixed of both sides, or beyond both.
  [[nodiscard]] bool isMixed(const YuvColor& color) const noexcept {
    const YuvColor off = sum(1, color, -1, color_);
    const float m = dot(off, of_before_), n = dot(off, of_behind_);
    return turns_ && (m > 0) == (n > 0) && std::max(std::abs(m), std::abs(n)) < reach_;
  }
  // The position of mixed colours.
  [[nodiscard]] ColorCurve::Line line() const noexcept {
    const YuvColor slope = sum(1, of_behind_, -1, of_before_);
    return {slope, at_ - dot(slope, color_)};
  }

 private:
  // Of a piece. With .25 and .5 the force error on a nodding face of hues is larger, at crf 18 1.03 and 1.07 %
  // for 1.01, at crf 23 1.58 and 1.63 for 1.52: there are more colours that only noise has moved inside.
  static constexpr float kReach = 0.12F;
  static constexpr float kLeastTurn = 0.05F;  // squared sine of the turn: 13 degrees

  YuvColor color_, before_, behind_;
  YuvColor of_before_, of_behind_;  // factors of a colour, less the corner's, that give m and n
  float at_ = 0, reach_ = 0;
  bool turns_ = false;
};

}  // namespace

ColorTable::ColorTable(const ColorCurve& curve, const Colors& colors) : of_samples_(kPlaces), of_means_(kPlaces) {
  const int pieces = curve.pieces();
  std::vector<Corner> corners;
  const auto addLine = [&](const ColorCurve::Line& of_color) {
    Line& line = lines_[++count_];
    for (std::size_t i = 0; i < 4; ++i) {
      line[i] = of_color.slope.y * colors[0][i] + of_color.slope.u * colors[1][i] + of_color.slope.v * colors[2][i];
    }
    line[3] += of_color.at_zero;
  };
  for (int k = 0; k < pieces; ++k) addLine(curve.lineOf(k));
  for (int k = 0; k + 1 < pieces && 2 * pieces <= static_cast<int>(kMostPieces); ++k) {
    corners.emplace_back(curve, k);
    addLine(corners.back().line());
  }
  const auto middleOf = [](int place) { return static_cast<float>(kWidth * place) + kWidth / 2.0F; };
  const auto colorAt = [&](float first, float second, float third) -> YuvColor {
    const auto part = [&](std::size_t row) {
      return colors[row][0] * first + colors[row][1] * second + colors[row][2] * third + colors[row][3];
    };
    return {part(0), part(1), part(2)};
  };
  const auto numberOf = [&](const YuvColor& color, float s) {
    const int k = curve.pieceAt(s), corner = s * static_cast<float>(pieces) < static_cast<float>(k) + 0.5F ? k - 1 : k;
    const bool is_there = corner >= 0 && corner < static_cast<int>(corners.size());
    const bool turns = is_there && corners[static_cast<std::size_t>(corner)].isMixed(color);
    return static_cast<std::uint8_t>(turns ? pieces + corner + 1 : k + 1);
  };
  std::size_t place = 0;
  for (int a = 0; a < kSide; ++a) {
    for (int b = 0; b < kSide; ++b) {
      for (int c = 0; c < kSide; ++c, ++place) {
        const YuvColor color = colorAt(middleOf(a), middleOf(b), middleOf(c));
        const ColorCurve::Point point = curve.nearest(color);
        if (point.distance > kMean || curve.isAtSeam(point.s, kSeam + kHalfPlace)) continue;
        of_means_[place] = numberOf(color, point.s);
        if (point.distance <= kUnmixed + kRoom) of_samples_[place] = of_means_[place];
      }
    }
  }
}

const ColorTable& tableOf(DepthCode code, std::size_t format, const ColorTable::Colors& colors) {
  static std::array<std::atomic<const ColorTable*>, kDepthCodes.size() * kColorFormats> tables{};
  auto& table = tables[static_cast<std::size_t>(code) * kColorFormats + format];
  const ColorTable* known = table.load(std::memory_order_acquire);
  if (known != nullptr) return *known;
  auto made = std::make_unique<const ColorTable>(curveOf(code), colors);
  if (!table.compare_exchange_strong(known, made.get(), std::memory_order_acq_rel)) return *known;
  return *made.release();  // until the program ends
}

}  // namespace relievo
