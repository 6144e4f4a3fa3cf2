// SPDX-License-Identifier: Apache-2.0
// Properties of ordinary recordings: flicker, dropouts, passers-by, coarse steps, a moving camera.
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

constexpr glm::dvec2 kPlace{1.2, 0.8};
constexpr const char* kPerceived = kForceDifference.origin;

// The point `depth` below a place of a relief at rest.
glm::dvec3 under(const Relief& relief, const glm::dvec2& place, double deep_mm) {
  return glm::dvec3(place, relief(place.x, place.y, 0)) - deep_mm * normalOf(relief, place.x, place.y, 0);
}

Way pressAt(const Relief& relief, const glm::dvec2& place, double deep_mm) {
  return {{0, under(relief, place, -deep_mm)}, {0.2, under(relief, place, deep_mm)}};
}

Relief dome(double top_mm) {
  return [=](double x, double y, double) { return top_mm - 0.01 * (x * x + y * y); };
}

class RootMeanSquare {
 public:
  void add(double value) { sum_ += value * value, ++count_; }
  [[nodiscard]] double value() const { return std::sqrt(sum_ / std::max(count_, 1)); }

 private:
  double sum_ = 0;
  int count_ = 0;
};

// Each frame is scaled about the far plane and shifted by random amounts of its own.
Relief flickering(const Relief& still, double frames_per_s, double duration_s) {
  struct Change {
    double scale, shift_mm;
  };
  std::mt19937_64 random(13);  // NOLINT(bugprone-random-generator-seed): the same at every run
  std::normal_distribution<double> one_percent(0, 0.01);
  std::vector<Change> changes(static_cast<std::size_t>(std::ceil(duration_s * frames_per_s)) + 1);
  for (Change& change : changes) {
    change.scale = 1 + one_percent(random);
    change.shift_mm = MadeFormat::kVolume.depth_mm * one_percent(random);
  }
  return [=](double x, double y, double t) {
    const Change& change = changes[static_cast<std::size_t>(std::lround(t * frames_per_s))];
    return change.scale * still(x, y, t) + change.shift_mm;
  };
}

constexpr int kHoleEvery = 10, kHoleMost = 3;  // frames

Damage holesAt(const glm::dvec2& place) {
  return [=](int frame, std::vector<std::uint16_t>& codes) {
    const int round = frame / kHoleEvery;
    if (round == 0 || frame % kHoleEvery > round % kHoleMost) return;
    const GridMapping grid(MadeFormat::kVolume, MadeFormat::kCols, MadeFormat::kRows);
    for (int r = 0; r < MadeFormat::kRows; ++r) {
      for (int c = 0; c < MadeFormat::kCols; ++c) {
        if (std::hypot(grid.x(c) - place.x, grid.y(r) - place.y) > 2) continue;
        codes[static_cast<std::size_t>(r) * MadeFormat::kCols + static_cast<std::size_t>(c)] = 0;
      }
    }
  };
}

// 30 frames/s, then 12 and 20 in turns, then 60: frames of a film of 60.
std::vector<TimedSurface> atChangingRate(const std::vector<TimedSurface>& film) {
  std::vector<TimedSurface> kept;
  for (std::size_t i = 0; i < film.size();) {
    kept.push_back(film[i]);
    if (i < 60) i += 2;
    else if (i < 120) i += kept.size() % 2 == 0 ? 5 : 3;
    else ++i;
  }
  return kept;
}

}  // namespace

Verdict flicker(const Challenger& challenger, bool quick) {
  const double duration = quick ? 2.5 : 6;
  const Relief still = dome(24);
  static KeptFilm kept;
  const auto& film = kept.make(flickering(still, 30, duration), {.bits = 8}, duration);
  const glm::dvec2 slope(6, 3);
  const Way finger = pressAt(still, slope, 5);
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = duration, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const glm::dvec3 truth = challenger.stiffness_n_per_mm * 5.0 * normalOf(still, slope.x, slope.y, 0);
  RootMeanSquare off;
  for (const StageTick& tick : between(ticks, 0.5, duration)) off.add(percentOff(tick.sent_n, truth));
  Judge judge;
  judge.atMost(off.value(), kForceDifference, "rms error of the force against the scene without flicker");
  judge.atMost(longestLostMs(ticks, still, 0.3, challenger.stiffness_n_per_mm), lostForFrames(30),
               "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict dropout(const Challenger& challenger, bool quick) {
  constexpr double kFps = 30;
  constexpr Limit kHoleAndLate{1e3 * (kHoleMost + 1.5) / kFps, "ms",
                               "derived: three frames of a hole and 1.5 to be late"};
  const int rounds = quick ? 5 : 11;
  const double duration = rounds * kHoleEvery / kFps;
  const Relief relief = plane(20, 0.15, -0.1);
  static KeptFilm kept;
  const auto& film = kept.make(relief, {.zero_is_hole = true}, duration, holesAt(kPlace));
  const Way finger = pressAt(relief, kPlace, 3);
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = duration, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const glm::dvec3 truth = challenger.stiffness_n_per_mm * 3.0 * normalOf(relief, kPlace.x, kPlace.y, 0);
  double worst = 0;
  for (int round = 2; round < rounds; ++round) {
    const double hole = round * kHoleEvery / kFps;
    const double off = percentOff(meanForce(between(ticks, hole - 3 / kFps, hole)), truth);
    worst = off <= worst ? worst : off;  // keeps a NaN
  }
  Judge judge;
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), kHoleAndLate,
               "inside and nothing felt");
  judge.atMost(100 * peakForce(between(ticks, 0.3, duration)) / glm::length(truth), {106, "%", kPerceived},
               "of the force without holes: peak");
  judge.atMost(worst, kForceDifference, "error of the force before the next hole");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict passBefore(const Challenger& challenger, bool /*quick*/) {
  constexpr double kSpeed = 300, kHalfWidth = 6, kAtMiddle = 0.5, kEnd = 0.9;
  const Relief still = dome(20);
  const Relief relief = [=](double x, double y, double t) {
    return std::abs(across(x, y) - kSpeed * (t - kAtMiddle)) < kHalfWidth ? 30 : still(x, y, t);
  };
  static KeptFilm kept;
  const auto& film = kept.make(relief, {.bits = 8}, kEnd);
  const Way finger = pressAt(still, kPlace, 2);
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const glm::dvec3 truth = challenger.stiffness_n_per_mm * 2.0 * normalOf(still, kPlace.x, kPlace.y, 0);
  const glm::dvec3 rest = finger.at(kEnd);
  const double gone = kAtMiddle + (across(rest.x, rest.y) + kHalfWidth) / kSpeed;
  double again = 0;  // s after the hand has gone
  for (const StageTick& tick : between(ticks, gone, kEnd)) {
    if (!(percentOff(tick.sent_n, truth) <= kForceDifference.value)) again = tick.t_s + TouchStage::kTickS - gone;
  }
  Judge judge;
  judge.atMost(1e3 * again, {90, "ms", "derived: 1.5 frames to be late and as long as a force limited to 50 N/s rose"},
               "from the hand's end until the force is that of the dome within 6 %");
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), lostForFrames(30),
               "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict coarseSteps(const Challenger& challenger, bool /*quick*/) {
  constexpr double kFrom = -9, kTo = 9, kSpeed = 20, kDeep = 5, kThere = 0.2, kEnd = kThere + (kTo - kFrom) / kSpeed;
  const Relief slope = [](double x, double y, double) { return 20 + 0.1 * across(x, y); };
  static KeptFilm kept;
  const auto& film = kept.make(slope, {.bits = 6}, 0.2);
  const auto at = [&](double q, double deep_mm) {
    return under(slope, glm::dvec2(q, -q * kEdgeSlant) / kEdgeLength, deep_mm);
  };
  const Way finger{{0, at(kFrom, -kDeep)}, {kThere, at(kFrom, kDeep)}, {kEnd, at(kTo, kDeep)}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  const glm::dvec3 truth = challenger.stiffness_n_per_mm * kDeep * normalOf(slope, 0, 0, 0);
  RootMeanSquare degrees, size;
  for (const StageTick& tick : between(ticks, kThere + 0.05, kEnd)) {
    degrees.add(degreesBetween(tick.sent_n, truth));
    size.add(100 * (glm::length(tick.sent_n) / glm::length(truth) - 1));
  }
  Judge judge;
  judge.atMost(degrees.value(), kDirectionMatches, "rms error of the direction");
  judge.atMost(size.value(), kForceDifference, "rms error of the size");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

Verdict cameraMove(const Challenger& challenger, bool /*quick*/) {
  constexpr double kEnd = 3, kWave = 2 * std::numbers::pi / 25;
  const Relief relief = [](double x, double y, double t) {
    const double zoom = 1 + 0.25 * t / kEnd;
    return 20 + 1.5 * std::sin(kWave * (x / zoom + 30 * t)) * std::cos(kWave * y / zoom);
  };
  static const auto film = atChangingRate(makeFilm(relief, {.frames_per_s = 60}, kEnd));
  const Way finger{{0, {kPlace, 25}}, {0.2, {kPlace, 15}}};
  const auto method = challenger.make(challenger.stiffness_n_per_mm, film);
  const auto ticks = playThrough(
      *method,
      {.film = film, .duration_s = kEnd, .stiffness_n_per_mm = challenger.stiffness_n_per_mm, .finger = finger});
  RootMeanSquare off;
  for (const StageTick& tick : between(ticks, 0.5, kEnd)) {
    const glm::dvec3 closest = closestOn(relief, tick.hip_mm, toSeconds(tick.media));
    off.add(percentOff(tick.sent_n, challenger.stiffness_n_per_mm * (closest - tick.hip_mm)));
  }
  Judge judge;
  judge.atMost(off.value(), kForceDifference, "rms error of the force");
  judge.atMost(longestLostMs(ticks, relief, 0.3, challenger.stiffness_n_per_mm), lostForFrames(12),
               "inside and nothing felt");
  judge.bounds(ticks, challenger.stiffness_n_per_mm);
  return judge.verdict();
}

}  // namespace relievo::scenario
