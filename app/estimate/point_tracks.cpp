// SPDX-License-Identifier: Apache-2.0
#include "app/estimate/point_tracks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace relievo {
namespace {

constexpr int kBlock = 8;
constexpr int kReach = 5, kAcross = 2 * kReach + 1;
constexpr int kMargin = kReach + 1;  // samples that a point keeps from the picture's edge
constexpr int kSteps = 10;
constexpr double kStill = 0.005;  // samples: a step that changes nothing
constexpr double kFarthest = 2;   // samples between the blocks' motion and the fit
constexpr double kUnlike = 8;     // codes, on average: above this it is another object
constexpr double kTextured =
    4;  // squared codes a sample: the least slope, in the weaker direction, of a point that can be tracked

// Brightness between the samples, within the picture.
double between(const GrayPicture& p, double x, double y) {
  const int c = std::clamp(static_cast<int>(x), 0, p.cols - 2), r = std::clamp(static_cast<int>(y), 0, p.rows - 2);
  const double s = x - c, t = y - r;
  const double upper = (1 - s) * p.at(c, r) + s * p.at(c + 1, r);
  const double lower = (1 - s) * p.at(c, r + 1) + s * p.at(c + 1, r + 1);
  return (1 - t) * upper + t * lower;
}

bool isInside(const GrayPicture& p, double x, double y) {
  return x >= kMargin && y >= kMargin && x <= p.cols - 1 - kMargin && y <= p.rows - 1 - kMargin;
}

using Patch = std::array<double, std::size_t{kAcross} * kAcross>;

// The patch around a point, minus its mean.
Patch patchAt(const GrayPicture& p, double x, double y) {
  Patch patch{};
  double sum = 0;
  std::size_t i = 0;
  for (int r = -kReach; r <= kReach; ++r) {
    for (int c = -kReach; c <= kReach; ++c) sum += patch[i++] = between(p, x + c, y + r);
  }
  for (double& value : patch) value -= sum / static_cast<double>(patch.size());
  return patch;
}

// A point's surroundings, their slopes, and the position that these imply.
struct Look {
  Patch patch{}, slope_x{}, slope_y{};
  double xx = 0, xy = 0, yy = 0;

  Look(const GrayPicture& p, double x, double y) : patch(patchAt(p, x, y)) {
    std::size_t i = 0;
    for (int r = -kReach; r <= kReach; ++r) {
      for (int c = -kReach; c <= kReach; ++c, ++i) {
        slope_x[i] = 0.5 * (between(p, x + c + 1, y + r) - between(p, x + c - 1, y + r));
        slope_y[i] = 0.5 * (between(p, x + c, y + r + 1) - between(p, x + c, y + r - 1));
        xx += slope_x[i] * slope_x[i];
        xy += slope_x[i] * slope_y[i];
        yy += slope_y[i] * slope_y[i];
      }
    }
  }
  [[nodiscard]] bool isTextured() const {
    const double weaker = 0.5 * (xx + yy - std::hypot(xx - yy, 2 * xy));
    return weaker > kTextured * static_cast<double>(patch.size());
  }
};

struct Place {
  double x = 0, y = 0;
};

// The position to which the blocks' motion moves a point of the picture before; that motion points backwards.
Place byBlocks(const GrayPicture& now, const std::vector<Motion>& motion, double x, double y) {
  Place to{x, y};
  for (int i = 0; i < 3; ++i) {
    const int c = std::clamp(static_cast<int>(std::lround(to.x)), 0, now.cols - 1);
    const int r = std::clamp(static_cast<int>(std::lround(to.y)), 0, now.rows - 1);
    const Motion& v =
        motion[static_cast<std::size_t>(r) * static_cast<std::size_t>(now.cols) + static_cast<std::size_t>(c)];
    to = {x - static_cast<double>(v.x), y - static_cast<double>(v.y)};
  }
  return to;
}

double unlike(const Patch& a, const Patch& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

// The position in `now`, near `from`, that looks like it; nullopt if there is none.
std::optional<Place> fitted(const Look& look, const GrayPicture& now, const Place& from) {
  Place to = from;
  const double area = look.xx * look.yy - look.xy * look.xy;
  for (int step = 0; step < kSteps && look.isTextured(); ++step) {
    if (!isInside(now, to.x, to.y)) return std::nullopt;
    const Patch here = patchAt(now, to.x, to.y);
    double by_x = 0, by_y = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
      by_x += look.slope_x[i] * (here[i] - look.patch[i]);
      by_y += look.slope_y[i] * (here[i] - look.patch[i]);
    }
    const double dx = (look.xy * by_y - look.yy * by_x) / area, dy = (look.xy * by_x - look.xx * by_y) / area;
    to = {to.x + dx, to.y + dy};
    if (std::hypot(to.x - from.x, to.y - from.y) > kFarthest) return std::nullopt;
    if (std::hypot(dx, dy) < kStill) break;
  }
  if (!isInside(now, to.x, to.y) || unlike(look.patch, patchAt(now, to.x, to.y)) > kUnlike) return std::nullopt;
  return to;
}

}  // namespace

void PointTracks::follow(const GrayPicture& before, const GrayPicture& now, const std::vector<Motion>& motion) {
  std::erase_if(points_, [&](TrackedPoint& point) {
    const Look look(before, point.x, point.y);
    const auto to = fitted(look, now, byBlocks(now, motion, point.x, point.y));
    if (!to) return true;
    point.x = to->x;
    point.y = to->y;
    point.textured = look.isTextured();
    return false;
  });
}

void PointTracks::seed(const GrayPicture& now) {
  const int across = (now.cols + kBlock - 1) / kBlock, down = (now.rows + kBlock - 1) / kBlock;
  std::vector<bool> taken(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  const auto block = [&](double x, double y) {
    return static_cast<std::size_t>(y / kBlock) * static_cast<std::size_t>(across) +
           static_cast<std::size_t>(x / kBlock);
  };
  for (const TrackedPoint& point : points_) taken[block(point.x, point.y)] = true;
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      const double x = i * kBlock + 0.5 * kBlock, y = j * kBlock + 0.5 * kBlock;
      if (!isInside(now, x, y) || taken[block(x, y)]) continue;
      points_.push_back({.x = x, .y = y, .textured = Look(now, x, y).isTextured()});
    }
  }
}

}  // namespace relievo
