// SPDX-License-Identifier: Apache-2.0
// Disparities, with the slope of their surfaces, spread from the seen points along paths of similar colour.
#include "app/stereo/hole_filling.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace relievo {
namespace {

constexpr float kPerLevel = 0.3F;     // cost of a level's difference between neighbours, in pixels
constexpr float kAgainstSight = 100;  // cost of a place where the right eye would see the point, but does not
constexpr float kFront = 1;           // pixels of disparity by which a point is in front of another
constexpr int kSweeps = 2;            // there and back
constexpr int kSlopeReach = 10;       // pixels around, of which a slope is measured
constexpr float kSteepest = 0.3F;     // pixels of disparity a pixel

struct Slope {
  float across = 0, down = 0;
};

// The plane through the seen points around, of the same surface.
class PlaneFit {
 public:
  void add(float x, float y, float d) {
    n_ += 1, x_ += x, y_ += y, d_ += d;
    xx_ += x * x, xy_ += x * y, yy_ += y * y, xd_ += x * d, yd_ += y * d;
  }
  [[nodiscard]] Slope slope() const {
    constexpr float kLeast = 20;  // points
    constexpr float kFlat = 1;    // px^2: points that lie closer together than this give a level plane
    if (n_ < kLeast) return {};
    const float x = x_ / n_, y = y_ / n_, d = d_ / n_;
    const float xx = xx_ / n_ - x * x + kFlat, yy = yy_ / n_ - y * y + kFlat, xy = xy_ / n_ - x * y;
    const float xd = xd_ / n_ - x * d, yd = yd_ / n_ - y * d, all = xx * yy - xy * xy;
    return {std::clamp((xd * yy - yd * xy) / all, -kSteepest, kSteepest),
            std::clamp((yd * xx - xd * xy) / all, -kSteepest, kSteepest)};
  }

 private:
  float n_ = 0, x_ = 0, y_ = 0, d_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, xd_ = 0, yd_ = 0;
};

class Filler {
 public:
  Filler(DisparityMap& map, const ViewPicture& left)
      : map_(map), left_(left), cost_(map.size(), kUnreached), slopes_(map.size()) {
    for (int r = 0; r < map_.rows; ++r) {
      for (int c = 0; c < map_.cols; ++c) {
        if (!isSeen(c, r)) continue;
        lowest_ = std::min(lowest_, map_.pixels[map_.at(c, r)]);
        highest_ = std::max(highest_, map_.pixels[map_.at(c, r)]);
        cost_[map_.at(c, r)] = 0;
        if (isAtHole(c, r)) slopes_[map_.at(c, r)] = slopeAt(c, r);
      }
    }
  }

  void run() {
    for (int i = 0; i < kSweeps; ++i) {
      for (int r = 0; r < map_.rows; ++r) sweepRow(r, 1);
      for (int r = map_.rows - 1; r >= 0; --r) sweepRow(r, -1);
    }
  }

 private:
  static constexpr float kUnreached = std::numeric_limits<float>::max();

  [[nodiscard]] bool isSeen(int c, int r) const { return map_.seen[map_.at(c, r)] != 0; }
  [[nodiscard]] bool isAtHole(int c, int r) const {
    return (c > 0 && !isSeen(c - 1, r)) || (c + 1 < map_.cols && !isSeen(c + 1, r)) || (r > 0 && !isSeen(c, r - 1)) ||
           (r + 1 < map_.rows && !isSeen(c, r + 1));
  }
  [[nodiscard]] Slope slopeAt(int c, int r) const {
    constexpr float kSame = 1.5F;  // pixels
    PlaneFit plane;
    for (int y = std::max(0, r - kSlopeReach); y <= std::min(map_.rows - 1, r + kSlopeReach); ++y) {
      for (int x = std::max(0, c - kSlopeReach); x <= std::min(map_.cols - 1, c + kSlopeReach); ++x) {
        const float d = map_.pixels[map_.at(x, y)] - map_.pixels[map_.at(c, r)];
        if (isSeen(x, y) && std::abs(d) <= kSame) plane.add(static_cast<float>(x - c), static_cast<float>(y - r), d);
      }
    }
    return plane.slope();
  }
  // Spreads from the row before it (in the order of the sweep), then along the row in both directions.
  void sweepRow(int r, int down) {
    const int before = r - down;
    if (before >= 0 && before < map_.rows) {
      for (int c = 0; c < map_.cols; ++c) {
        for (int k = std::max(-1, -c); k <= std::min(1, map_.cols - 1 - c); ++k) take(c, r, k, -down);
      }
    }
    for (int c = 1; c < map_.cols; ++c) take(c, r, -1, 0);
    for (int c = map_.cols - 2; c >= 0; --c) take(c, r, 1, 0);
  }
  // From the neighbour at (c + across, r + down), if that is the cheapest way.
  void take(int c, int r, int across, int down) {
    const std::size_t here = map_.at(c, r), from = map_.at(c + across, r + down);
    if (map_.seen[here] != 0 || cost_[from] == kUnreached) return;
    const Slope& slope = slopes_[from];
    const float d =
        map_.pixels[from] - slope.across * static_cast<float>(across) - slope.down * static_cast<float>(down);
    const float length = across != 0 && down != 0 ? 1.4F : 1;
    const float cost =
        cost_[from] + length + kPerLevel * unlikeness(here, from) + (isAgainstSight(c, r, d) ? kAgainstSight : 0);
    if (cost >= cost_[here]) return;
    cost_[here] = cost;
    map_.pixels[here] = std::clamp(d, lowest_, highest_);
    slopes_[here] = slope;
  }
  // True if a point at this disparity would hide what the right eye sees there.
  [[nodiscard]] bool isAgainstSight(int c, int r, float d) const {
    const int there = static_cast<int>(std::lround(static_cast<float>(c) - d));
    return there >= 0 && there < map_.cols && map_.from_right[map_.at(there, r)] < d - kFront;
  }
  [[nodiscard]] float unlikeness(std::size_t a, std::size_t b) const {
    return static_cast<float>(relievo::unlikeness(left_.pixel(a), left_.pixel(b)));
  }

  DisparityMap& map_;
  const ViewPicture& left_;
  std::vector<float> cost_;
  std::vector<Slope> slopes_;
  float lowest_ = kUnreached, highest_ = -kUnreached;  // of the seen points
};

}  // namespace

void fillHoles(DisparityMap& map, const ViewPicture& left) {
  Filler(map, left).run();
}

}  // namespace relievo
