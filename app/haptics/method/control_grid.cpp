// SPDX-License-Identifier: Apache-2.0
// The toroidal cache of block means, and their weighted sum over the frames.
#include "app/haptics/method/control_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/prefetch.h"

namespace relievo {
namespace {

// a point with less weight than this on frames with a reading is a hole
constexpr float kLeastWeight = 0.5F;

int blockFor(double pitch_mm, double samples_per_mm) RELIEVO_RT {
  return std::max(1, static_cast<int>(std::lround(pitch_mm * std::abs(samples_per_mm))));
}

using Int4 = std::int32_t __attribute__((vector_size(16)));

// One lane per slot: all bits of it where the slot has one.
std::array<Int4, 2> ofSlots(std::uint32_t slots) RELIEVO_RT {
  const Int4 all = Int4{} + static_cast<std::int32_t>(slots);
  return {(all & Int4{1, 2, 4, 8}) != 0, (all & Int4{16, 32, 64, 128}) != 0};
}

}  // namespace

void ControlGrid::setPicture(const HeightField& field) RELIEVO_RT {
  cols_ = field.cols();
  rows_ = field.rows();
  const GridMapping& grid = field.grid();
  block_ = field.blockOf(blockFor(pitch_wanted_mm_, grid.u_per_mm), blockFor(pitch_wanted_mm_, grid.v_per_mm),
                         most_samples_);
  // Block i covers samples i m .. i m + m - 1, so its centre is at u = (i + 1/2) m - 1/2.
  a_per_mm_ = grid.u_per_mm / block_.width;
  a_origin_ = (grid.u_origin + 0.5) / block_.width - 0.5;
  b_per_mm_ = grid.v_per_mm / block_.height;
  b_origin_ = (grid.v_origin + 0.5) / block_.height - 0.5;
  const double pitch2 = 1 / std::abs(a_per_mm_ * b_per_mm_);  // a parabola of radius R bends by pitch^2/R
  most_bend_mm_ = static_cast<float>(std::min(pitch2 / kSharpestMm, kMostBendMm));
  pit_mm_ = static_cast<float>(-field.depthMm());
  patch_ = ahead_ = {};
  slots_read_ = 0;
  filled_.fill(0);
  hole_.fill(0);
  complete_.fill(0);
}

void ControlGrid::forgetFrame(int slot) RELIEVO_RT {
  patch_ = ahead_ = {};
  slots_read_ &= ~(1U << slot);
  const auto keep = static_cast<std::uint8_t>(~(1U << slot));
  for (std::uint8_t& bits : filled_) bits &= keep;
  for (std::uint8_t& bits : hole_) bits &= keep;
  for (std::uint8_t& bits : complete_) bits &= keep;
}

void ControlGrid::fill(int i, int j, const Frames& frames) RELIEVO_RT {
  const std::uint32_t missing = slotsMissing(i, j, frames);
  if (missing == 0) return;
  const std::size_t p = slotOf(i, j);
  if (i_[p] != i || j_[p] != j) {
    i_[p] = i;
    j_[p] = j;
    filled_[p] = hole_[p] = complete_[p] = 0;
  }
  read(p, frames, missing);
}

// The slots of the frames in which a point has not been read yet.
std::uint32_t ControlGrid::slotsMissing(int i, int j, const Frames& frames) const RELIEVO_RT {
  const std::size_t p = slotOf(i, j);
  return i_[p] == i && j_[p] == j ? frames.wanted & ~std::uint32_t{filled_[p]} : frames.wanted;
}

bool ControlGrid::isComplete(int i, int j, const Frames& frames) const RELIEVO_RT {
  const std::size_t p = slotOf(i, j);
  return i_[p] == i && j_[p] == j && (frames.wanted & ~std::uint32_t{complete_[p]}) == 0;
}

// Prefetches, in each frame that lacks one of the points, the span of its missing points.
ControlGrid::Lacking ControlGrid::prefetchRow(int i0, int i1, int j, const Frames& frames) const RELIEVO_RT {
  std::uint32_t any = 0;
  Lacking lacking{.j = j, .begin = i1, .end = i0};
  for (int i = i0; i < i1; ++i) {
    const std::uint32_t slots = slotsMissing(i, j, frames);
    if (slots == 0) continue;
    any |= slots;
    lacking.begin = std::min(lacking.begin, i);
    lacking.end = i + 1;
  }
  if (any == 0) return lacking;
  const std::int64_t u = std::int64_t{lacking.begin} * block_.width, v = std::int64_t{j} * block_.height;
  const std::int64_t u_end = std::int64_t{lacking.end} * block_.width, v_end = v + block_.height;
  if (u < 0 || v < 0 || u_end > cols_ || v_end > rows_) return lacking;  // blocks cut by the picture's edge are rare
  for (; any != 0; any &= any - 1) {
    const auto slot = static_cast<std::size_t>(__builtin_ctz(any));
    frames.window->frames[frames.frame_of_slot[slot]].field.prefetch(static_cast<int>(u), static_cast<int>(v),
                                                                     lacking.end - lacking.begin, block_);
  }
  return lacking;
}

void ControlGrid::read(std::size_t p, const Frames& frames, std::uint32_t missing) RELIEVO_RT {
  // 64 bits, since a finger may be anywhere. Only the part of the block inside the picture is read.
  const std::int64_t u0 = std::int64_t{i_[p]} * block_.width, v0 = std::int64_t{j_[p]} * block_.height;
  const auto c0 = std::max<std::int64_t>(u0, 0), c1 = std::min<std::int64_t>(u0 + block_.width, cols_);
  const auto r0 = std::max<std::int64_t>(v0, 0), r1 = std::min<std::int64_t>(v0 + block_.height, rows_);
  const auto cols = static_cast<int>(c1 - c0), rows = static_cast<int>(r1 - r0);
  const bool outside =
      c0 >= c1 || r0 >= r1 || 2 * std::int64_t{cols} * rows < std::int64_t{block_.width} * block_.height;
  const bool cut = !outside && (cols < block_.width || rows < block_.height);
  SampledBlock part;
  if (cut) part = frames.window->frames[0].field.blockOf(cols, rows, most_samples_);
  const SampledBlock& block = cut ? part : block_;
  for (; missing != 0; missing &= missing - 1) {
    const auto slot = static_cast<std::size_t>(__builtin_ctz(missing));
    const auto bit = static_cast<std::uint8_t>(1U << slot);
    const HeightField& field = frames.window->frames[frames.frame_of_slot[slot]].field;
    const int c = static_cast<int>(c0), r = static_cast<int>(r0);
    double mean = outside ? HeightField::kHole : field.meanHeight(c, r, block);
    if (std::isnan(mean) && !outside) mean = bridged(field, c, r, block);
    ++blocks_read_;
    filled_[p] |= bit;
    if (std::isnan(mean)) hole_[p] |= bit;
    mean_[p][slot] = std::isnan(mean) ? 0 : static_cast<float>(mean);
  }
}

void ControlGrid::complete(const Points& points, const Frames& frames) RELIEVO_RT {
  // The smallest rectangle around what is not complete.
  Points box{points.i1, points.j1, points.i0, points.j0};
  for (int j = points.j0; j < points.j1; ++j) {
    for (int i = points.i0; i < points.i1; ++i) {
      if (isComplete(i, j, frames)) continue;
      box = {std::min(box.i0, i), std::min(box.j0, j), std::max(box.i1, i + 1), j + 1};
    }
  }
  if (box.i0 >= box.i1) return;
  const int rim = bend_ > 0 ? 1 : 0;
  std::array<Lacking, 6> rows;
  std::size_t count = 0;
  for (int j = box.j0 - rim; j < box.j1 + rim; ++j) {
    const int beside = j < box.j0 || j >= box.j1 ? 0 : rim;  // the rim has no corners
    rows[count++] = prefetchRow(box.i0 - beside, box.i1 + beside, j, frames);
  }
  for (std::size_t row = 0; row < count; ++row) {
    for (int i = rows[row].begin; i < rows[row].end; ++i) fill(i, rows[row].j, frames);
  }
  for (int j = box.j0; j < box.j1; ++j) {
    for (int i = box.i0; i < box.i1; ++i) {
      const std::uint32_t missing = frames.wanted & ~std::uint32_t{complete_[slotOf(i, j)]};
      if (missing != 0) keepCurvature(i, j, missing);
    }
  }
}

// A direction in which a neighbour is a hole is not corrected.
void ControlGrid::keepCurvature(int i, int j, std::uint32_t missing) RELIEVO_RT {
  const std::size_t p = slotOf(i, j);
  complete_[p] |= static_cast<std::uint8_t>(missing);
  if (bend_ == 0) {
    height_[p] = mean_[p];
    return;
  }
  const std::size_t left = slotOf(i - 1, j), right = slotOf(i + 1, j), above = slotOf(i, j - 1),
                    below = slotOf(i, j + 1);
  const auto across_hole = ofSlots(hole_[p] | hole_[left] | hole_[right]);
  const auto down_hole = ofSlots(hole_[p] | hole_[above] | hole_[below]);
  const auto wanted = ofSlots(missing);
  const Float4 twice = Float4{} + 2 * most_bend_mm_;
  for (std::size_t half = 0; half < 2; ++half) {  // of the slots
    const auto of = [half](Heights& heights, std::size_t point) RELIEVO_RT { return &heights[point][4 * half]; };
    const Float4 mean = load4(of(mean_, p));
    const auto bent = [&](std::size_t before, std::size_t after, const Int4& holes) RELIEVO_RT {
      constexpr Float4 kNone{};
      const Float4 bend = load4(of(mean_, before)) - 2 * mean + load4(of(mean_, after));
      const Float4 size = holes ? kNone + std::numeric_limits<float>::infinity() : bend > -bend ? bend : -bend;
      const Float4 rest = twice - size, least = size < rest ? size : rest, counts = least > kNone ? least : kNone;
      return bend < kNone ? -counts : counts;
    };
    const Float4 bends = bent(left, right, across_hole[half]) + bent(above, below, down_hole[half]);
    store4(of(height_, p), wanted[half] ? mean - bend_ * bends : load4(of(height_, p)));
  }
}

// A hole narrower than the blocks around it, such as a dead sample, is filled from the neighbouring blocks.
double ControlGrid::bridged(const HeightField& field, int c, int r, const SampledBlock& block) const RELIEVO_RT {
  const int left = std::max(c - block_.width, 0), right = std::min(c + block.width + block_.width, cols_);
  const int top = std::max(r - block_.height, 0), bottom = std::min(r + block.height + block_.height, rows_);
  return field.meanHeight(left, top, field.blockOf(right - left, bottom - top, 3 * most_samples_));
}

// A depth camera's holes come and go between frames: a point counts as a hole only if less than half its weight has
// readings.
float ControlGrid::withHoles(std::size_t p, const Frames& frames) const RELIEVO_RT {
  float sum = 0, readings = 0;
  for (std::size_t slot = 0; slot < kFrames; ++slot) {
    if ((hole_[p] >> slot & 1U) != 0) continue;
    sum += frames.weight[slot] * height_[p][slot];
    readings += frames.weight[slot];
  }
  return readings < kLeastWeight ? pit_mm_ : sum / readings;
}

void ControlGrid::readPatch(int i0, int j0, const Frames& frames) RELIEVO_RT {
  if (wasPatch(i0, j0, frames.wanted)) return;
  ahead_ = {};  // some of its points may be replaced
  complete({i0, j0, i0 + 4, j0 + 4}, frames);
  std::uint32_t holes = 0;
  for (int j = j0; j < j0 + 4; ++j) {
    for (int i = i0; i < i0 + 4; ++i) holes |= hole_[slotOf(i, j)] & frames.wanted;
  }
  patch_ = {i0, j0, frames.wanted};
  patch_holes_ = holes != 0;
  slots_read_ |= frames.wanted;
}

void ControlGrid::patch(int i0, int j0, const Frames& frames, Patch& out) RELIEVO_RT {
  readPatch(i0, j0, frames);
  weighted<1>(i0, j0, {&frames.weight}, {&out});
  if (!patch_holes_) return;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) out[static_cast<std::size_t>(j)][i] = withHoles(slotOf(i0 + i, j0 + j), frames);
  }
}

float ControlGrid::mean(int i, int j, const Frames& one) RELIEVO_RT {
  if (slotsMissing(i, j, one) != 0) {
    const std::size_t p = slotOf(i, j);
    if (i_[p] != i || j_[p] != j) patch_ = ahead_ = {};  // one of their points may be replaced
    fill(i, j, one);
  }
  const std::size_t p = slotOf(i, j);
  const auto slot = static_cast<std::size_t>(__builtin_ctz(one.wanted));
  return (hole_[p] & one.wanted) != 0 ? std::numeric_limits<float>::quiet_NaN() : mean_[p][slot];
}

bool ControlGrid::readAhead(int i0, int j0, const Frames& frames, int most) RELIEVO_RT {
  if (ahead_ == Place{i0, j0, frames.wanted}) return true;
  constexpr int kFarthest = kSide - 6;  // beyond, a point would take the place of one of the last patch or its rim
  if (patch_.slots != 0 && std::max(std::abs(i0 - patch_.i), std::abs(j0 - patch_.j)) > kFarthest) return false;
  ahead_ = {};
  const std::uint64_t until = blocks_read_ + static_cast<std::uint64_t>(most);
  const int rim = bend_ > 0 ? 1 : 0;
  for (int j = j0 - rim; j < j0 + 4 + rim; ++j) {
    const int beside = j < j0 || j >= j0 + 4 ? 0 : rim;  // the rim has no corners
    for (int i = i0 - beside; i < i0 + 4 + beside; ++i) {
      if (blocks_read_ >= until) return false;
      fill(i, j, frames);
    }
  }
  ahead_ = {i0, j0, frames.wanted};
  slots_read_ |= frames.wanted;
  return true;
}

void ControlGrid::prefetch() const RELIEVO_RT {
  relievo::prefetch(this, &i_);
}

void WeighedFrames::weigh(TimeLaw by, const FrameSlots& slots, const FrameMoment& at,
                          const FrameMoment& at_later) RELIEVO_RT {
  moment = at;
  law = by;
  frames.window = slots.window;
  frames.frame_of_slot = slots.frame;
  frames.weight.fill(0);
  frames.wanted = 0;
  added.fill(0);
  later.fill(0);
  const FrameTaps taps(at, by), then(at_later, by);
  const FrameTaps more = by == TimeLaw::Adapted ? FrameTaps::addedByFitted(at) : FrameTaps{};
  for (std::size_t i = 0; i < FrameTaps::kCount; ++i) {
    if (taps.weight[i] == 0 && then.weight[i] == 0 && more.weight[i] == 0) continue;
    const std::uint8_t slot = slots.of_frame[FrameTaps::frame(at, static_cast<int>(i))];
    frames.weight[slot] += taps.weight[i];
    later[slot] += then.weight[i];
    added[slot] += more.weight[i];
    frames.wanted |= 1U << slot;
  }
}

}  // namespace relievo
