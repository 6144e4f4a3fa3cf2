// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/disparity_count.h"

#include <algorithm>
#include <iterator>

namespace relievo {
namespace {

constexpr int kBins = 4;  // of a pixel

// Levels among five pixels of the row: black with its noise has fewer.
bool isTextured(const ViewPicture& view, int c, int r) noexcept {
  constexpr int kBeside = 2, kLevels = 4;
  std::uint8_t least = 255, most = 0;
  for (int x = std::max(c - kBeside, 0); x <= std::min(c + kBeside, view.cols - 1); ++x) {
    const std::uint8_t luma = *view.pixel(x, r);
    least = std::min(least, luma);
    most = std::max(most, luma);
  }
  return most - least >= kLevels;
}

}  // namespace

DisparityCount::DisparityCount(int widest)
    : widest_(widest), counts_(static_cast<std::size_t>(2 * widest + 1) * kBins) {}

void DisparityCount::add(const DisparityMap& map, const ViewPicture& left) {
  pixels_ += map.size();
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      if (!isTextured(left, c, r)) continue;
      ++textured_;
      const std::size_t i = map.at(c, r);
      if (map.seen[i] == 0) continue;
      const auto place = static_cast<std::ptrdiff_t>((map.pixels[i] + static_cast<float>(widest_)) * kBins);
      ++counts_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(place, 0, std::ssize(counts_) - 1))];
      ++all_;
    }
  }
}

double DisparityCount::found() const noexcept {
  constexpr double kLeastTextured = 0.005;
  const auto textured = static_cast<double>(textured_);
  return textured_ > 0 && textured >= kLeastTextured * static_cast<double>(pixels_)
             ? static_cast<double>(all_) / textured
             : 0;
}

double DisparityCount::below(double share) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    sum += static_cast<double>(counts_[i]);
    if (sum >= share * static_cast<double>(all_)) return static_cast<double>(i) / kBins - widest_;
  }
  return widest_;
}

DisparityCount::Reach DisparityCount::reach(double outliers) const noexcept {
  return {below(outliers), below(1 - outliers) + 1.0 / kBins};
}

bool DisparityCount::isNone(double most) const noexcept {
  constexpr double kOutliers = 0.05;
  const Reach spread = reach(kOutliers);
  return spread.low >= -most && spread.high <= most;
}

}  // namespace relievo
