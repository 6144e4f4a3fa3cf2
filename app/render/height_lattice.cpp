// SPDX-License-Identifier: Apache-2.0
// Which samples the lattice stands on, and reading them.
#include "app/render/height_lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace relievo {
namespace {

constexpr float kSteepest = 4.0F;
constexpr float kLeastJumpMm = 1.0F;

// Vertices on `samples` samples in a line, in whole tiles of at most `most` cells or one tile.
std::vector<int> spread(int samples, int most, int tile) {
  const int cells = std::clamp(samples - 1, 1, std::max(1, most));
  const int whole = (cells + tile - 1) / tile * tile;
  std::vector<int> result;
  for (int i = 0; i <= whole; ++i) result.push_back((2 * i * (samples - 1) + whole) / (2 * whole));
  return result;
}

float leastStep(const std::vector<float>& places) {
  float least = 0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const float step = std::abs(places[i] - places[i - 1]);
    if (step > 0 && (least == 0 || step < least)) least = step;
  }
  return least;
}

}  // namespace

void HeightLattice::lay(const HeightField& field, int most_across) {
  picture_cols_ = field.cols();
  picture_rows_ = field.rows();
  most_across_ = most_across;
  grid_ = field.grid();
  const int across = std::clamp(picture_cols_ - 1, 1, most_across);
  const int down =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(picture_rows_) * across / picture_cols_)));
  tile_ = std::min(kLargestTile, static_cast<int>(std::bit_floor(static_cast<unsigned>(std::min(across, down)))));
  columns_ = spread(picture_cols_, across, tile_);
  rows_ = spread(picture_rows_, down, tile_);
  xs_.clear();
  us_.clear();
  for (const int c : columns_) {
    xs_.push_back(static_cast<float>(grid_.x(c)));
    us_.push_back((static_cast<float>(c) + 0.5F) / static_cast<float>(picture_cols_));
  }
  ys_.clear();
  vs_.clear();
  for (const int r : rows_) {
    ys_.push_back(static_cast<float>(grid_.y(r)));
    vs_.push_back((static_cast<float>(r) + 0.5F) / static_cast<float>(picture_rows_));
  }
  const float across_mm = leastStep(xs_), down_mm = leastStep(ys_);
  const float cell_mm = across_mm == 0 ? down_mm : down_mm == 0 ? across_mm : std::min(across_mm, down_mm);
  jump_mm_ = std::max(kSteepest * cell_mm, kLeastJumpMm);
  heights_.resize(columns_.size() * rows_.size());
}

void HeightLattice::read(const HeightField& field, int most_across) {
  const GridMapping& grid = field.grid();
  const bool same = field.cols() == picture_cols_ && field.rows() == picture_rows_ && most_across == most_across_ &&
                    grid.u_per_mm == grid_.u_per_mm && grid.v_per_mm == grid_.v_per_mm;
  if (!same) lay(field, most_across);
  const std::size_t width = columns_.size();
  bool has_holes = false;
  for (int j = 0; j < rows(); ++j) {
    float* line = heights_.data() + static_cast<std::size_t>(j) * width;
    if (j > 0 && rows_[static_cast<std::size_t>(j)] == rows_[static_cast<std::size_t>(j) - 1]) {
      std::copy_n(line - width, width, line);
    } else {
      has_holes = field.readRow(row(j), columns_, line) || has_holes;
    }
  }
  if (has_holes) fillHoles();
}

// Each level has half the columns and rows of the one below, and the farthest height that is known of four; then from
// the coarsest down, what is not known lies between the heights of the level above.
void HeightLattice::fillHoles() {
  const auto farther = [](float a, float b) { return std::isnan(a) || b < a ? b : a; };
  Level below{cols(), rows(), heights_.data()};
  std::size_t count = 0;
  while (below.cols > 1 || below.rows > 1) {
    Level above{(below.cols + 1) / 2, (below.rows + 1) / 2, nullptr};
    if (coarser_.size() <= count) coarser_.emplace_back();
    coarser_[count].resize(static_cast<std::size_t>(above.cols) * above.rows);
    above.heights = coarser_[count++].data();
    for (int j = 0; j < above.rows; ++j) {
      const float* upper = below.heights + static_cast<std::ptrdiff_t>(2 * j) * below.cols;
      const float* lower = 2 * j + 1 < below.rows ? upper + below.cols : upper;
      float* line = above.heights + static_cast<std::ptrdiff_t>(j) * above.cols;
      for (int i = 0; i < above.cols; ++i) {
        const int right = std::min(2 * i + 1, below.cols - 1);
        line[i] = farther(farther(upper[2 * i], upper[right]), farther(lower[2 * i], lower[right]));
      }
    }
    below = above;
  }
  if (std::isnan(*below.heights)) *below.heights = 0;  // nothing was measured
  while (count-- > 0) {
    Level fine{cols(), rows(), heights_.data()};
    for (std::size_t k = 0; k < count; ++k) fine = {(fine.cols + 1) / 2, (fine.rows + 1) / 2, coarser_[k].data()};
    fillFrom({(fine.cols + 1) / 2, (fine.rows + 1) / 2, coarser_[count].data()}, fine);
  }
}

// A sample of the finer level lies a quarter of a coarse cell from the middle of its own.
void HeightLattice::fillFrom(const Level& coarse, const Level& fine) {
  for (int j = 0; j < fine.rows; ++j) {
    const int own_j = j / 2, next_j = std::clamp(own_j + (j % 2 == 0 ? -1 : 1), 0, coarse.rows - 1);
    const float* own = coarse.heights + static_cast<std::ptrdiff_t>(own_j) * coarse.cols;
    const float* next = coarse.heights + static_cast<std::ptrdiff_t>(next_j) * coarse.cols;
    float* line = fine.heights + static_cast<std::ptrdiff_t>(j) * fine.cols;
    for (int i = 0; i < fine.cols; ++i) {
      if (!std::isnan(line[i])) continue;
      const int own_i = i / 2, next_i = std::clamp(own_i + (i % 2 == 0 ? -1 : 1), 0, coarse.cols - 1);
      line[i] = 0.5625F * own[own_i] + 0.1875F * (own[next_i] + next[own_i]) + 0.0625F * next[next_i];
    }
  }
}

}  // namespace relievo
