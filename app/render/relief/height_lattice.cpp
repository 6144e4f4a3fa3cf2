// SPDX-License-Identifier: Apache-2.0
// Chooses the samples of the lattice and reads them.
#include "app/render/relief/height_lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

namespace relievo {
namespace {

constexpr float kSteepest = 4.0F;
constexpr float kLeastJumpMm = 1.0F;
constexpr int kRun = 16;  // vertices

constexpr std::size_t runsOf(std::size_t vertices) noexcept {
  return (vertices + kRun - 1) / kRun;
}

// Distributes vertices over `samples` samples of a line: whole tiles of together at most `most` cells, at least one
// tile.
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
  most_across_ = most_across;
  const int picture_cols = field.cols(), picture_rows = field.rows();
  const GridMapping& grid = field.grid();
  const int across = std::clamp(picture_cols - 1, 1, most_across);
  const int down =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(picture_rows) * across / picture_cols)));
  tile_ = std::min(kLargestTile, static_cast<int>(std::bit_floor(static_cast<unsigned>(std::min(across, down)))));
  columns_ = spread(picture_cols, across, tile_);
  rows_ = spread(picture_rows, down, tile_);
  xs_.clear();
  us_.clear();
  for (const int c : columns_) {
    xs_.push_back(static_cast<float>(grid.x(c)));
    us_.push_back((static_cast<float>(c) + 0.5F) / static_cast<float>(picture_cols));
  }
  ys_.clear();
  vs_.clear();
  for (const int r : rows_) {
    ys_.push_back(static_cast<float>(grid.y(r)));
    vs_.push_back((static_cast<float>(r) + 0.5F) / static_cast<float>(picture_rows));
  }
  const float across_mm = leastStep(xs_), down_mm = leastStep(ys_);
  const float cell_mm = across_mm == 0 ? down_mm : down_mm == 0 ? across_mm : std::min(across_mm, down_mm);
  jump_mm_ = std::max(kSteepest * cell_mm, kLeastJumpMm);
  heights_.resize(columns_.size() * rows_.size());
  read_.resize(heights_.size());
  seen_.resize(field.rowBytes(0).size() * rows_.size());
  holes_.resize(runsOf(columns_.size()) * rows_.size());
}

bool HeightLattice::read(const HeightField& field, int most_across) {
  const bool follows = !field.readsBeside() && field.readsLike(last_) && most_across == most_across_;
  if (!follows) lay(field, most_across);
  last_ = field;
  const std::size_t width = columns_.size();
  filled_.assign(width, 0);
  bool has_holes = false;  // in the row above
  bool changed = !follows;
  for (int j = 0; j < rows(); ++j) {
    float* line = heights_.data() + static_cast<std::size_t>(j) * width;
    if (j > 0 && rows_[static_cast<std::size_t>(j)] == rows_[static_cast<std::size_t>(j) - 1]) {
      std::copy_n(line - width, width, line);
      continue;
    }
    const RowRead row_read = readChanged(field, j, follows);
    changed = changed || row_read.changed;
    std::copy_n(read_.data() + static_cast<std::size_t>(j) * width, width, line);
    if (row_read.has_holes) {
      fillHoles(j);
      has_holes = true;
    } else if (has_holes) {
      std::fill(filled_.begin(), filled_.end(), std::uint8_t{0});
      has_holes = false;
    }
  }
  return changed;
}

// Reads a row into `read_`, only the runs that have changed.
HeightLattice::RowRead HeightLattice::readChanged(const HeightField& field, int j, bool follows) {
  const std::span<const std::uint8_t> bytes = field.rowBytes(row(j));
  std::uint8_t* const seen = seen_.data() + static_cast<std::size_t>(j) * bytes.size();
  const auto step = static_cast<std::size_t>(field.stepBytes());
  const std::size_t width = columns_.size(), runs = runsOf(width);
  Holes* const holes = holes_.data() + static_cast<std::size_t>(j) * runs;
  bool changed = false, any = false;
  for (std::size_t run = 0; run < runs; ++run) {
    const std::size_t begin = run * kRun, end = std::min(begin + kRun, width);
    const std::size_t from = static_cast<std::size_t>(columns_[begin]) * step;
    const std::size_t to = std::min((static_cast<std::size_t>(columns_[end - 1]) + 1) * step, bytes.size());
    if (!follows || std::memcmp(bytes.data() + from, seen + from, to - from) != 0) {
      float* const heights = read_.data() + static_cast<std::size_t>(j) * width + begin;
      const bool some = field.readRow(row(j), std::span(columns_).subspan(begin, end - begin), heights);
      const auto is_hole = [](float z) { return std::isnan(z); };
      holes[run] = !some                                                    ? Holes::None
                   : std::all_of(heights, heights + (end - begin), is_hole) ? Holes::All
                                                                            : Holes::Some;
      changed = true;
    }
    any = any || holes[run] != Holes::None;
  }
  if (changed) std::copy(bytes.begin(), bytes.end(), seen);
  return {changed, any};
}

// Between rows a filled value changes by less than a jump, whatever its neighbours do, so that no false edge appears.
void HeightLattice::fillHoles(int j) {
  const auto width = static_cast<std::ptrdiff_t>(columns_.size());
  float* line = heights_.data() + j * width;
  const float* above = j > 0 ? line - width : line;
  const float most = 0.5F * jump_mm_;
  std::uint8_t* const filled = filled_.data();
  const auto count = static_cast<int>(width);
  const Holes* const holes = holes_.data() + static_cast<std::size_t>(j) * runsOf(columns_.size());
  int i = 0;
  while (i < count) {
    if (i % kRun == 0 && holes[i / kRun] == Holes::None) {
      const int end = std::min(i + kRun, count);
      std::fill(filled + i, filled + end, std::uint8_t{0});
      i = end;
      continue;
    }
    if (!std::isnan(line[i])) {
      filled[i++] = 0;
      continue;
    }
    const int begin = i;
    while (i < count && std::isnan(line[i])) {
      i = i % kRun == 0 && holes[i / kRun] == Holes::All ? std::min(i + kRun, count) : i + 1;
    }
    const float before = begin > 0 ? line[begin - 1] : HUGE_VALF;
    const float behind = i < count ? line[i] : HUGE_VALF;
    float fill = std::min(before, behind);
    if (fill == HUGE_VALF) fill = 0;  // no reading in this row
    for (int k = begin; k < i; ++k) {
      const float followed = std::clamp(fill, above[k] - most, above[k] + most);
      line[k] = filled[k] != 0 ? followed : fill;
      filled[k] = 1;
    }
    int jumps = 0;
    for (int k = begin + 1; k < i; ++k) jumps += std::abs(line[k] - line[k - 1]) > most ? 1 : 0;
    if (jumps == 0) continue;
    for (int k = begin + 1; k < i; ++k) line[k] = std::clamp(line[k], line[k - 1] - most, line[k - 1] + most);
  }
}

}  // namespace relievo
