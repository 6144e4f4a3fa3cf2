// SPDX-License-Identifier: Apache-2.0
// Cleans each picture by itself, then finishes it with its neighbours in time. One picture at a time, on all cores: so
// memory does not grow with the cores.
#include "app/enhance/enhancer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/enhance/depth_mesh.h"
#include "app/enhance/edge_keeping_fit.h"
#include "app/enhance/noise.h"
#include "app/enhance/shape_change.h"
#include "app/enhance/steady_mean.h"

namespace relievo {
namespace {

constexpr std::size_t kNeighbours = 2;  // pictures before and after it
constexpr float kAfterMedian = 0.3F;    // share of the noise that the median of 25 leaves
constexpr float kBound = static_cast<float>(DepthEnhancer::kBoundLevels) * DepthMap::kLevel;
constexpr float kSmoothing = 5;      // reach of the fit, for a mesh
constexpr int kReferenceCols = 720;  // reaches apply to a picture of this width

int scaled(float reach, int cols) {
  return static_cast<int>(std::lround(reach * static_cast<float>(cols) / kReferenceCols));
}

// `reach` applies to noise of one level, where noise and the rounding of curves cause about equal errors on the
// laboratory's surfaces. Averaging five pictures needs a smaller reach than one picture.
int reachFor(float reach, float noise, int cols) {
  return scaled(reach * std::cbrt(noise / DepthMap::kLevel), cols);
}

// The noise left after the median and a fit.
float noiseAfterFit(float noise, int reach) {
  return noise * std::min(kAfterMedian, 0.84F / static_cast<float>(2 * reach + 1));
}

}  // namespace

const char* name(Enhancement how) noexcept {
  switch (how) {
    case Enhancement::Median:
      return "median";
    case Enhancement::Dibm:
      return "dibm";
    case Enhancement::SpaceTime:
      return "space-time";
  }
  return "";
}

DepthEnhancer::DepthEnhancer(Enhancement how, const DepthCalibration& source)
    : how_(how),
      source_(source),
      outcome_(recoded(source, DepthMap::kBits)),
      code_step_(static_cast<float>(static_cast<double>(DepthMap::kHighest) / (source.highCode() - source.lowCode()))) {
}

Result<void> DepthEnhancer::add(const Frame& depth) {
  if (sums_.pictures + pictures_.size() > 0 && (depth.width != width_ || depth.height != height_)) {
    return fail(ErrorCode::Unsupported, "the picture size changes; split the film there");
  }
  width_ = depth.width;
  height_ = depth.height;
  Picture picture{.source = depth};
  if (!clean(picture)) return fail(ErrorCode::Unsupported, "cannot read depth from this kind of picture");
  pictures_.push_back(std::move(picture));
  enhanceUntil(pictures_.size() - std::min(neighbours(), pictures_.size()));
  return {};
}

void DepthEnhancer::finish() {
  enhanceUntil(pictures_.size());
}

std::optional<Frame> DepthEnhancer::next() {
  if (ready_.empty()) return std::nullopt;
  Frame frame = std::move(ready_.front());
  ready_.pop_front();
  return frame;
}

void DepthEnhancer::enhanceUntil(std::size_t end) {
  for (; done_ < end; ++done_) {
    enhance(done_);
    count(pictures_[done_]);
    ready_.push_back(std::move(pictures_[done_].outcome));
  }
  for (; done_ > neighbours(); --done_) pictures_.pop_front();
}

bool DepthEnhancer::clean(Picture& picture) {
  auto map = readDepth(picture.source, source_);
  if (!map) return false;
  picture.map = std::move(*map);
  picture.noise = noiseOf(picture.map);
  picture.counts = fillHoles(picture.map, picture.noise);
  picture.means = blockMeans(picture.map);
  filterByMedian(picture.map, picture.noise);
  picture.source.owner.reset();  // only its size and timestamps are needed from here on
  picture.source.planes = {};
  return true;
}

std::size_t DepthEnhancer::neighbours() const noexcept {
  return how_ == Enhancement::SpaceTime ? kNeighbours : 0;
}

// Only `space-time` needs a cleaned picture again.
void DepthEnhancer::enhance(std::size_t index) {
  Picture& picture = pictures_[index];
  DepthMap map = how_ == Enhancement::SpaceTime ? steadied(index) : std::move(picture.map);
  if (how_ == Enhancement::SpaceTime) fitLines(map, reachFor(3, grain(picture), map.cols));
  if (how_ == Enhancement::Dibm) model(picture, map);
  picture.noise_after = noiseOf(map);
  const float moved = std::max(shapeChange(picture.means, map), grain(picture) / kShapeBlock);
  picture.error = std::hypot(picture.noise_after, moved);
  picture.samples = map.size();
  picture.outcome = writeDepth(map, !outcome_.invalid.empty(), picture.source);
}

// In the memory of the oldest picture, which the next one does not need.
DepthMap DepthEnhancer::steadied(std::size_t index) {
  std::array<const DepthMap*, kNeighbours> before{};
  std::array<const DepthMap*, kNeighbours> after{};
  const std::size_t pairs = std::min({kNeighbours, index, pictures_.size() - 1 - index});
  for (std::size_t k = 0; k < pairs; ++k) {
    before[k] = &pictures_[index - 1 - k].map;
    after[k] = &pictures_[index + 1 + k].map;
  }
  const Picture& present = pictures_[index];
  const float alike = DepthMap::kLevel + 5 * kAfterMedian * present.noise;
  DepthMap own;
  DepthMap& mean = index >= kNeighbours ? pictures_[index - kNeighbours].map : own;
  mean.codes.resize(present.map.size());
  steadyMean(present.map, std::span(before).first(pairs), std::span(after).first(pairs), alike, mean.codes);
  mean.holes = present.map.holes;
  mean.cols = present.map.cols;
  mean.rows = present.map.rows;
  return std::move(mean);
}

// The larger of the noise and the rounding of the source's codes: quantisation steps of a slope are not feature points.
float DepthEnhancer::grain(const Picture& picture) const {
  constexpr float kOfRounding = 0.289F;  // 1/sqrt(12)
  return std::max(picture.noise, kOfRounding * code_step_);
}

void DepthEnhancer::model(Picture& picture, DepthMap& map) const {
  const int reach = reachFor(4, grain(picture), map.cols);
  fitLines(map, reach);
  picture.bound = kBound + std::max(0.5F * code_step_, 4 * noiseAfterFit(picture.noise, reach));
  const DepthMesh mesh = meshOf(map, picture.bound);
  picture.points = mesh.points.size();
  renderMesh(mesh, map);
  fitLines(map, scaled(kSmoothing, map.cols));
}

void DepthEnhancer::count(const Picture& picture) {
  ++sums_.pictures;
  sums_.samples += picture.samples;
  sums_.holes += picture.counts.holes;
  sums_.outliers += picture.counts.outliers;
  sums_.filled += picture.counts.filled;
  sums_.noise_before += static_cast<double>(picture.noise / DepthMap::kLevel);
  sums_.noise_after += static_cast<double>(picture.noise_after / DepthMap::kLevel);
  sums_.points += static_cast<double>(picture.points);
  sums_.most_points = std::max(sums_.most_points, picture.points);
  sums_.error_before += static_cast<double>(grain(picture) / DepthMap::kLevel);
  sums_.error_after += static_cast<double>(picture.error / DepthMap::kLevel);
  sums_.bound += static_cast<double>(picture.bound / DepthMap::kLevel);
}

EnhancementSummary DepthEnhancer::summary() const {
  EnhancementSummary mean = sums_;
  const double share = sums_.pictures > 0 ? 1.0 / static_cast<double>(sums_.pictures) : 0;
  mean.noise_before *= share;
  mean.noise_after *= share;
  mean.points *= share;
  mean.bound *= share;
  mean.error_before *= share;
  mean.error_after *= share;
  return mean;
}

}  // namespace relievo
