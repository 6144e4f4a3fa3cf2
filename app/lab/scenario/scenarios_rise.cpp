// SPDX-License-Identifier: Apache-2.0
// A scene that comes to the finger, from below and from the side.
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/lab/scenario/limits.h"
#include "app/lab/scenario/scenario_tools.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo::scenario {
namespace {

Verdict riseUnder(const Challenger& challenger, const Relief& relief, KeptFilm& kept, const MadeFormat& format,
                  const Way& finger, double duration_s) {
  const auto& film = kept.make(relief, format, duration_s);
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = duration_s, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const auto end = between(ticks, duration_s - 0.05, duration_s);
  glm::dvec3 truth = challenger.stiffness_n_per_mm * depthOnFlat(relief, end.back().hip_mm, duration_s);
  if (glm::length(truth) > 10) truth *= 10 / glm::length(truth);
  Judge judge;
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), lostForFrames(format.frames_per_s),
               "inside and nothing felt");
  judge.atMost(percentOff(meanForce(end), truth), kForceMatches, "error of the force when all is at rest");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

}  // namespace

Verdict riseFree(const Challenger& challenger, bool /*quick*/) {
  const Relief relief = [](double x, double y, double t) {
    return 12 + 0.15 * x + 0.08 * y + 60 * std::clamp(t - 0.2, 0.0, 0.14);
  };
  static KeptFilm kept;
  return riseUnder(challenger, relief, kept, {}, Way{{0, {1.3, 0.7, 15}}}, 0.8);
}

Verdict riseContact(const Challenger& challenger, bool /*quick*/) {
  // A dome that comes from the side while it rises, and finally is still.
  const Relief relief = [](double x, double y, double t) {
    const double moved = ramp(t, 0.3, 0.4), dx = x - 8 + 6 * moved;
    return 20 + 6 * moved - 0.01 * (dx * dx + y * y);
  };
  const double z = relief(1, 1, 0);
  const Way finger{{0, {1, 1, z + 2}}, {0.2, {1, 1, z - 2}}};
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, 0.8);
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = 0.8, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const glm::dvec3 hip = finger.at(0.8);
  Judge judge;
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), lostForFrames(30),
               "inside and nothing felt");
  judge.atMost(percentOff(meanForce(between(ticks, 0.75, 0.8)),
                          challenger.stiffness_n_per_mm * (closestOn(relief, hip, 1) - hip)),
               kForceMatches, "error of the force when all is at rest");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict riseFast(const Challenger& challenger, bool /*quick*/) {
  const Relief relief = [](double x, double y, double t) {
    return 8 + 0.05 * x + 0.03 * y + 3000 * std::clamp(t - 0.1, 0.0, 0.008);
  };
  static KeptFilm kept;
  return riseUnder(challenger, relief, kept, {.frames_per_s = 240}, Way{{0, {1.3, 0.7, 13}}}, 0.6);
}

Verdict sweepEdge(const Challenger& challenger, bool /*quick*/) {
  // The block's front runs from x = -10 to 20.
  constexpr double kTop = 25, kFloor = 10, kFinger = 18;
  const Relief relief = [](double x, double y, double t) {
    return x - 0.3 * y < -10 + 30 * ramp(t, 0.1, 0.25) ? kTop : kFloor;
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, 0.8);
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(*method, {.film = film,
                                           .duration_s = 0.8,
                                           .stiffness_n_per_mm = challenger.stiffness_n_per_mm,
                                           .finger = Way{{0, {0.3, 0.4, kFinger}}}});
  // The way out is 7 mm by the top and 20 mm by the front: whichever a method takes, it is at least the top's.
  const double felt =
      glm::length(meanForce(between(ticks, 0.7, 0.8))) / (challenger.stiffness_n_per_mm * (kTop - kFinger));
  Judge judge;
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), lostForFrames(30),
               "inside and nothing felt");
  judge.atLeast(100 * felt, kForceNotBelow, "felt of the way out when all is at rest");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

}  // namespace relievo::scenario
