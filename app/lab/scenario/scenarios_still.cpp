// SPDX-License-Identifier: Apache-2.0
// A still scene, and a finger in difficult places: edges, thin objects, noise, high speed.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/lab/scenario/limits.h"
#include "app/lab/scenario/scenario_tools.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo::scenario {
namespace {

constexpr glm::dvec3 kAcross(1 / kEdgeLength, -kEdgeSlant / kEdgeLength, 0);

constexpr Limit kHungPastEdge{1.5, "mm", "chosen: no method came near it (0.3 mm at most)"};
constexpr Limit kWallPushesAtLeast{70, "%", "chosen: methods that hold the wall have 91 % or more and the others 0"};
constexpr Limit kWallPushesAtMost{130, "%", "chosen: methods that hold the wall have 100 % and the others over 200"};
constexpr Limit kTrapped{3, "mm", "chosen: proxies that are not trapped are 0.3 mm off and the others 5 or more"};

glm::dvec3 placeAt(double q, double z) {
  return q * kAcross + glm::dvec3(0, 0, z);
}

constexpr double kStillS = 0.2;  // of a film on which nothing moves

std::vector<StageTick> stroke(const Challenger& challenger, std::span<const TimedSurface> film, const Way& finger,
                              double duration_s) {
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  return playThrough(
      *method,
      {.film = film, .duration_s = duration_s, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
}

}  // namespace

Verdict strokeStep(const Challenger& challenger, bool /*quick*/) {
  constexpr double kTop = 27.5, kFloor = 12.5;
  const Relief relief = [](double x, double y, double) { return across(x, y) < 0 ? kTop : kFloor; };
  // Over the edge, 2 mm deep; then down, and back against the wall, 3 mm into it.
  const Way finger{{0, placeAt(-8, kTop + 1)},     {0.1, placeAt(-8, kTop - 2)},    {0.28, placeAt(10, kTop - 2)},
                   {0.4, placeAt(10, kTop - 6.5)}, {0.53, placeAt(-3, kTop - 6.5)}, {0.6, placeAt(-3, kTop - 6.5)}};
  static KeptFilm kept;
  const auto ticks = stroke(challenger, kept.make(relief, {}, kStillS), finger, 0.6);
  double hung_mm = 0, against = 1e9, most = 0;
  for (const StageTick& tick : ticks) {
    const double q = across(tick.hip_mm.x, tick.hip_mm.y);
    if (tick.t_s > 0.1 && tick.t_s < 0.4 && glm::length(tick.sent_n) > 0.5 * challenger.stiffness_n_per_mm * 2)
      hung_mm = std::max(hung_mm, q);
    if (tick.t_s > 0.4 && q < -1) {
      against = std::min(against, glm::dot(tick.sent_n, kAcross) / (challenger.stiffness_n_per_mm * -q));
      most = std::max(most, glm::length(tick.sent_n) / (challenger.stiffness_n_per_mm * -q));
    }
  }
  Judge judge;
  judge.atMost(hung_mm, kHungPastEdge, "past the edge while the finger is still held up");
  judge.atLeast(100 * against, kWallPushesAtLeast, "of the expected force of the wall: least one");
  judge.atMost(100 * most, kWallPushesAtMost, "of the expected force of the wall: greatest one");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict thin(const Challenger& challenger, bool /*quick*/) {
  constexpr double kWidth = 3 * MadeFormat::kPitchMm, kCrest = 20, kFloor = 10, kFinger = 15, kBeyond = 4;
  double least = 1e9;
  Judge bounds;
  constexpr std::array kBetweenSamples{0.0, 0.07, 0.15};
  static std::array<KeptFilm, kBetweenSamples.size()> kept;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double shift = kBetweenSamples[i];
    const Relief relief = [shift](double x, double y, double) {
      return std::abs(across(x - shift, y)) < 0.5 * kWidth ? kCrest : kFloor;
    };
    const Way finger{{0, placeAt(-6, kFinger)}, {0.1, placeAt(kBeyond, kFinger)}};
    const auto ticks = stroke(challenger, kept[i].make(relief, {}, kStillS), finger, 0.15);
    for (const StageTick& tick : between(ticks, 0.09, 0.15)) {
      const double front = across(tick.hip_mm.x - shift, tick.hip_mm.y) + 0.5 * kWidth;
      least = std::min(least, -glm::dot(tick.sent_n, kAcross) / (challenger.stiffness_n_per_mm * front));
    }
    bounds.bounds(ticks, challenger.stiffness_n_per_mm);
  }
  Judge judge;
  judge.atLeast(100 * least, kForceNotBelow,
                "of the expected force: least one 3 mm or more behind the front of a ridge");
  judge.add(bounds.verdict());
  return judge.verdict();
}

Verdict noise(const Challenger& challenger, bool quick) {
  constexpr double kDeep = 5;
  const Relief relief = [](double x, double y, double) { return 26 - 0.008 * (x * x + y * y) + 0.1 * x; };
  const double duration = quick ? 1.2 : 3;
  static KeptFilm kept;
  const auto& film = kept.make(relief, {.noise_share = 0.01}, duration);
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto place = [](double t) {
    const double turn = 2 * std::numbers::pi * std::max(t - 0.2, 0.0);
    return glm::dvec2(9 * std::sin(1.3 * turn), 7 * std::sin(0.9 * turn + 0.4));
  };
  const auto finger = [&](double t, const glm::dvec3&) -> std::optional<glm::dvec3> {
    const glm::dvec2 p = place(t);
    const double deep = kDeep * std::min(t / 0.1, 2.0) - kDeep;  // comes in from as far outside
    return glm::dvec3(p, relief(p.x, p.y, t)) - deep * normalOf(relief, p.x, p.y, t);
  };
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = duration, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  double squares = 0, furthest = 0;
  const auto counted = between(ticks, 0.3, duration);
  for (const StageTick& tick : counted) {
    const glm::dvec2 p = place(tick.t_s);
    const glm::dvec3 truth = challenger.stiffness_n_per_mm * kDeep * normalOf(relief, p.x, p.y, 0);
    const double off = percentOff(tick.sent_n, truth);
    squares += off * off;
    furthest = std::max(furthest, glm::distance(tick.asked.proxy_mm, glm::dvec3(p, relief(p.x, p.y, 0))));
  }
  Judge judge;
  judge.atMost(std::sqrt(squares / static_cast<double>(counted.size())), kForceDifference,
               "rms error of the force vector");
  judge.atMost(furthest, kTrapped, "proxy off at most: trapped");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict fastHip(const Challenger& challenger, bool /*quick*/) {
  constexpr double kCrest = 28, kFloor = 13, kSide = 20;
  const Relief relief = [](double x, double y, double) { return std::abs(across(x, y) + 2) < 2 ? kCrest : kFloor; };
  // Through the ridge, out again, and down into the floor; 5 m/s each time.
  const Way through{{0.05, placeAt(-14, kSide)}, {0.0542, placeAt(7, kSide)}};
  const Way down{{0.05, placeAt(8, kFloor + 10)}, {0.054, placeAt(8, kFloor - 10)}};
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, kStillS);
  const auto sideways = stroke(challenger, film, through, 0.1);
  const auto downwards = stroke(challenger, film, down, 0.1);
  const double side =
      -glm::dot(meanForce(between(sideways, 0.08, 0.1)), kAcross) / (challenger.stiffness_n_per_mm * 11);
  const double floor = meanForce(between(downwards, 0.08, 0.1)).z / (challenger.stiffness_n_per_mm * 10);
  Judge judge;
  judge.atLeast(100 * std::min(side, floor), kForceNotBelow,
                side < floor ? "of the expected force of a ridge" : "of the expected force of a floor");
  judge.bounds(sideways, challenger.stiffness_n_per_mm);
  judge.bounds(downwards, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

}  // namespace relievo::scenario
