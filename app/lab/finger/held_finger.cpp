// SPDX-License-Identifier: Apache-2.0
// The finger comes in from above, straight along the normal of the cheek at rest, within a quarter of the settling.
#include "app/lab/finger/held_finger.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/lab/finger/finger_paths.h"
#include "app/lab/finger/resting_hand.h"

namespace relievo {
namespace {

constexpr double kTickS = FingerPathOptions::kTickS;
constexpr glm::dvec2 kCheek{18, -6};

struct Hold {
  glm::dvec3 place_mm, normal;  // on the face as it is at time 0, in the middle of its movements
  double depth_mm;

  [[nodiscard]] glm::dvec3 at(double since_s) const {
    constexpr double kComingInS = HoldPlan::kSettleS / 4, kAboveMm = 15;
    const double share = std::min(since_s / kComingInS, 1.0);
    return place_mm + (kAboveMm - share * (kAboveMm + depth_mm)) * normal;
  }
};

}  // namespace

std::vector<PlayedTick> holdFinger(const TrueSurface& face, const MemoryFilm& film, TouchMethod& method,
                                   FingerHold hold, const HoldPlan& plan) {
  FilmRun run(film, method);
  return holdFinger(face, [&run](const HipTick& hip) { return run.tick(hip); }, hold, plan);
}

std::vector<PlayedTick> holdFinger(const TrueSurface& face, const std::function<PlayedTick(const HipTick&)>& answer,
                                   FingerHold hold, const HoldPlan& plan) {
  const SurfaceJet rest = face.jet(kCheek.x, kCheek.y, 0);
  const Hold target{.place_mm = {kCheek, rest.z},
                    .normal = glm::normalize(glm::dvec3(-rest.zx, -rest.zy, 1)),
                    .depth_mm = hold == FingerHold::FixedPoint ? 5.0 : 8.0};
  RestingHand hand{.position_mm = target.at(0)};
  Oracle oracle(face);
  std::vector<PlayedTick> measured;
  const auto ticks = std::lround((HoldPlan::kSettleS + plan.measured_s) / kTickS);
  for (long i = 0; i < ticks; ++i) {
    const double since = static_cast<double>(i) * kTickS, t = plan.from_s + since;
    const glm::dvec3 hip = hold == FingerHold::FixedPoint ? target.at(since) : hand.position_mm;
    PlayedTick tick = answer({t, hip});
    tick.truth = oracle.update(hip, t);
    hand.move(target.at(since), tick.touch.force_n, kTickS);
    if (since >= HoldPlan::kSettleS - kTickS / 2) measured.push_back(tick);
  }
  return measured;
}

}  // namespace relievo
