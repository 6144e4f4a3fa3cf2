// SPDX-License-Identifier: Apache-2.0
// Robust measurements on a lattice of places.
#include "app/depth_window/clip_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "app/depth_window/flicker.h"
#include "app/depth_window/lattice.h"
#include "app/depth_window/ripples.h"
#include "platform/quantile.h"

namespace relievo {
namespace {

constexpr int kWideBlock = 64;  // wide enough to tell whether its rows are read whole

// For normally distributed noise the median of the magnitude is 0.6745 standard deviations.
constexpr double kMedianOfNormal = 0.6745;
// The noise that this factor and kBendVariance compute from a second difference of one step: 1/(0.6745 sqrt(6)) =
// 0.605 of the step, rounded up so that no quantisation counts as noise.
constexpr double kStepAsNoise = 0.61;
// A still sample moves by less than this multiple of its noise between frames at 19 of 20 places: 1.96 sqrt(2) = 2.77.
constexpr double kNoiseAsMotion = 2.8;

// In the smooth scenes of relievo-lab, rounded to 8 bits, no step is a ripple; after H.264 at crf 18 to 28 .0024 and
// more are, but for a plane so shallow that it has hardly any steps. Waves of one or two steps have narrow tops, which
// are ripples too: .022 and more. A codec that leaves as many leaves little else.
constexpr double kRipplesOfCodec = 0.001, kRipplesOfWaves = 0.02;

// What the samples of a row tell, in mm that a step of code has on average: under the inverse law a step is higher far
// away (HeightField::stretchAt), and the number of codes between two samples tells steps and noise.
struct Across {
  std::vector<double> bends;
  std::size_t edges = 0;
  double quantum = std::numeric_limits<double>::infinity();
  double stretch2 = 0;  // sum of the squares
};

// A smooth surface is straight across neighbouring samples of a row, so the second difference is noise with 6 times its
// variance; the median ignores edges.
void lookAcross(const HeightField& field, Across& found) {
  Lattice::forPlaces(field, [&](int c, int r) {
    const double left = field.heightMm(c - 1, r), here = field.heightMm(c, r), right = field.heightMm(c + 1, r);
    // Values at either end of the range are often painted and free of noise.
    if (std::isnan(left + here + right) || std::min({left, here, right}) <= 0 ||
        std::max({left, here, right}) >= field.depthMm()) {
      return;
    }
    // From one height to another, steps are as high as halfway between them, in the geometric mean.
    const auto stretch = [&](double a, double b) { return std::sqrt(field.stretchAt(a) * field.stretchAt(b)); };
    const double before = (here - left) / stretch(left, here), after = (right - here) / stretch(here, right);
    const double bend = std::abs(after - before);
    found.bends.push_back(bend);
    found.stretch2 += field.stretchAt(here) * field.stretchAt(here);
    // On a steep slope every step exceeds one quantum, but the differences between steps do not.
    for (const double d : {std::abs(after), bend}) {
      if (d > kRoundingMm && d < kEdgeMm) found.quantum = std::min(found.quantum, d);
    }
    if (std::max(std::abs(right - here), std::abs(here - left)) > kEdgeMm) ++found.edges;
  });
}

// How far apart the steps are, on average: q/g on a slope g. Infinite where there are none.
double terraceMm(const HeightField& field) {
  std::size_t across = 0, down = 0, places = 0;
  Lattice::forPlaces(field, [&](int c, int r) {
    const double here = field.heightMm(c, r), below = field.heightMm(c, std::min(r + 1, field.rows() - 1));
    const double right = field.heightMm(c + 1, r);
    if (std::isnan(here + below + right)) return;
    ++places;
    across += std::abs(right - here) > kRoundingMm ? 1 : 0;
    down += std::abs(below - here) > kRoundingMm ? 1 : 0;
  });
  const double steps_per_mm = std::hypot(static_cast<double>(across) * field.grid().u_per_mm,
                                         static_cast<double>(down) * field.grid().v_per_mm);
  return static_cast<double>(places) / steps_per_mm;
}

void lookAhead(const TimedSurface& from, const TimedSurface& to, std::vector<double>& speeds, bool& still) {
  const double period = toSeconds(to.time - from.time);
  Lattice::forPlaces(from.field, [&](int c, int r) {
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
  Across across;
  std::vector<double> speeds;
  m.still = true;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    lookAcross(frames[i].field, across);
    if (i > 0 && frames[i].shot == frames[i - 1].shot) lookAhead(frames[i - 1], frames[i], speeds, m.still);
  }
  if (frames.size() > 1) {
    m.period_s = toSeconds(frames.back().time - frames.front().time) / static_cast<double>(frames.size() - 1);
  }
  const GridMapping& grid = frames.front().field.grid();
  m.sample_mm = 1 / std::sqrt(std::abs(grid.u_per_mm * grid.v_per_mm));
  m.quantum_mm = frames.front().field.stepMm();
  m.whole_rows = frames.front().field.blockOf(kWideBlock, kWideBlock, 1).across.count == kWideBlock;
  if (across.bends.empty()) return m;  // every value is at an end of the range, so later values are unknown
  const auto places = static_cast<double>(across.bends.size());
  m.edges = static_cast<double>(across.edges) / places;
  m.flicker_mm = flickerMm(frames);
  m.ripples = ripplesOf(frames);
  // A quantised slope bends by one step at every other sample: subtract what the quantum explains.
  const double deviation = quantile(across.bends, 0.5) / (kMedianOfNormal * std::sqrt(kBendVariance));
  const bool shows_steps = std::isfinite(across.quantum) && !frames.front().field.mixesCodes();
  const double quantum = shows_steps ? across.quantum : m.quantum_mm;
  const double of_quantum = kStepAsNoise * quantum;
  const double noise = std::sqrt(std::max(deviation * deviation - of_quantum * of_quantum, 0.0));
  const double stretch = std::sqrt(across.stretch2 / places);
  m.quantum_mm = stretch * quantum;
  m.noise_mm = stretch * noise;
  m.waves_mm = wavesOf(frames, stepsUnderNoise(m), m.noise_mm, m.still);
  m.swells_mm = swellsOf(frames, stepsUnderNoise(m), terraceMm(frames.front().field), m.noise_mm, m.still);
  m.speed_mm_per_s =
      std::max(quantile(speeds, 0.95) - (m.noise_mm * kNoiseAsMotion + m.quantum_mm) / std::max(m.period_s, 1e-3), 0.0);
  return m;
}

bool isCoded(const ClipMeasure& m) {
  const double steps = stepsUnderNoise(m);
  const bool of_waves = grow(m.waves_mm, steps) || (m.ripples > kRipplesOfWaves && greatest(m.waves_mm) > steps);
  return m.ripples > kRipplesOfCodec && !of_waves;
}

// What noise of a standard deviation s leaves of the steps q, as dither does: the first harmonic of the sawtooth is
// multiplied by the noise's characteristic function, exp(-2 pi^2 s^2/q^2) (Widrow and Kollar, Quantization Noise).
double stepsUnderNoise(const ClipMeasure& m) {
  if (m.quantum_mm <= 0) return 0;
  const double turn = 2 * std::numbers::pi * m.noise_mm / m.quantum_mm;
  return m.quantum_mm * std::exp(-turn * turn / 2);
}

}  // namespace relievo
