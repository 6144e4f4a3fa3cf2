// SPDX-License-Identifier: Apache-2.0
// Cuts, a held film, and a film that is paused or sought.
#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/lab/scenario/limits.h"
#include "app/lab/scenario/scenario_tools.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo::scenario {
namespace {

Relief cutBetween(const Relief& before, const Relief& after, double cut_s) {
  return [=](double x, double y, double t) { return t < cut_s ? before(x, y, t) : after(x, y, t); };
}

// Amplitude of the force at a frequency, through a Hann window, N.
double swingAt(std::span<const StageTick> ticks, double hz) {
  std::complex<double> sums[3];
  double weights = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(ticks.size());
    const double weight = 1 - std::cos(2 * std::numbers::pi * share);
    const auto turn = std::polar(weight, -2 * std::numbers::pi * hz * ticks[i].t_s);
    for (int axis = 0; axis < 3; ++axis) sums[axis] += turn * ticks[i].sent_n[axis];
    weights += weight;
  }
  return 2 * std::sqrt(std::norm(sums[0]) + std::norm(sums[1]) + std::norm(sums[2])) / weights;
}

constexpr glm::dvec2 kPlace{2.1, 1.3};

// 10 um at the finger on the spring. Verrillo, Effect of contactor area on the vibrotactile threshold (1963).
constexpr Limit kUnfeltSwing{
    5, "mN", "derived: 10 µm is about the threshold of vibration at 15 Hz (Verrillo 1963); times the stiffness"};

glm::dvec3 below(const Relief& relief, double deep_mm) {
  return {kPlace, relief(kPlace.x, kPlace.y, 0) - deep_mm};
}

// After a cut the finger has come from outside, and feels the new scene.
void judgeLastForce(Judge& judge, std::span<const StageTick> ticks, double end_s, const glm::dvec3& wanted_n) {
  judge.atMost(percentOff(meanForce(between(ticks, end_s - 0.1, end_s)), wanted_n), kForceMatches,
               "error of the force for a finger that comes from outside");
}

}  // namespace

Verdict cutUp(const Challenger& challenger, bool /*quick*/) {
  constexpr double kCut = 0.5, kLift = 0.8, kOut = 1.1, kBack = 1.3, kEnd = 1.5;
  const Relief before = plane(12, 0.15, 0), after = plane(30, -0.25, 0.1);
  const Relief relief = cutBetween(before, after, kCut - 0.001);
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, kEnd);
  const Way finger{{0, below(before, -3)},
                   {0.2, below(before, 2)},
                   {kLift, below(before, 2)},
                   {kOut, below(after, -3)},
                   {kBack, below(after, 2)}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const double pressed = glm::length(meanForce(between(ticks, 0.35, 0.45)));
  const glm::dvec3 soon = meanForce(between(ticks, kCut + 0.05, kCut + 0.07));
  Judge judge;
  judge.atMost(100 * peakForce(between(ticks, 0.45, kLift)) / pressed, kNothingAdded,
               "of the force before the cut: peak at the cut");
  judge.atLeast(100 * glm::length(soon) / pressed, kHalfIsFelt, "of the force before the cut is felt 50 ms after it");
  judge.atMost(degreesBetween(soon, normalOf(after, kPlace.x, kPlace.y, 0)), kDirectionMatches,
               "from the new shape 50 ms after the cut");
  judgeLastForce(judge, ticks, kEnd, challenger.stiffness_n_per_mm * depthOnFlat(after, finger.at(kEnd), 0));
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict cutDown(const Challenger& challenger, bool /*quick*/) {
  // 15 frames/s: the surface moves far from one frame to the next.
  constexpr double kCut = 8.0 / 15, kDown = kCut + 0.06, kThere = kCut + 0.15, kEnd = kCut + 0.35;
  const Relief before = plane(23, 0.15, 0), after = plane(14, -0.25, 0.1);
  const Relief relief = cutBetween(before, after, kCut - 0.001);
  static KeptFilm kept;
  const auto& film = kept.make(relief, {.frames_per_s = 15}, kEnd);
  const Way finger{
      {0, below(before, -3)}, {0.2, below(before, 2)}, {kDown, below(before, 2)}, {kThere, below(after, 2)}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const double pressed = glm::length(meanForce(between(ticks, 0.3, 0.4)));
  double early = 0, late = 0;  // ms before and after the cut
  for (const StageTick& tick : between(ticks, 0.4, kDown)) {
    const double share = glm::length(tick.sent_n) / pressed;
    if (tick.t_s < kCut && std::abs(share - 1) > 0.1) early = std::max(early, kCut - tick.t_s);
    if (tick.t_s > kCut && share > 0.1) late = std::max(late, tick.t_s - kCut);
  }
  Judge judge;
  judge.atMost(1e3 * early, kDelayUnnoticed, "that the old scene is left before the cut");
  judge.atMost(1e3 * late, kDelayUnnoticed, "that the old scene is felt after the cut");
  judge.atMost(100 * peakForce(between(ticks, 0.4, kDown)) / pressed, kNothingAdded,
               "of the force before the cut: peak at the cut");
  judgeLastForce(judge, ticks, kEnd, challenger.stiffness_n_per_mm * depthOnFlat(after, finger.at(kEnd), 0));
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict holdVideo(const Challenger& challenger, bool quick) {
  constexpr double kFps = 15, kMoves = 0.4, kFrom = 0.8;
  const double duration = kFrom + (quick ? 2 : 6);
  // Begins with a still picture, as films do.
  const Relief relief = [](double x, double y, double t) {
    const double turn = 2 * std::numbers::pi * std::max(t - kMoves, 0.0);
    const double dx = x - 3 * std::sin(0.53 * turn);
    return 24 + 3 * std::sin(0.71 * turn) - 0.015 * (dx * dx + y * y);
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {.frames_per_s = kFps, .bits = 8}, duration);
  const Way finger{{0, {1.7, 0.6, 31}}, {0.3, {1.7, 0.6, 18}}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = duration, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  // Motion at f leaves images at the frame rate -/+ f, and at twice that rate; counts the highest line there.
  const auto counted = between(ticks, kFrom, duration);
  double largest = 0;
  for (const double centre : {kFps, 2 * kFps}) {
    for (int tenths = -20; tenths <= 20; ++tenths) {
      largest = std::max(largest, swingAt(counted, centre + 0.1 * tenths));
    }
  }
  Judge judge;
  judge.atMost(1e3 * largest, kUnfeltSwing, "swing of the force at the frame rate");
  judge.atMost(longestLostMs(ticks, relief, 2, challenger.stiffness_n_per_mm), lostForFrames(kFps),
               "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict seek(const Challenger& challenger, bool /*quick*/) {
  constexpr double kJump = 0.5, kThere = 0.6, kEnd = 1.0, kTo = 2.0;
  const Relief before = plane(14, 0.15, 0), after = plane(24, -0.2, 0.1);
  const Relief relief = cutBetween(before, after, 1.5);
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, 3);
  const Way finger{{0, below(before, -3)}, {0.2, below(before, 2)}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  Play play{.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger};
  play.clock = [=](double t) {
    if (t < kJump) return Play::Moment{.media_s = t};
    return t < kThere ? Play::Moment{.media_s = kTo, .rate = 0, .epoch = 1}
                      : Play::Moment{.media_s = kTo + t - kThere, .epoch = 1};
  };
  // After the jump no frame of the old position is handed out, and those of the new one take a while.
  play.supply = [&](std::size_t i, double t) {
    const bool old = toSeconds(film[i].time) < 1.5;
    return old ? t < kJump : t >= kThere;
  };
  const auto ticks = playThrough(*method, play);
  const double pressed = glm::length(meanForce(between(ticks, 0.35, 0.45)));
  const glm::dvec3 settled = meanForce(between(ticks, kThere + 0.2, kThere + 0.25));
  Judge judge;
  judge.atLeast(100 * glm::length(settled) / pressed, kHalfIsFelt,
                "of the force before is felt 200 ms after the picture is there");
  judge.atMost(100 * peakForce(between(ticks, 0.45, kEnd)) / pressed, kNothingAdded, "of the force before at most");
  judge.atMost(degreesBetween(settled, normalOf(after, kPlace.x, kPlace.y, 0)), kDirectionMatches,
               "from the new shape");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict pause(const Challenger& challenger, bool /*quick*/) {
  constexpr double kPaused = 0.55, kResumed = 1.5, kEnd = 2.0, kBack = 1.0 / 30;
  const Relief relief = [](double x, double y, double t) {
    return 20 + 0.12 * x - 0.07 * y + 5 * std::sin(2 * std::numbers::pi * 1.9 * (t - 0.4));
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {}, kEnd);
  const double z = relief(0, 0, kPaused - kBack);
  // Comes in while the scene is low, and presses on through the pause with small strokes.
  const auto finger = [&](double t, const glm::dvec3&) -> std::optional<glm::dvec3> {
    const double come = 30 * std::max(0.0, 0.3 - t), round = 2 * std::numbers::pi * std::max(0.0, t - 0.7);
    return glm::dvec3(3 * std::sin(round), 2 * std::sin(2 * round),
                      z - 3 + come + (t < 0.3 ? 4 : 4 - 4 * ramp(t, 0.3, 0.5)));
  };
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  Play play{.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger};
  play.clock = [=](double t) {
    if (t < kPaused) return Play::Moment{.media_s = t};
    return t < kResumed ? Play::Moment{.media_s = kPaused - kBack, .rate = 0}
                        : Play::Moment{.media_s = t - kResumed + kPaused - kBack};
  };
  const auto ticks = playThrough(*method, play);
  double worst = 0;
  for (const StageTick& tick : between(ticks, kPaused + 0.2, kResumed)) {
    worst = std::max(worst, percentOff(tick.sent_n, challenger.stiffness_n_per_mm *
                                                        depthOnFlat(relief, tick.hip_mm, toSeconds(tick.media))));
  }
  Judge judge;
  judge.atMost(worst, kForceMatches, "largest error of the force on the still picture");
  judge.atMost(longestLostMs(ticks, relief, 2.5, challenger.stiffness_n_per_mm), lostForFrames(30),
               "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

}  // namespace relievo::scenario
