// SPDX-License-Identifier: Apache-2.0
// A Lissajous figure of 3 to 2, walked by its length.
#include "app/lab/finger/finger_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace relievo {
namespace {

// Closed, through the middle; its phase gives the widest possible tightest turns, 1.2 mm. Begins beside the middle.
class Lissajous {
 public:
  Lissajous(const glm::dvec2& centre, const glm::dvec2& reach) : centre_(centre), reach_(reach) {
    lengths_.reserve(kPieces + 1);
    lengths_.push_back(0);
    for (int i = 1; i <= kPieces; ++i) {
      lengths_.push_back(lengths_.back() + glm::distance(byTurn(i * kTurnOfPiece), byTurn((i - 1) * kTurnOfPiece)));
    }
  }

  [[nodiscard]] glm::dvec2 byLength(double length) const {
    const double rest = std::fmod(length, lengths_.back());
    const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, rest);
    const double share = (rest - *(after - 1)) / (*after - *(after - 1));
    return byTurn((static_cast<double>(after - 1 - lengths_.begin()) + share) * kTurnOfPiece);
  }

 private:
  static constexpr int kPieces = 20000;
  static constexpr double kTurnOfPiece = 2 * std::numbers::pi / kPieces;
  static constexpr double kBeginTurn = 0.15;

  [[nodiscard]] glm::dvec2 byTurn(double turn) const {
    return centre_ + reach_ * glm::dvec2(std::sin(3 * (turn + kBeginTurn)), std::sin(2 * (turn + kBeginTurn)));
  }

  glm::dvec2 centre_, reach_;
  std::vector<double> lengths_;  // from the begin to the end of each piece
};

}  // namespace

std::vector<HipTick> makeFingerPath(const TrueSurface& surface, const FingerPathOptions& options) {
  using Options = FingerPathOptions;
  const Lissajous figure(options.centre_mm, options.reach_mm);
  const int ticks = static_cast<int>(std::lround(options.duration_s / Options::kTickS));
  std::vector<HipTick> path;
  path.reserve(ticks);
  for (int i = 0; i < ticks; ++i) {
    const double t = i * Options::kTickS;
    const double come = std::min(t / Options::kComingInS, 1.0);
    const double depth = come * (options.depth_mm + Options::kAboveMm) - Options::kAboveMm;
    const glm::dvec2 plan = figure.byLength(options.speed_mm_per_s * std::max(t - Options::kComingInS, 0.0));
    const SurfaceJet s = surface.jet(plan.x, plan.y, t);
    path.push_back({t, glm::dvec3(plan, s.z) - depth * glm::normalize(glm::dvec3(-s.zx, -s.zy, 1))});
  }
  return path;
}

}  // namespace relievo
