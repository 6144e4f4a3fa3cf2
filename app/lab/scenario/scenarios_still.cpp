// SPDX-License-Identifier: Apache-2.0
// A still scene, and a finger that goes where it is hard: edges, thin things, noise, haste, closed paths.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "app/lab/scenario/scenario_tools.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo::scenario {
namespace {

constexpr double kSlant = 0.3, kLength = 1.0440306508910550;  // sqrt(1 + kSlant^2)
constexpr glm::dvec3 kAcross(1 / kLength, -kSlant / kLength, 0);

// Slanted to the grid: distance from the edge x = kSlant y, in the plane.
double across(double x, double y) {
  return (x - kSlant * y) / kLength;
}
glm::dvec3 placeAt(double q, double z) {
  return q * kAcross + glm::dvec3(0, 0, z);
}

std::vector<StageTick> stroke(const Challenger& challenger, const Relief& relief, const MadeFormat& format,
                              const Way& finger, double duration_s) {
  const auto film = makeFilm(relief, format, 0.2);
  const auto method = challenger.make(kStiffness, film);
  return playThrough(*method, {.film = film, .duration_s = duration_s, .finger = finger});
}

}  // namespace

Verdict strokeStep(const Challenger& challenger, bool /*quick*/) {
  constexpr double kTop = 27.5, kFloor = 12.5;
  const Relief relief = [](double x, double y, double) { return across(x, y) < 0 ? kTop : kFloor; };
  // Over the edge, 2 mm deep; then down, and back against the wall, 3 mm into it.
  const Way finger{{0, placeAt(-8, kTop + 1)},     {0.1, placeAt(-8, kTop - 2)},    {0.28, placeAt(10, kTop - 2)},
                   {0.4, placeAt(10, kTop - 6.5)}, {0.53, placeAt(-3, kTop - 6.5)}, {0.6, placeAt(-3, kTop - 6.5)}};
  const auto ticks = stroke(challenger, relief, {}, finger, 0.6);
  double hung_mm = 0, against = 1e9, most = 0;
  for (const StageTick& tick : ticks) {
    const double q = across(tick.hip_mm.x, tick.hip_mm.y);
    if (tick.t_s > 0.1 && tick.t_s < 0.4 && glm::length(tick.sent_n) > 0.5 * kStiffness * 2)
      hung_mm = std::max(hung_mm, q);
    if (tick.t_s > 0.4 && q < -1) {
      against = std::min(against, glm::dot(tick.sent_n, kAcross) / (kStiffness * -q));
      most = std::max(most, glm::length(tick.sent_n) / (kStiffness * -q));
    }
  }
  Judge judge;
  judge.atMost(hung_mm, 1.5, "mm", "past the edge and still held up");
  judge.atLeast(100 * against, 70, "%", "of the wall's push at least");
  judge.atMost(100 * most, 130, "%", "of the wall's push at most");
  judge.bounds(ticks, kStiffness);
  return judge.verdict();
}

Verdict thin(const Challenger& challenger, bool /*quick*/) {
  constexpr double kWidth = 3 * MadeFormat::kPitchMm, kCrest = 20, kFloor = 10, kFinger = 15, kBeyond = 4;
  double least = 1e9;
  Judge bounds;
  // Three places between the samples.
  for (const double shift : {0.0, 0.07, 0.15}) {
    const Relief relief = [shift](double x, double y, double) {
      return std::abs(across(x - shift, y)) < 0.5 * kWidth ? kCrest : kFloor;
    };
    const Way finger{{0, placeAt(-6, kFinger)}, {0.1, placeAt(kBeyond, kFinger)}};
    const auto ticks = stroke(challenger, relief, {}, finger, 0.15);
    for (const StageTick& tick : between(ticks, 0.09, 0.15)) {
      const double front = across(tick.hip_mm.x - shift, tick.hip_mm.y) + 0.5 * kWidth;
      least = std::min(least, -glm::dot(tick.sent_n, kAcross) / (kStiffness * front));
    }
    bounds.bounds(ticks, kStiffness);
  }
  Judge judge;
  judge.atLeast(100 * least, 80, "%", "of the ridge's push 3 mm and more beyond it");
  judge.atMost(bounds.verdict().figure, bounds.verdict().limit, bounds.verdict().unit.c_str(), bounds.verdict().why);
  return judge.verdict();
}

Verdict noise(const Challenger& challenger, bool quick) {
  constexpr double kDeep = 5;
  const Relief relief = [](double x, double y, double) { return 26 - 0.008 * (x * x + y * y) + 0.1 * x; };
  const double duration = quick ? 1.2 : 3;
  const auto film = makeFilm(relief, {.noise_share = 0.01}, duration);
  const auto method = challenger.make(kStiffness, film);
  const auto place = [](double t) {
    const double turn = 2 * std::numbers::pi * std::max(t - 0.2, 0.0);
    return glm::dvec2(9 * std::sin(1.3 * turn), 7 * std::sin(0.9 * turn + 0.4));
  };
  const auto finger = [&](double t, const glm::dvec3&) -> std::optional<glm::dvec3> {
    const glm::dvec2 p = place(t);
    const double deep = kDeep * std::min(t / 0.1, 2.0) - kDeep;  // comes in from as far outside
    return glm::dvec3(p, relief(p.x, p.y, t)) - deep * normalOf(relief, p.x, p.y, t);
  };
  const auto ticks = playThrough(*method, {.film = film, .duration_s = duration, .finger = finger});
  double squares = 0, furthest = 0;
  const auto counted = between(ticks, 0.3, duration);
  for (const StageTick& tick : counted) {
    const glm::dvec2 p = place(tick.t_s);
    const glm::dvec3 truth = kStiffness * kDeep * normalOf(relief, p.x, p.y, 0);
    const double off = percentOff(tick.sent_n, truth);
    squares += off * off;
    furthest = std::max(furthest, glm::distance(tick.asked.proxy_mm, glm::dvec3(p, relief(p.x, p.y, 0))));
  }
  Judge judge;
  judge.atMost(std::sqrt(squares / static_cast<double>(counted.size())), 4, "%", "rms error of the force vector");
  judge.atMost(furthest, 3, "mm", "proxy off at most: trapped");
  judge.bounds(ticks, kStiffness);
  return judge.verdict();
}

Verdict fastHip(const Challenger& challenger, bool /*quick*/) {
  constexpr double kCrest = 28, kFloor = 13, kSide = 20;
  const Relief relief = [](double x, double y, double) { return std::abs(across(x, y) + 2) < 2 ? kCrest : kFloor; };
  // Through the ridge, out again, and down into the floor; 5 m/s each time.
  const Way through{{0.05, placeAt(-14, kSide)}, {0.0542, placeAt(7, kSide)}};
  const Way down{{0.05, placeAt(8, kFloor + 10)}, {0.054, placeAt(8, kFloor - 10)}};
  const auto sideways = stroke(challenger, relief, {}, through, 0.1);
  const auto downwards = stroke(challenger, relief, {}, down, 0.1);
  const double side = -glm::dot(meanForce(between(sideways, 0.08, 0.1)), kAcross) / (kStiffness * 11);
  const double floor = meanForce(between(downwards, 0.08, 0.1)).z / (kStiffness * 10);
  Judge judge;
  judge.atLeast(100 * std::min(side, floor), 90, "%",
                side < floor ? "of the push of a ridge gone through" : "of the push of a floor gone into");
  judge.bounds(sideways, kStiffness);
  judge.bounds(downwards, kStiffness);
  return judge.verdict();
}

Verdict energyLoop(const Challenger& challenger, bool quick) {
  // Wide hills; steep ones with a step; wide ones under noise. 8 bits.
  const auto hills = [](double x, double y) { return 18 + 3 * std::sin(0.2 * x) * std::cos(0.17 * y); };
  const Relief wide = [=](double x, double y, double) { return hills(x, y); };
  const Relief steep = [=](double x, double y, double) {
    return hills(x, y) + 1.2 * std::sin(0.9 * x + 0.5 * y) + (across(x, y) < 3 ? 2 : 0);
  };
  // Over the step the finger goes on as it did: one that jumped with it would be faster than it is said to be.
  const Relief under_steep = [=](double x, double y, double) {
    return hills(x, y) + 1.2 * std::sin(0.9 * x + 0.5 * y) + 1 - std::tanh(across(x, y) - 3);
  };
  struct Scene {
    Relief finger;  // what its height follows
    std::vector<TimedSurface> film;
  };
  const Scene scenes[] = {{wide, makeFilm(wide, {.bits = 8}, 0.1)},
                          {under_steep, makeFilm(steep, {.bits = 8}, 0.1)},
                          {wide, makeFilm(wide, {.bits = 8, .noise_share = 0.01}, 0)}};
  std::mt19937_64 random(7);  // NOLINT(bugprone-random-generator-seed): the same at every run
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  struct Speed {
    double mm_per_s, limit_mj, field_mj = -1e9, held_mj = -1e9;
  };
  Speed speeds[] = {{100, 0.01}, {500, 0.1}};
  Judge judge, bounds;
  const int loops = quick ? 12 : 60;
  double touched = 0, counted = 0;
  for (Speed& speed : speeds) {
    for (int loop = 0; loop < loops; ++loop) {
      const auto& [follows, film] = scenes[loop % 3];
      const double radius = draw(2, 8), deep = draw(2.5, 4.5), swing = draw(0, 0.5), phase = draw(0, 6);
      const glm::dvec2 centre(draw(-9, 9), draw(-4, 4));
      // A whole number of ticks a lap: the path is closed to the last bit.
      const int lap = std::max(20, static_cast<int>(std::lround(2e3 * std::numbers::pi * radius / speed.mm_per_s)));
      constexpr int kLead = 40;
      const auto finger = [&, &relief = follows](double t, const glm::dvec3&) -> std::optional<glm::dvec3> {
        const int tick = static_cast<int>(std::lround(t * 1e3)) - kLead;
        const double turn = 2 * std::numbers::pi * std::max(tick, 0) / lap;
        const glm::dvec2 p = centre + radius * glm::dvec2(std::cos(turn + phase), std::sin(turn + phase));
        const double above = tick < 0 ? -0.2 * tick : 0;
        return glm::dvec3(p, relief(p.x, p.y, 0) - deep - swing * std::sin(2 * turn) + above);
      };
      const auto method = challenger.make(kStiffness, film);
      const auto ticks =
          playThrough(*method, {.film = film, .duration_s = 1e-3 * (kLead + 2 * lap + 1), .finger = finger});
      // The second lap: the first one may begin from elsewhere.
      double field = 0, held = 0;
      const std::size_t lap_ticks = static_cast<std::size_t>(lap), begin = kLead + lap_ticks, end = begin + lap_ticks;
      for (std::size_t i = begin; i < end; ++i) {
        const glm::dvec3 moved = ticks[i + 1].hip_mm - ticks[i].hip_mm;
        field += 0.5 * glm::dot(ticks[i].asked.force_n + ticks[i + 1].asked.force_n, moved);
        held += glm::dot(ticks[i].sent_n, moved);
      }
      for (const StageTick& tick : between(ticks, 1e-3 * kLead, 10))
        touched += glm::length(tick.asked.force_n) > 0 ? 1 : 0;
      counted += 2 * lap + 1;
      speed.field_mj = std::max(speed.field_mj, field);
      speed.held_mj = std::max(speed.held_mj, held);
      bounds.bounds(ticks, kStiffness);
    }
  }
  for (const Speed& speed : speeds) {
    const std::string at = " that a closed path at " + std::to_string(static_cast<int>(speed.mm_per_s)) + " mm/s gives";
    judge.atMost(std::max(speed.field_mj, 0.0), speed.limit_mj, "mJ", "most" + at + " by the force field");
    judge.atMost(std::max(speed.held_mj, 0.0), 0.05, "mJ", "most" + at + " by the force as it is held over each tick");
  }
  judge.atLeast(100 * touched / counted, 90, "%", "of the paths with a force");
  judge.atMost(bounds.verdict().figure, bounds.verdict().limit, bounds.verdict().unit.c_str(), bounds.verdict().why);
  return judge.verdict();
}

}  // namespace relievo::scenario
