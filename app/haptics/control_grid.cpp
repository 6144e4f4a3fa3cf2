// SPDX-License-Identifier: Apache-2.0
// The toroidal cache of block means, and their sum over the frames.
#include "app/haptics/control_grid.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

// Less than this share of the weight on frames that have a reading is a hole.
constexpr float kLeastWeight = 0.5F;

int blockFor(double pitch_mm, double samples_per_mm) RELIEVO_RT {
  return std::max(1, static_cast<int>(std::lround(pitch_mm * std::abs(samples_per_mm))));
}

Float4 load(const float* p) RELIEVO_RT {
  return Float4{p[0], p[1], p[2], p[3]};
}

}  // namespace

void ControlGrid::setPicture(const HeightField& field) RELIEVO_RT {
  cols_ = field.cols();
  rows_ = field.rows();
  const GridMapping& grid = field.grid();
  block_cols_ = blockFor(pitch_wanted_mm_, grid.u_per_mm);
  block_rows_ = blockFor(pitch_wanted_mm_, grid.v_per_mm);
  // Block i covers samples i m .. i m + m - 1, so its centre is at u = (i + 1/2) m - 1/2.
  a_per_mm_ = grid.u_per_mm / block_cols_;
  a_origin_ = (grid.u_origin + 0.5) / block_cols_ - 0.5;
  b_per_mm_ = grid.v_per_mm / block_rows_;
  b_origin_ = (grid.v_origin + 0.5) / block_rows_ - 0.5;
  pit_mm_ = static_cast<float>(-field.depthMm());
  forget();
}

void ControlGrid::forget() RELIEVO_RT {
  for (Point& p : points_) p.filled = p.hole = 0;
}

void ControlGrid::forgetFrame(int slot) RELIEVO_RT {
  const auto keep = static_cast<std::uint16_t>(~(1U << slot));
  for (Point& p : points_) {
    p.filled &= keep;
    p.hole &= keep;
  }
}

ControlGrid::Point& ControlGrid::at(int i, int j, const Frames& frames) RELIEVO_RT {
  Point& p = points_[static_cast<std::size_t>((j & (kSide - 1)) * kSide + (i & (kSide - 1)))];
  if (p.i != i || p.j != j) {
    p.i = i;
    p.j = j;
    p.filled = p.hole = 0;
  }
  const std::uint32_t missing = frames.wanted & ~std::uint32_t{p.filled};
  if (missing != 0) read(p, frames, missing);
  return p;
}

bool ControlGrid::fill(int i, int j, const Frames& frames, std::uint32_t wanted) RELIEVO_RT {
  Point& p = points_[static_cast<std::size_t>((j & (kSide - 1)) * kSide + (i & (kSide - 1)))];
  const bool other = p.i != i || p.j != j;
  if (!other && (wanted & ~std::uint32_t{p.filled}) == 0) return false;
  if (other) {
    p.i = i;
    p.j = j;
    p.filled = p.hole = 0;
  }
  read(p, frames, wanted & ~std::uint32_t{p.filled});
  return true;
}

void ControlGrid::read(Point& p, const Frames& frames, std::uint32_t missing) RELIEVO_RT {
  // 64 bits: a finger may be anywhere. The part of the block inside the picture is read.
  const std::int64_t u0 = std::int64_t{p.i} * block_cols_, v0 = std::int64_t{p.j} * block_rows_;
  const auto c0 = std::max<std::int64_t>(u0, 0), c1 = std::min<std::int64_t>(u0 + block_cols_, cols_);
  const auto r0 = std::max<std::int64_t>(v0, 0), r1 = std::min<std::int64_t>(v0 + block_rows_, rows_);
  const bool outside = c0 >= c1 || r0 >= r1 || 2 * (c1 - c0) * (r1 - r0) < std::int64_t{block_cols_} * block_rows_;
  for (; missing != 0; missing &= missing - 1) {
    const auto slot = static_cast<std::size_t>(__builtin_ctz(missing));
    const auto bit = static_cast<std::uint16_t>(1U << slot);
    p.filled |= bit;
    p.height[slot] = 0;
    double mean = HeightField::kHole;
    if (!outside) {
      const auto frame = static_cast<std::size_t>(frames.frame_of_slot[slot]);
      mean = frames.window->frames[frame].field.meanHeight(static_cast<int>(c0), static_cast<int>(r0),
                                                           static_cast<int>(c1 - c0), static_cast<int>(r1 - r0),
                                                           most_samples_);
    }
    if (std::isnan(mean)) p.hole |= bit;
    else p.height[slot] = static_cast<float>(mean);
  }
}

// Holes come and go from frame to frame with a depth camera: as long as most of the weight lies on readings, they tell.
float ControlGrid::withHoles(const Point& p, const Frames& frames) const RELIEVO_RT {
  float sum = 0, readings = 0;
  for (std::size_t slot = 0; slot < kFrames; ++slot) {
    if ((p.hole >> slot & 1U) != 0) continue;
    sum += frames.weight[slot] * p.height[slot];
    readings += frames.weight[slot];
  }
  return readings < kLeastWeight ? pit_mm_ : sum / readings;
}

void ControlGrid::patch(int i0, int j0, const Frames& frames, Patch& out) RELIEVO_RT {
  const Float4 low = load(frames.weight.data()), high = load(frames.weight.data() + 4);
  for (int j = 0; j < 4; ++j) {
    std::array<Float4, 4> part;
    std::uint32_t holes = 0;
    for (int i = 0; i < 4; ++i) {
      const Point& p = at(i0 + i, j0 + j, frames);
      holes |= p.hole & frames.wanted;
      part[static_cast<std::size_t>(i)] = load(p.height.data()) * low + load(p.height.data() + 4) * high;
    }
    Float4 sum{};
    for (std::size_t lane = 0; lane < 4; ++lane) {
      sum += Float4{part[0][lane], part[1][lane], part[2][lane], part[3][lane]};
    }
    if (holes != 0) {
      for (int i = 0; i < 4; ++i) sum[i] = withHoles(at(i0 + i, j0 + j, frames), frames);
    }
    out[static_cast<std::size_t>(j)] = sum;
  }
}

}  // namespace relievo
