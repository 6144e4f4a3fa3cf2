// SPDX-License-Identifier: Apache-2.0
// An opening of the unknown area by a disc, from the runs of unknown samples in each row.
#include "app/enhance/wide_areas.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "app/enhance/in_bands.h"

namespace relievo {
namespace {

// Half the width of each row of a disc of `radius`, without its middle; the first row is the topmost.
std::vector<int> discOf(int radius) {
  const cv::Mat disc = cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
  std::vector<int> half(static_cast<std::size_t>(disc.rows));
  for (int i = 0; i < disc.rows; ++i) half[static_cast<std::size_t>(i)] = (cv::countNonZero(disc.row(i)) - 1) / 2;
  return half;
}

// For each sample of a row of length `count`, how many marked ones it has on both sides at least, itself included.
void measureRuns(const std::uint8_t* marks, std::uint8_t* reach, int count) {
  constexpr int kMost = 255;
  for (int c = 0, run = 0; c < count; ++c) {
    run = marks[c] != 0 ? std::min(run + 1, kMost) : 0;
    reach[c] = static_cast<std::uint8_t>(run);
  }
  for (int c = count - 1, run = 0; c >= 0; --c) {
    run = marks[c] != 0 ? std::min(run + 1, kMost) : 0;
    reach[c] = static_cast<std::uint8_t>(std::min<int>(run, reach[c]));
  }
}

// For each sample of a row, `most` at a marked one, one less beside it, and so on down to 0.
void measureNearness(const std::uint8_t* marks, std::uint8_t* nearness, int count, int most) {
  for (int c = 0, near = 0; c < count; ++c) {
    near = marks[c] != 0 ? most : std::max(near - 1, 0);
    nearness[c] = static_cast<std::uint8_t>(near);
  }
  for (int c = count - 1, near = 0; c >= 0; --c) {
    near = std::max<int>(near - 1, nearness[c]);
    nearness[c] = static_cast<std::uint8_t>(near);
  }
}

// The rows in which `is` holds for some sample.
template <class Is>
std::vector<char> rowsWith(const std::vector<std::uint8_t>& samples, const DepthMap& map, Is&& is) {
  std::vector<char> rows(static_cast<std::size_t>(map.rows));
  for (int r = 0; r < map.rows; ++r) {
    const auto* const row = samples.data() + map.at(0, r);
    rows[static_cast<std::size_t>(r)] = std::any_of(row, row + map.cols, is) ? 1 : 0;
  }
  return rows;
}

}  // namespace

std::vector<std::uint8_t> findWide(const std::vector<std::uint8_t>& unknown, const DepthMap& map, int radius) {
  std::vector<std::uint8_t> measured(unknown.size()), wide(unknown.size());
  for (int r = 0; r < map.rows; ++r) measureRuns(&unknown[map.at(0, r)], &measured[map.at(0, r)], map.cols);
  const auto middles = rowsWith(measured, map, [radius](std::uint8_t reach) { return reach > radius; });
  if (std::ranges::find(middles, 1) == middles.end()) return wide;

  const std::vector<int> disc = discOf(radius);
  std::vector<std::uint8_t> centres(unknown.size());
  inBands(map.rows, [&](int first, int end) {
    for (int r = std::max(first, radius); r < std::min(end, map.rows - radius); ++r) {
      if (middles[static_cast<std::size_t>(r)] == 0) continue;
      std::uint8_t* const fits = &centres[map.at(0, r)];
      std::fill_n(fits, map.cols, std::uint8_t{1});
      for (int i = 0; i <= 2 * radius; ++i) {
        const std::uint8_t* const reach = &measured[map.at(0, r - radius + i)];
        const int half = disc[static_cast<std::size_t>(i)];
        for (int c = 0; c < map.cols; ++c) fits[c] &= static_cast<std::uint8_t>(reach[c] > half);
      }
    }
  });
  for (int r = 0; r < map.rows; ++r) {
    measureNearness(&centres[map.at(0, r)], &measured[map.at(0, r)], map.cols, radius + 1);
  }
  const auto of_centres = rowsWith(centres, map, [](std::uint8_t centre) { return centre != 0; });
  inBands(map.rows, [&](int first, int end) {
    for (int r = first; r < end; ++r) {
      std::uint8_t* const out = &wide[map.at(0, r)];
      for (int y = std::max(r - radius, 0); y <= std::min(r + radius, map.rows - 1); ++y) {
        if (of_centres[static_cast<std::size_t>(y)] == 0) continue;
        const std::uint8_t* const nearness = &measured[map.at(0, y)];
        const int row = y - r + radius, half = disc[static_cast<std::size_t>(row)];
        for (int c = 0; c < map.cols; ++c) out[c] |= static_cast<std::uint8_t>(nearness[c] > radius - half);
      }
    }
  });
  return wide;
}

}  // namespace relievo
