// SPDX-License-Identifier: Apache-2.0
// Starts from medians (after Theil and Sen), then uses Tukey's weights.
#include "app/estimate/relief_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace relievo {
namespace {

constexpr int kRounds = 12;
constexpr double kReach = 4.685 * 1.4826;  // Tukey's, in median distances
constexpr double kLeastReach = 1e-4;       // heights
constexpr double kSure = 0.02;             // of the scale: less sure ones are not taken

double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double medianOffset(const std::vector<FitSample>& samples, double scale) {
  std::vector<double> offsets;
  offsets.reserve(samples.size());
  for (const FitSample& s : samples) offsets.push_back(s.height - scale * s.estimate);
  return medianOf(offsets);
}

double medianRest(const std::vector<FitSample>& samples, const ReliefFit& fit) {
  std::vector<double> rests;
  rests.reserve(samples.size());
  for (const FitSample& s : samples) rests.push_back(std::abs(s.height - fit.at(s.estimate)));
  return medianOf(rests);
}

// Fits the slopes between each sample and the sample that is half of all samples further up. If the samples lie too
// flat, as many slopes fall as rise: then `scale` is used. Nullopt if most fall.
std::optional<ReliefFit> firstFit(std::vector<FitSample>& samples, double scale) {
  std::ranges::sort(samples, {}, &FitSample::height);
  const std::size_t half = samples.size() / 2;
  std::vector<double> steeps;  // estimates over heights
  for (std::size_t i = 0; i + half < samples.size(); ++i) {
    const FitSample &low = samples[i], &high = samples[i + half];
    if (high.height > low.height) steeps.push_back((high.estimate - low.estimate) / (high.height - low.height));
  }
  const auto up = static_cast<std::size_t>(std::ranges::count_if(steeps, [](double steep) { return steep > 0; }));
  if (8 * up < 3 * steeps.size()) return std::nullopt;
  if (8 * up > 5 * steeps.size()) scale = 1 / medianOf(steeps);
  return ReliefFit{scale, medianOffset(samples, scale)};
}

struct Sums {
  double weight = 0, estimate = 0, height = 0, of = 0;  // means
  double ee = 0, eh = 0, hh = 0;                        // of the distances from them
};

// The estimates converted to heights by `fit`, weighted by their distance from it.
Sums sumsOf(const std::vector<FitSample>& samples, const ReliefFit& fit, double reach) {
  std::vector<double> weights;
  weights.reserve(samples.size());
  Sums sums;
  for (const FitSample& s : samples) {
    const double away = (s.height - fit.at(s.estimate)) / reach;
    const double w = std::abs(away) >= 1 ? 0 : s.weight * (1 - away * away) * (1 - away * away);
    weights.push_back(w);
    sums.weight += w;
    sums.estimate += w * fit.at(s.estimate);
    sums.height += w * s.height;
    sums.of += w * s.of;
  }
  for (double* mean : {&sums.estimate, &sums.height, &sums.of}) *mean /= sums.weight;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double e = fit.at(samples[i].estimate) - sums.estimate, h = samples[i].height - sums.height;
    sums.ee += weights[i] * e * e / sums.weight;
    sums.eh += weights[i] * e * h / sums.weight;
    sums.hh += weights[i] * h * h / sums.weight;
  }
  return sums;
}

// How much larger the heights are than the estimates are by the present fit; noise: variance of an estimate over that
// of a height.
double demingScale(const Sums& s, double noise) {
  const double apart = s.ee - noise * s.hh;
  return 2 * s.eh / (apart + std::sqrt(apart * apart + 4 * noise * s.eh * s.eh));
}

}  // namespace

std::optional<ReliefFit> fitRelief(std::vector<FitSample> samples, const ReliefFit& before) {
  if (samples.size() < kLeastSamples) return std::nullopt;
  auto fit = firstFit(samples, before.scale);
  if (!fit) return std::nullopt;
  for (int round = 0; round < kRounds; ++round) {
    const double rest = medianRest(samples, *fit);
    const Sums sums = sumsOf(samples, *fit, std::max(kReach * rest, kLeastReach));
    if (!(sums.weight > 0)) return std::nullopt;
    fit->rest = 1.4826 * rest;
    if (fit->rest > kSure * std::sqrt(sums.hh * static_cast<double>(samples.size()))) {
      return ReliefFit{before.scale, medianOffset(samples, before.scale), fit->rest};
    }
    if (!(sums.eh > 0)) return std::nullopt;
    const double more = demingScale(sums, sums.of);
    fit->offset = more * fit->offset + sums.height - more * sums.estimate;
    fit->scale *= more;
  }
  return fit;
}

}  // namespace relievo
