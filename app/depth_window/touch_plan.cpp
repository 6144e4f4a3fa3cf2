// SPDX-License-Identifier: Apache-2.0
// The formulas that turn a clip's measures into smoothing widths.
#include "app/depth_window/touch_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kLeastErrorTold = 0.001;

constexpr double kNarrowMm = 0.28, kFineNarrowMm = 0.14, kWidestMm = 2.5;
constexpr double kStepOfSearch = 1.02;
constexpr double kTimesTheNarrow = 1.8;  // a smaller ratio would build the same level twice
constexpr double kFineMm = 0.02;         // steps and noise imperceptible even with a width of 0.14 mm

// Share of the noise power that the weights of the frames pass: the sum of the squared weights (frameWeights), averaged
// over the time between two frames. For the cubic B-spline it is 151/315 = 0.479. For the fitted spline it is 0.670;
// the charts were made with 0.75, which widens the smoothing by at most 6 %.
constexpr double kBSplineNoise = 0.48, kFittedNoise = 0.75, kLinearNoise = 2.0 / 3;

// The B-spline in time flattens a motion: where its acceleration is a and a frame lasts T, the surface is off by a
// T^2/6, the spline's variance in time being T^2/3. The fitted spline adds as much again, and noise with it: .17 of a
// control point's, which is 1.9 of its block's mean. Noise and steps count as steady up to a few standard deviations of
// that, what a codec makes of the steps up to three times as much. Three paths over the smooth scenes of relievo-lab,
// the worst one, without what is added and with it: crf 23 1.793 and 1.804 % of the force, noise of 1 % 1.243 and
// 1.244; a pan of 100 mm/s over hills of 12 mm curvature radius, 8 bits: 2.19 and .44 %.
constexpr double kSteadyNoise = 1.4, kSteadySteps = 0.12, kSteadyCoded = 0.36;

// A face that nods by 5 mm once a second has an acceleration of 200 mm/s^2. At 15 frames a second the B-spline is off
// by .15 mm, as much as a step of 8 bits, which it is to smooth: then the fitted one is taken everywhere.
constexpr double kNodMmPerS2 = 200;

// Flicker moves the whole surface, so that no smoothing in space removes it. The mean of five frame periods passes
// 14/75 = .187 of its power (the sum of the squared weights, averaged over the time between two frames), and flattens a
// motion by a 25 T^2/24, its variance in time being 25 T^2/12. It is taken where both together are less than what a
// B-spline leaves.
constexpr double kMeanNoise = 14.0 / 75, kMeanFlattens = 25.0 / 24;

// White noise s of samples p apart leaves an error of kNoiseOverSlope s p/w^2 in the slope: the integral of the squared
// transfer function, times the frequency, of block means under a cubic B-spline that keeps curvature (ControlGrid),
// pitch h = w sqrt(12/5).
constexpr double kNoiseOverSlope = 0.578;
// Quantising a slope in steps of q adds a sawtooth whose first harmonic has a slope of sqrt(2) q/l for steps l wide.
// The transfer function T leaves of it at most q/(5.06 w), where T(f) f is largest, at l = 5.3 w. Few slopes are the
// worst one: the expected error is half of it. What a codec makes of the steps is the same kind of error and four times
// as much. Three paths over the smooth scenes of relievo-lab, the worst: H.264 at crf 18, 23, 28 1.41, 1.80, 2.84 % of
// the force with the width for the worst slope, 1.34, 1.80, 2.41 with that for twice as much; 8 bits without a codec
// .65 with the width for the worst slope, .46 with that for half.
constexpr double kStepsOverWorstSlope = 5.06, kExpectedOfWorst = 0.5, kCodedOfWorst = 2;
// Beside waves a codec leaves anything from nothing to more than on smooth scenes, and it is measured (tracesAmong). A
// sine of 14 mm at H.264 crf 18, 23, 28 has .55, .73, 1.4 times the worst slope's error with .03, .06, .13 mm of it.
constexpr double kTracesOfWorst = 1.3;
// Smoothing flattens what is narrower than itself, with the fourth power of the width: .05 % of the force at 1 mm on
// the sphere and the face of relievo-lab speed-accuracy (noise of 1 %, widths of 2.4 to 3.8 mm: .03 to .05 %).
constexpr double kFlattening = 5e-4;

// Where the surface is straight, nothing is flattened by a broader level: twice as wide, it leaves half of the steps;
// under noise, 2.5 times as wide, less than a quarter. Its control points then bend by no more than three things do
// together: a ball of 150 mm, half a step, and three standard deviations of the noise in one frame, by which Evenness
// judges them. Those of a ball of 45 mm, 6 mm apart, bend by .8 mm.
constexpr double kBroadOverWide = 2, kBroadUnderNoise = 2.5, kStraightRadiusMm = 150, kStepsBend = 0.5, kNoiseBends = 3;
// At creases a middle level rounds less. The wide one, with control points h apart, loses a slope of f = b/(kFlattens
// h) where the fourth difference of its blocks is b. Steps and noise leave it an error n, and the middle one m. The
// blend that leaves least in all gives the wide level the share m (m - n)/(f^2 + (m - n)^2), less than all of it from
// f = sqrt(n (m - n)) on. The middle level takes over from twice that on: in between both levels are read. Noise makes
// b greater by a part of its deviation.
constexpr double kMiddleOverWide = 0.6, kFlattens = 9, kCreases = 2, kFourthVariance = 70, kCreaseNoise = 0.5;
// Low waves bend no more than that. So there is no broad level where it would flatten swells by more than half of the
// error that the wide level leaves, nor where waves are found: its points may lie on their middle line.
constexpr double kFlattenedOfError = 0.5;

bool needsMean(const ClipMeasure& m) {
  const double nod = kNodMmPerS2 * m.period_s * m.period_s;
  return std::hypot(std::sqrt(kMeanNoise) * m.flicker_mm, kMeanFlattens * nod) <
         std::hypot(std::sqrt(kBSplineNoise) * m.flicker_mm, nod / 6);
}

// Carried forward by u periods, Linear weights its frames with (1 + u) s, (1 - s)(1 + u) - s u and -(1 - s) u; the sum
// of their squares, averaged over s, is 2/3 + u + u^2.
double noiseThrough(TimeLaw law, double carried_periods) {
  const double u = carried_periods;
  if (law == TimeLaw::Linear) return kLinearNoise + u + u * u;
  return law == TimeLaw::Mean ? kMeanNoise : law == TimeLaw::Fitted ? kFittedNoise : kBSplineNoise;
}

// A film that has only begun may move later, so it is planned as moving. (A picture costs nothing in time under any
// law: all weight lies on its one frame.) The smoother law averages more noise.
void chooseLaws(const ClipMeasure& m, const LookAhead& ahead, bool noisy, bool fine, FeltScale& s) {
  if (noisy) s.narrow_time = TimeLaw::Adapted;
  const bool slow_frames = kNodMmPerS2 * m.period_s * m.period_s / 6 > m.quantum_mm / 2;
  s.wide_time = noisy || (!fine && !slow_frames) ? TimeLaw::Adapted : TimeLaw::Fitted;
  if (needsMean(m)) s.narrow_time = s.wide_time = TimeLaw::Mean;
  s.narrow_time = lawWithin(s.narrow_time, ahead.frames);
  s.wide_time = lawWithin(s.wide_time, ahead.frames);
}

// In a fine picture only about `read` x `read` samples of a block are read, or a few whole rows of them, so that a
// finer picture is hardly less noisy. The distance of as many samples spread evenly:
double samplesApart(const ClipMeasure& m, double width_mm, int read) {
  const double block = width_mm / kSigmaPerPitch, across = block / m.sample_mm;
  if (across <= read) return m.sample_mm;
  const double down = m.whole_rows ? std::max<double>(SampledBlock::fewestRows(across), read * read / across) : read;
  return block / std::sqrt((m.whole_rows ? across : read) * down);
}

// What steps and noise leave in the slope under a width; `of_worst`: of the worst slope's error of steps.
struct SlopeErrors {
  double steps = 0, noise = 0, of_worst = 0;
  [[nodiscard]] double at(const ClipMeasure& m, double w, int read) const {
    return std::hypot(kNoiseOverSlope * noise * samplesApart(m, w, read) / (w * w),
                      of_worst * steps / (kStepsOverWorstSlope * w));
  }
};

void chooseMiddle(const SlopeErrors& errors, TouchPlan& plan) {
  const ClipMeasure& m = plan.measure;
  FeltScale& s = plan.scale;
  s.middle_mm = kMiddleOverWide * s.wide_mm;
  const double of_middle = errors.at(m, s.middle_mm, kWideSamples), of_wide = errors.at(m, s.wide_mm, kWideSamples);
  const double h = s.wide_mm / kSigmaPerPitch;
  s.wide_even_mm =
      kCreases * kFlattens * h * std::sqrt(of_wide * (of_middle - of_wide)) +
      kCreaseNoise * std::sqrt(kFourthVariance) * m.noise_mm * samplesApart(m, s.wide_mm, kWideSamples) / h;
}

void chooseBroad(bool noisy, TouchPlan& plan) {
  const ClipMeasure& m = plan.measure;
  FeltScale& s = plan.scale;
  const double broad = (noisy ? kBroadUnderNoise : kBroadOverWide) * s.wide_mm;
  if (swellsFlattenedBy(broad, m.swells_mm) > kFlattenedOfError * plan.error) return;
  const double pitch = broad / kSigmaPerPitch, samples = pitch / samplesApart(m, broad, kBroadSamples);
  s.broad_mm = broad;
  s.broad_even_mm = pitch * pitch / kStraightRadiusMm + kStepsBend * stepsUnderNoise(m) +
                    kNoiseBends * m.noise_mm * std::sqrt(kBendVariance) / samples;
}

std::string reasonFor(const TouchPlan& plan, const LookAhead& ahead) {
  const ClipMeasure& m = plan.measure;
  char depth[120], error[40] = "under 0.1 %";
  const int written = std::snprintf(depth, sizeof depth, "steps of %.3f mm, noise %.3f mm, %.0f mm/s%s", m.quantum_mm,
                                    m.noise_mm, m.speed_mm_per_s, m.still ? " (still)" : "");
  if (plan.scale.wide_time == TimeLaw::Mean) {
    std::snprintf(depth + written, sizeof depth - static_cast<std::size_t>(written), ", flicker of %.2f mm",
                  m.flicker_mm);
  }
  if (plan.error >= kLeastErrorTold) std::snprintf(error, sizeof error, "about %.1f %%", 100 * plan.error);
  std::string reason = std::string(depth) + ": " + describe(plan.scale);
  if (ahead.carried > Duration(0)) reason += print(", carried forward by %.0f ms", 1e3 * toSeconds(ahead.carried));
  return reason + "; expected force error " + error;
}

}  // namespace

TouchPlan planTouch(const ClipMeasure& m, const LookAhead& ahead) {
  const bool noisy = m.noise_mm > std::max(m.quantum_mm, kFineMm);
  const bool fine = !noisy && m.quantum_mm < kFineMm;
  TouchPlan plan;
  plan.measure = m;
  FeltScale& s = plan.scale;

  chooseLaws(m, ahead, noisy, fine, s);
  const double carried = m.period_s > 0 ? toSeconds(ahead.carried) / m.period_s : 0;

  // Repeated frames carry the same noise, so averaging them does not reduce it.
  const double through = std::sqrt(m.still ? 1.0 : noiseThrough(s.wide_time, carried));
  const auto apart = [&m](double w, int read) { return samplesApart(m, w, read); };
  // The error of the force's direction is the error of the slope.
  const double steps = stepsUnderNoise(m);
  const bool coded = isCoded(m);
  const Waves waves = coded ? Waves{} : m.waves_mm;  // of the relief
  const double of_traces = grow(waves, steps) ? kTracesOfWorst * tracesAmong(waves) : 0;
  const auto errorOf = [&](double w, double of_worst) {
    const double of_noise = kNoiseOverSlope * m.noise_mm * through * apart(w, kWideSamples) / (w * w);
    const double of_waves = fine ? 0 : flattenedBy(w, waves);
    return std::hypot(of_noise, std::hypot(of_worst * steps, of_traces) / (kStepsOverWorstSlope * w),
                      std::max(kFlattening * w * w * w * w, of_waves));
  };
  s.narrow_mm = fine ? kFineNarrowMm : kNarrowMm;
  s.wide_mm = kTimesTheNarrow * s.narrow_mm;
  double wider = s.wide_mm * kStepOfSearch;
  const double of_worst = coded ? kCodedOfWorst : kExpectedOfWorst;
  while (wider <= kWidestMm && errorOf(wider, of_worst) < errorOf(s.wide_mm, of_worst)) {
    s.wide_mm = wider;
    wider *= kStepOfSearch;
  }
  const auto steady = [&](double w, int read, double steps_share) {
    return std::hypot(kSteadyNoise * m.noise_mm * apart(w, read) * kSigmaPerPitch / w, steps_share * m.quantum_mm);
  };
  s.narrow_steady_mm = steady(s.narrow_mm, kNarrowSamples, kSteadySteps);
  s.wide_steady_mm = steady(s.wide_mm, kWideSamples, coded ? kSteadyCoded : kSteadySteps);
  plan.error = errorOf(s.wide_mm, kExpectedOfWorst);
  if (!fine && greatest(waves) <= steps) {
    chooseMiddle({steps, m.noise_mm * through, of_worst}, plan);
    chooseBroad(noisy, plan);
  }

  // The narrow level's error must fit under the clamp: five standard deviations of its noise plus one step. Within that
  // the wide level alone counts (FeltSurface).
  const double narrow_noise =
      m.noise_mm * apart(s.narrow_mm, kNarrowSamples) * through / (s.narrow_mm * std::sqrt(4 * std::numbers::pi));
  s.clamp_mm = std::max({0.15, 1.5 * std::min(m.quantum_mm, 0.2), 5 * narrow_noise});
  plan.reason = reasonFor(plan, ahead);
  return plan;
}

std::string describe(const FeltScale& s) {
  char text[160], broad[40] = "", middle[40] = "";
  if (s.middle_mm > s.narrow_mm) std::snprintf(middle, sizeof middle, ", %.2f at creases", s.middle_mm);
  if (s.broad_mm > 0) std::snprintf(broad, sizeof broad, ", %.2f where straight", s.broad_mm);
  const bool alike = s.narrow_time == s.wide_time;
  std::snprintf(text, sizeof text, "levels of %.2f and %.2f mm%s%s, %s%s%s in time", s.narrow_mm, s.wide_mm, middle,
                broad, alike ? "" : name(s.narrow_time), alike ? "" : " and ", name(s.wide_time));
  return text;
}

TouchPlan planFilm(std::span<const TimedSurface> first_frames, const LookAhead& ahead) {
  return planTouch(measureClip(first_frames.first(std::min(first_frames.size(), kPlanFrames))), ahead);
}

}  // namespace relievo
