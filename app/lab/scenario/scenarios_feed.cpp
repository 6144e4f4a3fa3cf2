// SPDX-License-Identifier: Apache-2.0
// Frames that are missing, late or wrong.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "app/lab/scenario/limits.h"
#include "app/lab/scenario/scenario_tools.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo::scenario {
namespace {

constexpr Limit kDropBack{5e3 / 30 + 80, "ms", "derived: a burst of four lost frames and the next one 80 ms late"};
// Two damaged frames and 1.5 to be late would be 117 ms, which `relievo` does not keep in the long run.
constexpr Limit kDamageBack{
    200, "ms",
    "chosen: methods that come back need up to 181 ms and the others never do; the derived limit would be 117"};

}  // namespace

Verdict frameDrop(const Challenger& challenger, bool quick) {
  const double duration = quick ? 3 : 10;
  const Relief relief = [](double x, double y, double t) {
    return 20 + 0.15 * x - 0.1 * y + 6 * std::sin(2 * std::numbers::pi * 1.6 * t);
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, duration);
  // A third of the frames is lost, in bursts of up to four; the others come up to 80 ms after they should be seen, or
  // 100 ms ahead.
  std::mt19937_64 random(11);  // NOLINT(bugprone-random-generator-seed): the same at every run
  std::vector<double> comes(film.size(), 0);
  int burst = 0;
  for (std::size_t i = 6; i + 3 < film.size(); ++i) {
    if (burst == 0 && random() % 8 == 0) burst = 1 + static_cast<int>(random() % 4);
    const double late = -0.1 + 0.18 * static_cast<double>(random() % 1000) / 1000;
    comes[i] = burst > 0 ? 1e9 : toSeconds(film[i].time) + late;
    if (burst > 0) --burst;
  }
  // Deep enough to stay inside all the time.
  const Way finger{{0, {1.2, 0.8, 30}}, {0.2, {1.2, 0.8, 13}}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  Play play{
      .film = film, .duration_s = duration, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger};
  play.supply = [&](std::size_t i, double t) { return comes[i] <= t; };
  const auto ticks = playThrough(*method, play);
  Judge judge;
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), kDropBack, "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict underrun(const Challenger& challenger, bool /*quick*/) {
  constexpr double kStops = 0.5, kGoesOn = 1.0, kEnd = 1.4;
  // While no frame comes the scene rises by 8 mm.
  const Relief relief = [](double x, double y, double t) { return 16 + 0.12 * x - 0.07 * y + 8 * ramp(t, 0.55, 0.95); };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, kEnd);
  const glm::dvec3 rest(1.2, 0.8, relief(1.2, 0.8, 0) - 3);
  const Way finger{{0, rest + glm::dvec3(0, 0, 6)}, {0.2, rest}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  Play play{.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger};
  // Frames of this interval never arrive.
  play.supply = [&](std::size_t i, double t) {
    const double due = toSeconds(film[i].time);
    return due < kStops || (due >= kGoesOn - 0.001 && t >= kGoesOn);
  };
  const auto ticks = playThrough(*method, play);
  const glm::dvec3 back = meanForce(between(ticks, kGoesOn + 0.2, kGoesOn + 0.25));
  const glm::dvec3 truth = challenger.stiffness_n_per_mm * depthOnFlat(relief, rest, kEnd);
  Judge judge;
  // When frames return, the force may start from the one before and be no larger; it must not be gone.
  judge.atLeast(100 * glm::length(back) / (challenger.stiffness_n_per_mm * 3), kHalfIsFelt,
                "of the force before is felt 200 ms after frames are back");
  judge.atMost(glm::length(back) / glm::length(truth) * 100, kForceNotAbove, "of the true force");
  judge.atMost(100 * peakForce(between(ticks, 0.3, kGoesOn)) / (challenger.stiffness_n_per_mm * 3), kForceNotAbove,
               "of the force before in the time without frames");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict packetLoss(const Challenger& challenger, bool quick) {
  const double duration = quick ? 3 : 8;
  const Relief relief = [](double x, double y, double t) {
    return 18 + 0.1 * x - 0.06 * y + 2 * std::sin(2 * std::numbers::pi * 0.5 * t);
  };
  // Every fifth frame, and the one after it, has random blocks of 16 x 16: lowest, highest or random codes.
  std::mt19937_64 random(5);  // NOLINT(bugprone-random-generator-seed): the same at every run
  const Damage damage = [&](int frame, std::vector<std::uint16_t>& codes) {
    constexpr int kBlock = 16;
    if (frame < 10 || frame % 5 > 1) return;
    for (int row = 0; row < MadeFormat::kRows; row += kBlock) {
      for (int col = 0; col < MadeFormat::kCols; col += kBlock) {
        const auto kind = random() % 4;
        const auto code = static_cast<std::uint16_t>(kind == 0 ? 0 : kind == 1 ? 65535 : random() % 65536);
        if (kind == 3) continue;
        for (int r = row; r < std::min(row + kBlock, MadeFormat::kRows); ++r) {
          for (int c = col; c < std::min(col + kBlock, MadeFormat::kCols); ++c) {
            codes[static_cast<std::size_t>(r) * MadeFormat::kCols + c] = code;
          }
        }
      }
    }
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, duration, damage);
  const auto finger = [&](double t, const glm::dvec3&) -> std::optional<glm::dvec3> {
    const double turn = 2 * std::numbers::pi * 0.3 * t;
    const double x = 6 * std::sin(turn), y = 4 * std::sin(2 * turn);
    return glm::dvec3(x, y, 18 + 0.1 * x - 0.06 * y - 5 + 10 * (1 - ramp(t, 0, 0.2)));
  };
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = duration, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  // A hole made by damage has nothing to touch: the time counts from when the picture is whole again, two frames.
  Judge judge;
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), kDamageBack,
               "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

}  // namespace relievo::scenario
