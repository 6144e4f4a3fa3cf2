// SPDX-License-Identifier: Apache-2.0
// A few samples of each block stand for it: the triangles of the picture itself tell exactly what is behind the words.
#include "app/render/relief/coarse_relief.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr int kSamples = 4;  // across a block and down

int firstOf(int block, int blocks, int samples) noexcept {
  return static_cast<int>(static_cast<long long>(block) * samples / blocks);
}

// The samples to read of the columns or rows from `first` to before `end`.
int sampleOf(int first, int end, int k) noexcept {
  return first + (2 * k + 1) * (end - first) / (2 * kSamples);
}

}  // namespace

CoarseRelief CoarseRelief::of(const HeightField& field) {
  constexpr float kNone = -1;
  CoarseRelief coarse;
  if (field.cols() < 1 || field.rows() < 1) return coarse;
  std::array<int, static_cast<std::size_t>(kAcross) * kSamples> columns;
  std::array<float, columns.size()> heights;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const int block = static_cast<int>(k) / kSamples;
    const int first = firstOf(block, kAcross, field.cols()), end = firstOf(block + 1, kAcross, field.cols());
    columns[k] = std::min(sampleOf(first, end, static_cast<int>(k) % kSamples), field.cols() - 1);
  }
  const GridMapping& grid = field.grid();
  for (int j = 0; j < kDown; ++j) {
    const int top = firstOf(j, kDown, field.rows()), under = firstOf(j + 1, kDown, field.rows());
    std::array<float, kAcross> nearest;
    nearest.fill(kNone);
    for (int k = 0; k < kSamples; ++k) {
      field.readRow(std::min(sampleOf(top, under, k), field.rows() - 1), columns, heights.data());
      for (std::size_t i = 0; i < heights.size(); ++i) {
        float& height = nearest[i / kSamples];
        if (heights[i] > height) height = heights[i];  // false for a hole
      }
    }
    for (int i = 0; i < kAcross; ++i) {
      if (nearest[static_cast<std::size_t>(i)] == kNone) continue;
      const double left = firstOf(i, kAcross, field.cols()) - 0.5;
      const double right = firstOf(i + 1, kAcross, field.cols()) - 0.5;
      coarse.blocks_.push_back({static_cast<float>(grid.x(left)), static_cast<float>(grid.y(under - 0.5)),
                                static_cast<float>(grid.x(right)), static_cast<float>(grid.y(top - 0.5)),
                                nearest[static_cast<std::size_t>(i)]});
    }
  }
  return coarse;
}

}  // namespace relievo
