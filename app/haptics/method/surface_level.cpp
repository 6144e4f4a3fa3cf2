// SPDX-License-Identifier: Apache-2.0
// Tensor-product B-splines on 4 x 4 control points.
#include "app/haptics/method/surface_level.h"

#include <algorithm>
#include <cmath>

#include "platform/prefetch.h"

namespace relievo {
namespace {

// Basis functions of four control points with their first and second derivatives, in units of the pitch: one polynomial
// in the position within the cell for each control point.
Float4 basis(const std::array<Float4, 4>& c, float t) RELIEVO_RT {
  return ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
}
struct Basis {
  Float4 value, slope, bend;
  Basis(const std::array<Float4, 4>& c, float t) RELIEVO_RT : value(basis(c, t)),
                                                              slope((3 * c[3] * t + 2 * c[2]) * t + c[1]),
                                                              bend(6 * c[3] * t + 2 * c[2]) {}
};
// Position 0 .. 1 from the second of the four points.
constexpr std::array<Float4, 4> kCubic{Float4{1.F / 6, 4.F / 6, 1.F / 6, 0}, Float4{-0.5F, 0, 0.5F, 0},
                                       Float4{0.5F, -1, 0.5F, 0}, Float4{-1.F / 6, 0.5F, -0.5F, 1.F / 6}};
// Three points (the fourth has no weight); position -1/2 .. 1/2 from the second.
constexpr std::array<Float4, 4> kQuadratic{Float4{0.125F, 0.75F, 0.125F, 0}, Float4{-0.5F, 0, 0.5F, 0},
                                           Float4{0.5F, -1, 0.5F, 0}, Float4{0, 0, 0, 0}};

constexpr float kMostCarriedMm = 2;
constexpr float kLeast = 1e-30F;  // instead of 0, to divide by

TimeLaw fewerFrames(TimeLaw law) RELIEVO_RT {
  return framesAhead(law) > framesAhead(TimeLaw::BSpline) ? TimeLaw::BSpline
         : law == TimeLaw::BSpline                        ? TimeLaw::Linear
                                                          : TimeLaw::Hold;
}

// std::floor is a call on processors without an instruction for it.
int below(double v) RELIEVO_RT {
  const int whole = static_cast<int>(v);
  return v < whole ? whole - 1 : whole;
}

}  // namespace

SurfaceLevel::SurfaceLevel(double sigma_mm, int most_samples, SpaceLaw space, TimeLaw time, Curvature curvature,
                           double steady_mm) noexcept
    : grid_(sigma_mm / kSigmaPerPitch, most_samples,
            curvature == Curvature::Flattened ? 0
            : space == SpaceLaw::Quadratic    ? 1.F / 6
                                              : 5.F / 24),
      time_(time),
      steady_mm_(static_cast<float>(steady_mm)),
      cubic_(space != SpaceLaw::Quadratic) {}

// Frames that come together, after a late picture, a seek or a cut, are read one in a tick, and what the law needs
// besides bit by bit (`readLacking`): until then the surface in time is that of fewer frames.
void SurfaceLevel::weigh(const FrameSlots& slots, const FrameMoment& moment, const FrameMoment& later,
                         WeighedFrames& out) const RELIEVO_RT {
  const auto several = [](std::uint32_t bits) RELIEVO_RT { return (bits & (bits - 1)) != 0; };
  out.weigh(time_, slots, moment, later);
  while (out.law != TimeLaw::Hold && several(out.frames.wanted & ~grid_.slotsRead())) {
    out.weigh(fewerFrames(out.law), slots, moment, later);
  }
}

// When an edge passes a point, the surface there does not move: carrying its height on would throw it beyond both sides
// of the edge. So a way over kMostCarriedMm counts less, and a way twice as long not at all.
RELIEVO_TICK_CODE void SurfaceLevel::blend(const FrameSlots& slots, const WeighedFrames& weighed, const Cell& cell,
                                           Patch& out) RELIEVO_RT {
  grid_.patch(cell.i, cell.j, weighed.frames, out);
  const Duration carried = slots.window->carried;
  if (carried == Duration(0)) return;
  ControlGrid::Frames frames = weighed.frames;
  const FrameWeights weights = carriedWeights(*slots.window, weighed.moment, weighed.law, carried);
  frames.weight.fill(0);
  for (std::size_t f = 0; f < static_cast<std::size_t>(slots.window->count); ++f) {
    if (weights[f] == 0) continue;
    frames.weight[slots.of_frame[f]] += weights[f];
    frames.wanted |= 1U << slots.of_frame[f];
  }
  Patch there;
  grid_.patch(cell.i, cell.j, frames, there);
  for (std::size_t j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const float way = there[j][i] - out[j][i], size = std::abs(way);
      out[j][i] += std::copysign(std::max(std::min(size, 2 * kMostCarriedMm - size), 0.F), way);
    }
  }
}

// Adds x^5/(s^4 + x^4) of what the fitted spline adds, x: nothing of what is less than s by far, all of what is more.
// All derivatives are continuous, so that the surface stays as smooth in time as the splines are.
RELIEVO_TICK_CODE void SurfaceLevel::addWhereUnsteady(const WeighedFrames& weighed, const Cell& cell,
                                                      Patch& out) const RELIEVO_RT {
  if (weighed.law != TimeLaw::Adapted || grid_.patchHasHoles()) return;
  Patch added;
  grid_.weighted<1>(cell.i, cell.j, {&weighed.added}, {&added});
  addWhereUnsteady(added, out);
}

RELIEVO_TICK_CODE void SurfaceLevel::addWhereUnsteady(const Patch& added, Patch& out) const RELIEVO_RT {
  const float steady2 = steady_mm_ * steady_mm_, steady4 = std::max(steady2 * steady2, kLeast);
  for (std::size_t j = 0; j < 4; ++j) {
    const Float4 square = added[j] * added[j], fourth = square * square;
    out[j] += added[j] * fourth / (steady4 + fourth);
  }
}

RELIEVO_TICK_CODE void SurfaceLevel::begin(const FrameSlots& slots, const FrameMoment& moment,
                                           std::optional<double> since_prepared_s) RELIEVO_RT {
  slots_ = &slots;
  moment_ = moment;
  is_weighed_ = patch_.valid = frame_patch_[0].valid = frame_patch_[1].valid = false;
  since_prepared_s_.reset();
  if (since_prepared_s) since_prepared_s_ = static_cast<float>(*since_prepared_s);
}

RELIEVO_TICK_CODE SurfaceLevel::Cell SurfaceLevel::cellOf(double x_mm, double y_mm) const RELIEVO_RT {
  // Far outside the picture all places are alike, and a larger number would overflow a grid index.
  constexpr double kFar = 1e6;
  const double shift = cubic_ ? 0 : 0.5;
  const double a = grid_.a(std::min(std::max(x_mm, -kFar), kFar)), b = grid_.b(std::min(std::max(y_mm, -kFar), kFar));
  const int fa = below(a + shift), fb = below(b + shift);
  return {fa - 1, fb - 1, static_cast<float>(a - fa), static_cast<float>(b - fb)};
}

RELIEVO_TICK_CODE const Patch& SurfaceLevel::patchAt(const Cell& cell) RELIEVO_RT {
  if (patch_.isOf(cell)) return patch_.points;
  if (since_prepared_s_ && cell.i == prepared_i_ && cell.j == prepared_j_) {
    for (std::size_t j = 0; j < 4; ++j) patch_.points[j] = prepared_[j] + prepared_rate_[j] * *since_prepared_s_;
  } else {
    if (!is_weighed_) weigh(*slots_, moment_, moment_, weighed_);
    is_weighed_ = true;
    blend(*slots_, weighed_, cell, patch_.points);
    addWhereUnsteady(weighed_, cell, patch_.points);
  }
  patch_.i = cell.i;
  patch_.j = cell.j;
  patch_.valid = true;
  return patch_.points;
}

SurfacePoint SurfaceLevel::atFrame(std::size_t which, double x_mm, double y_mm) RELIEVO_RT {
  const Cell cell = cellOf(x_mm, y_mm);
  CellPatch& patch = frame_patch_[which];
  if (!patch.isOf(cell)) {
    const int frame = std::min(moment_.present + static_cast<int>(which), moment_.last);
    const std::uint8_t slot = slots_->of_frame[static_cast<std::size_t>(frame)];
    ControlGrid::Frames one{.window = slots_->window, .frame_of_slot = slots_->frame, .wanted = 1U << slot};
    one.weight[slot] = 1;
    grid_.patch(cell.i, cell.j, one, patch.points);
    patch.i = cell.i;
    patch.j = cell.j;
    patch.valid = true;
  }
  return pointOn(patch.points, cell);
}

RELIEVO_TICK_CODE double SurfaceLevel::height(double x_mm, double y_mm) RELIEVO_RT {
  const Cell cell = cellOf(x_mm, y_mm);
  const Patch& p = patchAt(cell);
  const std::array<Float4, 4>& polynomials = cubic_ ? kCubic : kQuadratic;
  const Float4 h = basis(polynomials, cell.a), v = basis(polynomials, cell.b);
  const Float4 row = (p[0] * v[0] + p[1] * v[1] + p[2] * v[2] + p[3] * v[3]) * h;
  return static_cast<double>((row[0] + row[1]) + (row[2] + row[3]));
}

RELIEVO_TICK_CODE SurfacePoint SurfaceLevel::at(double x_mm, double y_mm) RELIEVO_RT {
  const Cell cell = cellOf(x_mm, y_mm);
  return pointOn(patchAt(cell), cell);
}

RELIEVO_TICK_CODE SurfacePoint SurfaceLevel::pointOn(const Patch& p, const Cell& cell) const RELIEVO_RT {
  const std::array<Float4, 4>& polynomials = cubic_ ? kCubic : kQuadratic;
  const Basis h(polynomials, cell.a), v(polynomials, cell.b);
  const Float4 row = p[0] * v.value[0] + p[1] * v.value[1] + p[2] * v.value[2] + p[3] * v.value[3];
  const Float4 row_slope = p[0] * v.slope[0] + p[1] * v.slope[1] + p[2] * v.slope[2] + p[3] * v.slope[3];
  const Float4 row_bend = p[0] * v.bend[0] + p[1] * v.bend[1] + p[2] * v.bend[2] + p[3] * v.bend[3];
  const Float4 low = sums(row * h.value, row * h.slope, row_slope * h.value, row * h.bend);
  const Float4 high = sums(row_slope * h.slope, row_bend * h.value, Float4{}, Float4{});
  const double da = grid_.aPerMm(), db = grid_.bPerMm();
  const auto d = [](float f) { return static_cast<double>(f); };
  return {d(low[0]), d(low[1]) * da, d(low[2]) * db, d(low[3]) * da * da, d(high[0]) * da * db, d(high[1]) * db * db};
}

void SurfaceLevel::prepare(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next,
                           const FrameMoment& later, double step_s) RELIEVO_RT {
  const Cell cell = cellOf(x_mm, y_mm);
  prepared_i_ = cell.i;
  prepared_j_ = cell.j;
  weigh(slots, next, later, weighed_);
  grid_.readPatch(cell.i, cell.j, weighed_.frames);
  const ControlGrid::Weights &here = weighed_.frames.weight, &there = weighed_.later;
  const bool plain = !grid_.patchHasHoles() && slots.window->carried == Duration(0);
  const bool adapted = plain && weighed_.law == TimeLaw::Adapted;
  Patch then, added;
  if (adapted) {
    grid_.weighted<3>(cell.i, cell.j, {&here, &there, &weighed_.added}, {&prepared_, &then, &added});
  } else if (plain) {
    grid_.weighted<2>(cell.i, cell.j, {&here, &there}, {&prepared_, &then});
  } else {
    blendBoth(slots, later, cell, then);
  }
  // The rate leaves out what is added to the B-spline, which hardly changes between two ticks. A point where a hole
  // opens or closes between the two frames jumps, so it has no rate.
  const Float4 pit = Float4{} + grid_.pitMm();
  for (std::size_t j = 0; j < 4; ++j) {
    const auto jumps = (then[j] == pit) != (prepared_[j] == pit);
    prepared_rate_[j] = jumps ? Float4{} : (then[j] - prepared_[j]) / static_cast<float>(step_s);
  }
  if (adapted) addWhereUnsteady(added, prepared_);
  if (!plain) addWhereUnsteady(weighed_, cell, prepared_);
  if (weighed_.law != time_) readLacking(slots, next, cell);
}

// Beside holes, and carried forward in time.
void SurfaceLevel::blendBoth(const FrameSlots& slots, const FrameMoment& later, const Cell& cell,
                             Patch& then) RELIEVO_RT {
  WeighedFrames at_then = weighed_;
  at_then.moment = later;
  at_then.frames.weight = weighed_.later;
  blend(slots, at_then, cell, then);
  blend(slots, weighed_, cell, prepared_);
}

bool SurfaceLevel::readAllAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next,
                                int most) RELIEVO_RT {
  const Cell cell = cellOf(x_mm, y_mm);
  weighed_.weigh(time_, slots, next, next);
  return grid_.readAhead(cell.i, cell.j, weighed_.frames, most);
}

// A few blocks of the first frame that the law needs and of which none have been read.
void SurfaceLevel::readLacking(const FrameSlots& slots, const FrameMoment& moment, const Cell& cell) RELIEVO_RT {
  constexpr int kBlocksAtOnce = 8;
  WeighedFrames all;
  all.weigh(time_, slots, moment, moment);
  ControlGrid::Frames& frames = all.frames;
  frames.wanted &= ~grid_.slotsRead();
  frames.wanted &= ~frames.wanted + 1;
  if (frames.wanted != 0) grid_.readAhead(cell.i, cell.j, frames, kBlocksAtOnce);
}

void SurfaceLevel::readAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next) RELIEVO_RT {
  constexpr int kBlocksAtOnce = 3;
  const int frame = next.present + framesAhead(time_) + 1;
  if (frame > next.last) return;
  const std::uint8_t slot = slots.of_frame[static_cast<std::size_t>(frame)];
  const ControlGrid::Frames one{.window = slots.window, .frame_of_slot = slots.frame, .wanted = 1U << slot};
  const Cell cell = cellOf(x_mm, y_mm);
  grid_.readAhead(cell.i, cell.j, one, kBlocksAtOnce);
}

void SurfaceLevel::prefetch() const RELIEVO_RT {
  grid_.prefetch();
  relievo::prefetch(&time_, this + 1);
}

}  // namespace relievo
