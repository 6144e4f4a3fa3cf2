// SPDX-License-Identifier: Apache-2.0
// A hand on a real device, a machine that misses ticks, encoders that jump.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "app/lab/finger/hand_loop.h"
#include "app/lab/scenario/limits.h"
#include "app/lab/scenario/scenario_tools.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo::scenario {
namespace {

// Two steps of the encoder, there and back.
constexpr Limit kSwing{60, "µm", "derived: a device at rest may flip between two steps of its encoder (30 µm)"};
constexpr Limit kHoldsUp{1, "N", "chosen: methods that hold up have 1.9 N or more"};

struct Rest {
  double swing_mm = 0;  // in the last half second
  std::vector<StageTick> ticks;
};

// A hand comes in and presses on for two seconds.
Rest pressOn(const Challenger& challenger, std::span<const TimedSurface> film, double stiffness,
             const glm::dvec3& from_mm, const glm::dvec3& to_mm) {
  const DeviceProfile profile;
  HandLoop hand(profile, from_mm);
  const auto method = challenger.make(stiffness, film);
  glm::dvec3 low(1e9), high(-1e9);
  const auto finger = [&](double t, const glm::dvec3& held_n) -> std::optional<glm::dvec3> {
    if (t > 0) hand.tick(held_n, glm::mix(from_mm, to_mm, ramp(t, 0.1, 0.5)));
    if (t >= 1.5) {
      low = glm::min(low, hand.position());
      high = glm::max(high, hand.position());
    }
    return hand.encoded();
  };
  Rest rest;
  rest.ticks = playThrough(
      *method, {.film = film, .duration_s = 2, .stiffness_n_per_mm = stiffness, .peak_force_n = 8.5, .finger = finger});
  rest.swing_mm = glm::length(high - low);
  return rest;
}

// The position that the device reports for a finger at `p` at a tick; nullopt: the exchange fails.
std::optional<glm::dvec3> asEncoded(const glm::dvec3& p, int tick) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (tick == 500) return p + glm::dvec3(0, 0, 12);                   // outside
  if (tick == 800) return p - glm::dvec3(0, 0, 10);                   // deeper
  if (tick == 1100 || tick == 1101) return p + glm::dvec3(60, 0, 0);  // off the picture
  if (tick >= 1400 && tick <= 1404) return std::nullopt;
  if (tick == 1700) return glm::dvec3(kNaN, 0, 0);
  if (tick == 2000) return p * 1e12;
  return p;
}

}  // namespace

Verdict stiffWall(const Challenger& challenger, bool /*quick*/) {
  const DeviceProfile profile;
  const double stiffness = 0.8 * std::min(profile.viscousBound(), profile.frictionBound());
  // A crease of 90 degrees, slanted to the grid; and a wall in 8 bits, whose terraces are 2 mm wide.
  const Relief crease = [](double x, double y, double) { return 12 + std::abs(x - 0.3 * y) * 0.96; };
  static const auto crease_film = makeFilm(crease, {}, 0.1);
  static const auto wall_film = makeFilm(plane(20, 0.07, 0.03), {.bits = 8}, 0.1);
  const Rest in_crease = pressOn(challenger, crease_film, stiffness, {0.9, 0.3, 20}, {0.4, 0.3, 2});
  const Rest on_wall = pressOn(challenger, wall_film, stiffness, {2.2, 1.1, 25}, {2.2, 1.1, 12});
  const bool crease_worse = in_crease.swing_mm > on_wall.swing_mm;
  Judge judge;
  judge.atMost(1e3 * std::max(in_crease.swing_mm, on_wall.swing_mm), kSwing,
               crease_worse ? "swing of a hand that rests in a crease" : "swing of a hand that rests on a wall");
  judge.atLeast(meanForce(between(in_crease.ticks, 1.5, 2)).z, kHoldsUp, "that the crease holds up");
  judge.atLeast(meanForce(between(on_wall.ticks, 1.5, 2)).z, kHoldsUp, "that the wall holds up");
  judge.bounds(in_crease.ticks, stiffness, 8.5);
  judge.bounds(on_wall.ticks, stiffness, 8.5);
  return judge.verdict();
}

Verdict jitter(const Challenger& challenger, bool quick) {
  const double duration = quick ? 2 : 8;
  const Relief relief = [](double x, double y, double t) {
    return 20 + 0.15 * x - 0.1 * y + 3 * std::sin(2 * std::numbers::pi * 1.5 * t);
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, duration);
  // A finger that trembles, always inside.
  const auto finger = [](double t, const glm::dvec3&) -> std::optional<glm::dvec3> {
    const double come = 1 - ramp(t, 0, 0.15), tremble = std::sin(2 * std::numbers::pi * 5 * t);
    return glm::dvec3(1.2, 0.8, 13 + 3 * tremble * (1 - come) + 14 * come);
  };
  std::mt19937_64 random(3);  // NOLINT(bugprone-random-generator-seed): the same at every run
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  Play play{
      .film = film, .duration_s = duration, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger};
  play.ticks_to_next = [&](double t) {
    return t > 0.3 && random() % 40 == 0 ? 2 + static_cast<int>(random() % 20) : 1;
  };
  const auto ticks = playThrough(*method, play);
  Judge judge;
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), kDelayUnnoticed,
               "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict deviceGlitch(const Challenger& challenger, bool /*quick*/) {
  constexpr double kEnd = 2.5;
  const Relief relief = [](double x, double y, double t) {
    return 20 + 0.15 * x - 0.1 * y + 1.5 * std::sin(2 * std::numbers::pi * 0.5 * t);
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, kEnd);
  const auto finger = [](double t, const glm::dvec3&) -> std::optional<glm::dvec3> {
    const double turn = 2 * std::numbers::pi * 0.5 * t;
    const double x = 4 * std::sin(turn), y = 3 * std::cos(turn);
    const glm::dvec3 p(x, y, 20 + 0.15 * x - 0.1 * y - 4 + 8 * (1 - ramp(t, 0, 0.2)));
    return asEncoded(p, static_cast<int>(std::lround(t * 1e3)));
  };
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  // Without contact, or with hardly any force.
  double longest = 0, since = -1;
  for (const StageTick& tick : between(ticks, 0.4, kEnd)) {
    const glm::dvec3 truth = challenger.stiffness_n_per_mm *
                             depthOnFlat(relief, finger(tick.t_s + 0.0001, {}).value_or(tick.hip_mm), tick.t_s);
    const bool lost = glm::length(tick.sent_n) < 0.5 * glm::length(truth);
    if (!lost) since = -1;
    else if (since < 0) since = tick.t_s;
    if (lost) longest = std::max(longest, tick.t_s + TouchStage::kTickS - since);
  }
  Judge judge;
  judge.atMost(1e3 * longest, kDelayUnnoticed, "inside and less than half of the force");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

}  // namespace relievo::scenario
