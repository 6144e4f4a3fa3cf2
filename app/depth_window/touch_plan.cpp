// SPDX-License-Identifier: Apache-2.0
// Robust measures over a lattice of places, and the formulas that turn them into widths.
#include "app/depth_window/touch_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

namespace relievo {
namespace {

constexpr int kAcross = 64, kDown = 48;
constexpr double kEdgeMm = 3.0;
constexpr double kRoundingMm = 1e-6;
constexpr double kLeastErrorTold = 0.001;

// The value below which a share of the list lies; 0 of none.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The middle sample of each field of the lattice; the two beside it are inside the picture.
template <class Visit>
void forPlaces(const HeightField& field, Visit&& visit) {
  if (field.cols() < 3 || field.rows() < 1) return;
  for (int r = 0; r < kDown; ++r) {
    for (int c = 0; c < kAcross; ++c) {
      visit(std::clamp((2 * c + 1) * field.cols() / (2 * kAcross), 1, field.cols() - 2),
            (2 * r + 1) * field.rows() / (2 * kDown));
    }
  }
}

// Across the samples of a row a smooth surface is straight: the second difference is noise, of 6 x its variance, and
// the median does not see edges.
void lookAcross(const HeightField& field, std::vector<double>& bends, std::size_t& edges, double& quantum) {
  forPlaces(field, [&](int c, int r) {
    const double left = field.heightMm(c - 1, r), here = field.heightMm(c, r), right = field.heightMm(c + 1, r);
    const double bend = std::abs(left - 2 * here + right);
    // What lies at either end of the range is often painted there, and has no noise.
    if (std::isnan(bend) || here <= 0 || here >= field.depthMm()) return;
    bends.push_back(bend);
    const double step = std::abs(right - here);
    // On a steep slope every step is more than one quantum; how the steps differ tells.
    for (const double d : {step, bend}) {
      if (d > kRoundingMm && d < kEdgeMm) quantum = std::min(quantum, d);
    }
    if (std::max(step, std::abs(here - left)) > kEdgeMm) ++edges;
  });
}

void lookAhead(const TimedSurface& from, const TimedSurface& to, std::vector<double>& speeds, bool& still) {
  const double period = toSeconds(to.time - from.time);
  forPlaces(from.field, [&](int c, int r) {
    const double moved = std::abs(to.field.heightMm(c, r) - from.field.heightMm(c, r));
    if (std::isnan(moved)) return;
    speeds.push_back(moved / period);
    if (moved > 0) still = false;
  });
}

}  // namespace

ClipMeasure measureClip(std::span<const TimedSurface> frames) {
  ClipMeasure m;
  m.frames = static_cast<int>(frames.size());
  if (frames.empty()) return m;
  std::vector<double> bends, speeds;
  std::size_t edges = 0;
  double quantum = std::numeric_limits<double>::infinity();
  m.still = true;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    lookAcross(frames[i].field, bends, edges, quantum);
    if (i > 0 && frames[i].shot == frames[i - 1].shot) lookAhead(frames[i - 1], frames[i], speeds, m.still);
  }
  if (frames.size() > 1) {
    m.period_s = toSeconds(frames.back().time - frames.front().time) / static_cast<double>(frames.size() - 1);
  }
  m.sample_mm = 1 / std::abs(frames.front().field.grid().u_per_mm);
  m.quantum_mm = frames.front().field.stepMm();
  if (bends.empty()) return m;  // nothing but the ends of the range: what it will be like is not known
  m.edges = static_cast<double>(edges) / static_cast<double>(bends.size());
  if (std::isfinite(quantum)) m.quantum_mm = quantum;
  // A slope that is cut into steps bends by one step at every other sample: that much is the quantum's.
  const double deviation = quantile(bends, 0.5) / (0.6745 * std::sqrt(6.0));
  const double of_quantum = 0.61 * m.quantum_mm;
  m.noise_mm = std::sqrt(std::max(deviation * deviation - of_quantum * of_quantum, 0.0));
  m.speed_mm_per_s =
      std::max(quantile(speeds, 0.95) - (m.noise_mm * 2.8 + m.quantum_mm) / std::max(m.period_s, 1e-3), 0.0);
  return m;
}

TouchPlan planTouch(const ClipMeasure& m) {
  constexpr double kNarrowMm = 0.28, kFineNarrowMm = 0.14, kWidestMm = 1.2;
  constexpr double kTimesTheNarrow = 1.8;  // less is one level twice
  constexpr double kFineMm = 0.02;         // steps and noise that are not felt even through 0.14 mm
  const bool noisy = m.noise_mm > std::max(m.quantum_mm, kFineMm);
  const bool fine = !noisy && m.quantum_mm < kFineMm;
  TouchPlan plan;
  plan.measure = m;
  FeltScale& s = plan.scale;

  // A film that begins still may move later: it is treated as one that moves. (A picture costs no work in time under
  // any law: all the weight lies on its one frame.) Noise is averaged by the smoother law.
  if (noisy) s.narrow_time = s.wide_time = TimeLaw::BSpline;
  else s.wide_time = TimeLaw::Fitted;

  // Share of the noise's power that the weights of the frames let through: the mean of their sum of squares. Frames
  // that repeat each other have the same noise.
  const double through = m.still ? 1.0 : s.wide_time == TimeLaw::BSpline ? 0.48 : 0.75;
  // Error of direction of a Gaussian of width w on white noise s from samples p apart: s p sqrt(g) sqrt(1.2)/(3.54 w^2)
  // times the square root of 1.2; on steps of q, at the worst slope, q/(7.09 w). About so many samples of a block are
  // read: in a fine picture they lie w/(kSigmaPerPitch x as many) apart, and it is no calmer for being finer.
  const double noise_scale = 1.2 * m.noise_mm * std::sqrt(through) / 3.54;
  const auto apart = [&](double w, int read) { return std::max(m.sample_mm, w / (kSigmaPerPitch * read)); };
  const auto width = [&](double error) {
    return std::max({std::sqrt(noise_scale * m.sample_mm / error),
                     noise_scale / (kSigmaPerPitch * kWideSamples * error), m.quantum_mm / (7.09 * error)});
  };
  s.narrow_mm = fine ? kFineNarrowMm : kNarrowMm;
  s.wide_mm = std::clamp(width(kErrorWanted), kTimesTheNarrow * s.narrow_mm, kWidestMm);
  const double of_noise = noise_scale * apart(s.wide_mm, kWideSamples) / (s.wide_mm * s.wide_mm);
  const double of_steps = m.quantum_mm / (7.09 * s.wide_mm);
  plan.error = std::max(of_noise, of_steps);

  // What the narrow level is off by must fit under the clamp: four standard deviations of its noise, and a step, within
  // which the wide level is to tell alone (FeltSurface).
  const double narrow_noise = m.noise_mm * apart(s.narrow_mm, kNarrowSamples) * std::sqrt(through) /
                              (s.narrow_mm * std::sqrt(4 * std::numbers::pi));
  s.clamp_mm = std::max({0.15, 1.5 * std::min(m.quantum_mm, 0.2), 4 * narrow_noise});

  char depth[120], error[40] = "under 0.1 %";
  std::snprintf(depth, sizeof depth, "steps of %.3f mm, noise %.3f mm, %.0f mm/s%s", m.quantum_mm, m.noise_mm,
                m.speed_mm_per_s, m.still ? " (still)" : "");
  if (plan.error >= kLeastErrorTold) std::snprintf(error, sizeof error, "about %.1f %%", 100 * plan.error);
  plan.reason = std::string(depth) + ": " + describe(s) + "; error of the force " + error;
  return plan;
}

std::string describe(const FeltScale& s) {
  char text[120];
  const bool alike = s.narrow_time == s.wide_time;
  std::snprintf(text, sizeof text, "levels of %.2f and %.2f mm, %s%s%s in time", s.narrow_mm, s.wide_mm,
                alike ? "" : name(s.narrow_time), alike ? "" : " and ", name(s.wide_time));
  return text;
}

TouchPlan planFilm(std::span<const TimedSurface> first_frames) {
  return planTouch(measureClip(first_frames.first(std::min(first_frames.size(), kPlanFrames))));
}

}  // namespace relievo
