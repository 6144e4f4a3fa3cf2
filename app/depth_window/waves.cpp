// SPDX-License-Identifier: Apache-2.0
// Lines of adjacent blocks, across and down.
#include "app/depth_window/waves.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/depth_window/felt_scale.h"
#include "platform/quantile.h"

namespace relievo {
namespace {

constexpr int kLines = 6;
constexpr double kFourthVariance = 70;      // 1 + 16 + 36 + 16 + 1
constexpr double kQuantileOfNormal = 0.84;  // of the magnitude, for kShareOfPlaces
constexpr double kTimesTheNoise = 2;        // that are no waves
constexpr double kEnds = 0.01;              // of the range, which a codec blurs
constexpr double kClips = 3;                // deviations of the means of frames: so near the ends noise is clipped

// The slope, in b/h, that a smoothing of blocks of the size h loses where b is the fourth difference of such blocks.
// Blocks under a cubic B-spline that keeps curvature (ControlGrid) pass sinc(kh/2)^5 (1 + 5/12 (1 - cos kh)) of a wave
// of the wavenumber k, 1 - 47/1152 (kh)^4 of a long one, and b is sinc(kh/2) (2 - 2 cos kh)^2 of it: .10, .084 and .071
// b/h are lost with 3, 3.5 and 4 blocks to a wave, which the wide level is chosen to have, and .22, .17 and .14 b/h
// with 2.1, 2.3 and 2.5, as waves may have on a broad level. Of smaller blocks the difference is smaller by the third
// power of their size or more.
constexpr double kSlopeOfWaves = 0.1, kSlopeOfSwells = 0.2;

// From the smallest blocks to the largest. At H.264 crf 23 and 28 waves of 6 to 14 mm in relievo-lab grow by 2.9 and
// more, what the codec makes of smooth scenes by 1.8 at most.
constexpr double kGrowth = 2.4;

// Of the fourth difference of blocks of 2.2 mm, what waves have in blocks of 1.55 mm: ((1 - cos 1.55 k)/(1 - cos 2.2
// k))^2 by the means of a sine over the blocks, sinc 1.55 k/2 / sinc 2.2 k/2: .25 for long waves, .36 for waves of 7.5
// mm.
constexpr double kInSmallest = 0.36;

// The means of the blocks of a line in one frame. NaN if a mean is not known: values at either end of the range are
// often painted.
using Line = std::vector<double>;

struct Differences {
  std::vector<double> mean, variance;  // over the frames, of each place: magnitude of the mean, and its variance

  void add(std::span<const Line> of_frame, double step_mm) {
    const auto frames = static_cast<double>(of_frame.size());
    for (std::size_t i = 2; i + 2 < of_frame.front().size(); ++i) {
      std::array<double, 3> bends{};
      double squares = 0;
      for (const Line& m : of_frame) {
        std::array<double, 3> here;
        for (std::size_t k = 0; k < 3; ++k) {
          here[k] = m[i + k - 2] - 2 * m[i + k - 1] + m[i + k];
          bends[k] += here[k] / frames;
        }
        const double fourth = here[0] - 2 * here[1] + here[2];
        squares += fourth * fourth / frames;
      }
      const double fourth = bends[0] - 2 * bends[1] + bends[2];
      if (std::isnan(fourth)) continue;
      const bool of_steps = std::ranges::all_of(bends, [&](double b) { return std::abs(b) <= step_mm; });
      mean.push_back(of_steps ? 0 : std::abs(fourth));
      if (frames > 1) variance.push_back((squares - fourth * fourth) / (frames - 1));
    }
  }
};

double wavesOf(std::span<const TimedSurface> frames, double block_mm, double step_mm, double noise_mm,
               double times_the_noise) {
  const HeightField& field = frames.front().field;
  const auto samples = [block_mm](double per_mm) {
    return std::max(1, static_cast<int>(std::lround(block_mm * std::abs(per_mm))));
  };
  const int cols = samples(field.grid().u_per_mm), rows = samples(field.grid().v_per_mm);
  if (cols > field.cols() || rows > field.rows()) return 0;
  const SampledBlock block = field.blockOf(cols, rows, kBroadSamples);
  std::vector<Line> line(frames.size());
  const double ends = kEnds + kClips * noise_mm / field.depthMm();
  const auto read = [&](std::size_t f, int c, int r) {
    const double mean = frames[f].field.meanHeight(c, r, block);
    const double share = mean / field.depthMm();
    line[f].push_back(share > ends && share < 1 - ends ? mean : HeightField::kHole);
  };
  const auto lineOf = [&](Differences& found, auto&& read_frame) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
      line[f].clear();
      read_frame(f);
    }
    found.add(line, step_mm);
  };
  Differences across, down;
  for (int k = 0; k < kLines; ++k) {
    const int c0 = (2 * k + 1) * (field.cols() - cols) / (2 * kLines);
    const int r0 = (2 * k + 1) * (field.rows() - rows) / (2 * kLines);
    lineOf(across, [&](std::size_t f) {
      for (int c = 0; c + cols <= field.cols(); c += cols) read(f, c, r0);
    });
    lineOf(down, [&](std::size_t f) {
      for (int r = 0; r + rows <= field.rows(); r += rows) read(f, c0, r);
    });
  }
  const double least_variance = kFourthVariance * noise_mm * noise_mm / (block.across.count * block.down.count);
  double most2 = 0;
  for (Differences* found : {&across, &down}) {
    const double waves = quantile(found->mean, kShareOfPlaces);
    const double variance = std::max(quantile(found->variance, kShareOfPlaces), least_variance);
    const double noise = times_the_noise * kQuantileOfNormal * std::sqrt(variance);
    most2 = std::max(most2, waves * waves - noise * noise - step_mm * step_mm);
  }
  return std::sqrt(most2);
}

// `stepOf`: what counts as a step for blocks of a size.
template <std::size_t kSizes, class StepOf>
std::array<double, kSizes> ofSizes(const std::array<double, kSizes>& blocks_mm, std::span<const TimedSurface> frames,
                                   StepOf&& stepOf, double noise_mm, bool still, double times_the_noise) {
  std::array<double, kSizes> waves{};
  if (frames.empty()) return waves;
  const double of_mean = noise_mm / std::sqrt(still ? 1.0 : static_cast<double>(frames.size()));
  for (std::size_t k = 0; k < kSizes; ++k) {
    waves[k] = wavesOf(frames, blocks_mm[k], stepOf(blocks_mm[k]), of_mean, times_the_noise);
  }
  return waves;
}

// b/h for the blocks of a width.
double flattened(double width_mm, std::span<const double> blocks_mm, std::span<const double> waves_mm) {
  const double block = width_mm / kSigmaPerPitch;
  double most = 0;
  for (std::size_t k = 0; k < blocks_mm.size(); ++k) {
    const double share = std::min(block / blocks_mm[k], 1.0);
    most = std::max(most, share * share * share * waves_mm[k]);
  }
  return most / block;
}

}  // namespace

Waves wavesOf(std::span<const TimedSurface> frames, double step_mm, double noise_mm, bool still) {
  return ofSizes(kWaveBlocksMm, frames, [=](double) { return step_mm; }, noise_mm, still, kTimesTheNoise);
}

Swells swellsOf(std::span<const TimedSurface> frames, double step_mm, double terrace_mm, double noise_mm, bool still) {
  const auto step = [=](double block_mm) { return terrace_mm > block_mm ? step_mm : 0; };
  return ofSizes(kSwellBlocksMm, frames, step, noise_mm, still, 1);
}

bool grow(const Waves& waves, double step_mm) {
  return waves.back() > kGrowth * std::max(waves.front(), step_mm);
}

double tracesAmong(const Waves& waves) {
  const double of_waves = kInSmallest * waves[1];
  return std::sqrt(std::max(waves[0] * waves[0] - of_waves * of_waves, 0.0));
}

double flattenedBy(double width_mm, const Waves& waves) {
  return kSlopeOfWaves * flattened(width_mm, std::span(kWaveBlocksMm).subspan(1), std::span(waves).subspan(1));
}

double swellsFlattenedBy(double width_mm, const Swells& swells) {
  return kSlopeOfSwells * flattened(width_mm, kSwellBlocksMm, swells);
}

}  // namespace relievo
