// SPDX-License-Identifier: Apache-2.0
// Two levels, the soft clamp between them, and the frames that both use.
#include "app/haptics/method/felt_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "app/haptics/method/edge_motion.h"
#include "platform/prefetch.h"

namespace relievo {
namespace {

// A tick this close to the predicted time uses what was prepared for it.
constexpr Duration kPreparedWithin = std::chrono::microseconds(500);

// If W and N differ by less than this share of the clamp d, S = W, that is c(u) = u. A larger share passes less of N's
// noise; the rest of the clamp is the range in which c saturates.
constexpr double kWideAlone = 0.7;

// Beyond that, c approaches d as a + (d - a) g(s) with a = kWideAlone d, s = (|u| - a)/(d - a) and g(s) = s/(1 +
// s^4)^(1/4): four continuous derivatives, and monotone.
struct SoftClamp {
  double value, slope, bend;
  SoftClamp(double u, double d) RELIEVO_RT {
    const double a = kWideAlone * d, s = (std::abs(u) - a) / (d - a), s2 = s * s, base = 1 + s2 * s2;
    const double root = std::sqrt(std::sqrt(base));
    slope = 1 / (base * root);
    value = std::copysign(a + (d - a) * s / root, u);
    bend = std::copysign(5 * s2 * s * slope / (base * (d - a)), -u);
  }
};

}  // namespace

std::uint64_t mostBlocksOf(double tick_s) noexcept {
  const double share = std::min(tick_s / 0.001, 1.0);
  return std::max(static_cast<std::uint64_t>(share * static_cast<double>(kBlocksOfTick)), kBlocksOfFrame);
}

FeltSurface::FeltSurface(const FeltScale& scale, double tick_s) noexcept
    : scale_(scale),
      most_blocks_(mostBlocksOf(tick_s)),
      narrow_(scale.narrow_mm, kNarrowSamples, scale.space, scale.narrow_time, SurfaceLevel::Curvature::Flattened,
              scale.narrow_steady_mm),
      smooth_(scale),
      two_levels_(scale.wide_mm > scale.narrow_mm) {}

RELIEVO_TICK_CODE bool FeltSurface::moveTo(const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (window.count == 0) return false;
  read_before_ = blocksRead();
  const HeightField& field = window.frames[0].field;
  if (window.epoch != epoch_ || field.cols() != cols_ || field.rows() != rows_ || slots_.in_use == 0) {
    setPicture(window);
  }
  placeFrames(window);
  slots_.window = &window;
  now -= window.carried;
  const FrameMoment moment(window, now);
  present_ = static_cast<std::size_t>(moment.present);
  next_ = static_cast<std::size_t>(std::min(moment.present + 1, moment.last));
  shot_ = window.frames[present_].shot;
  std::optional<double> since_prepared_s;
  if (prepared_ && weighedAt(window, moment) == prepared_on_ &&
      std::chrono::abs(now - prepared_for_) <= kPreparedWithin) {
    since_prepared_s = toSeconds(now - prepared_for_);
  }
  as_prepared_ = since_prepared_s.has_value();
  edge_.moves = two_levels_ && edge_.way_mm != glm::dvec2(0) && window.frames[present_].time == edge_.from;
  edge_.share = moment.share;
  narrow_.begin(slots_, moment, since_prepared_s);
  if (two_levels_) smooth_.begin(slots_, moment, since_prepared_s);
  return true;
}

void FeltSurface::setPicture(const SurfaceWindow& window) RELIEVO_RT {
  const HeightField& field = window.frames[0].field;
  epoch_ = window.epoch;
  prepared_ = false;
  cols_ = field.cols();
  rows_ = field.rows();
  depth_mm_ = field.depthMm();
  slots_.in_use = 0;
  count_ = 0;
  edge_.from = MediaTime::min();
  ControlGrid& narrow = narrow_.grid();
  narrow.setPicture(field);
  smooth_.setPicture(field);
  two_levels_ = scale_.wide_mm > scale_.narrow_mm && smooth_.isWiderThan(narrow);
  sample_mm_ = 0.5 / std::max(std::abs(narrow.aPerMm()), std::abs(narrow.bPerMm()));
}

// Assigns every frame of the window a cache slot, its previous one if it had one. Frames that repeat each other share a
// slot, which is labelled with the newest one's time.
RELIEVO_TICK_CODE void FeltSurface::placeFrames(const SurfaceWindow& window) RELIEVO_RT {
  const auto last = static_cast<std::size_t>(window.count - 1);
  if (window.count == count_ && window.frames[0].time == first_time_ && window.frames[last].time == last_time_) return;
  count_ = window.count;
  first_time_ = window.frames[0].time;
  last_time_ = window.frames[last].time;

  std::uint32_t kept = 0;
  std::array<bool, ControlGrid::kFrames> placed{};
  for (std::size_t f = 0; f <= last; ++f) {
    for (std::size_t s = 0; s < ControlGrid::kFrames; ++s) {
      if ((slots_.in_use & ~kept & 1U << s) == 0 || time_of_slot_[s] != window.frames[f].time) continue;
      kept |= 1U << s;
      slots_.of_frame[f] = static_cast<std::uint8_t>(s);
      placed[f] = true;
      break;
    }
  }
  for (std::size_t f = last; f > 0; --f) {
    if (!window.frames[f].repeats || !placed[f] || placed[f - 1]) continue;
    slots_.of_frame[f - 1] = slots_.of_frame[f];
    placed[f - 1] = true;
  }
  slots_.in_use = kept;
  for (std::size_t f = 0; f <= last; ++f) {
    if (!placed[f] && f > 0 && window.frames[f].repeats) {
      slots_.of_frame[f] = slots_.of_frame[f - 1];
    } else if (!placed[f]) {
      const auto s = static_cast<std::size_t>(__builtin_ctz(~slots_.in_use));
      slots_.in_use |= 1U << s;
      slots_.of_frame[f] = static_cast<std::uint8_t>(s);
      narrow_.grid().forgetFrame(static_cast<int>(s));
      smooth_.forgetFrame(static_cast<int>(s));
    }
    slots_.frame[slots_.of_frame[f]] = static_cast<std::uint8_t>(f);
    time_of_slot_[slots_.of_frame[f]] = window.frames[f].time;
  }
}

// The present frame with its edge displaced so far, blended with the next frame before its edge arrives.
SurfacePoint FeltSurface::narrowAt(double x_mm, double y_mm) RELIEVO_RT {
  if (!edge_.moves) return narrow_.at(x_mm, y_mm);
  const glm::dvec2 gone = edge_.share * edge_.way_mm, to_come = edge_.way_mm - gone;
  const SurfacePoint a = narrow_.atFrame(0, x_mm - gone.x, y_mm - gone.y);
  const SurfacePoint b = narrow_.atFrame(1, x_mm + to_come.x, y_mm + to_come.y);
  const auto mix = [s = edge_.share](double from, double to) { return from + (to - from) * s; };
  return {mix(a.z, b.z), mix(a.zx, b.zx), mix(a.zy, b.zy), mix(a.zxx, b.zxx), mix(a.zxy, b.zxy), mix(a.zyy, b.zyy)};
}

RELIEVO_TICK_CODE SurfacePoint FeltSurface::at(double x_mm, double y_mm) RELIEVO_RT {
  if (!two_levels_) return narrow_.at(x_mm, y_mm);
  const SurfacePoint w = smooth_.at(x_mm, y_mm);
  if (!edge_.moves && std::abs(w.z - narrow_.height(x_mm, y_mm)) <= kWideAlone * scale_.clamp_mm) return w;
  const SurfacePoint n = narrowAt(x_mm, y_mm);
  if (std::abs(w.z - n.z) <= kWideAlone * scale_.clamp_mm) return w;
  const SoftClamp c(w.z - n.z, scale_.clamp_mm);
  const double ux = w.zx - n.zx, uy = w.zy - n.zy;
  return {n.z + c.value,
          n.zx + c.slope * ux,
          n.zy + c.slope * uy,
          n.zxx + c.slope * (w.zxx - n.zxx) + c.bend * ux * ux,
          n.zxy + c.slope * (w.zxy - n.zxy) + c.bend * ux * uy,
          n.zyy + c.slope * (w.zyy - n.zyy) + c.bend * uy * uy};
}

RELIEVO_TICK_CODE double FeltSurface::height(double x_mm, double y_mm) RELIEVO_RT {
  const double n = edge_.moves ? narrowAt(x_mm, y_mm).z : narrow_.height(x_mm, y_mm);
  if (!two_levels_) return n;
  const double w = smooth_.height(x_mm, y_mm);
  return std::abs(w - n) <= kWideAlone * scale_.clamp_mm ? w : n + SoftClamp(w - n, scale_.clamp_mm).value;
}

// The sample whose place this is; false outside the picture.
bool FeltSurface::sampleAt(double x_mm, double y_mm, int& c, int& r) const RELIEVO_RT {
  const GridMapping& grid = slots_.window->frames[present_].field.grid();
  const double u = grid.u(x_mm) + 0.5, v = grid.v(y_mm) + 0.5;
  if (!(u >= 0 && u < cols_ && v >= 0 && v < rows_)) return false;
  c = static_cast<int>(u);
  r = static_cast<int>(v);
  return true;
}

double FeltSurface::lowestSample(double x_mm, double y_mm) const RELIEVO_RT {
  int c, r;
  if (!sampleAt(x_mm, y_mm, c, r)) return -depth_mm_;
  const double here = slots_.window->frames[present_].field.heightMm(c, r);
  const double there = slots_.window->frames[next_].field.heightMm(c, r);
  return std::isnan(here) || std::isnan(there) ? -depth_mm_ : std::min(here, there);
}

RELIEVO_TICK_CODE void FeltSurface::prefetchSample(double x_mm, double y_mm) const RELIEVO_RT {
  int c, r;
  if (!sampleAt(x_mm, y_mm, c, r)) return;
  constexpr SampledBlock kOne;
  slots_.window->frames[present_].field.prefetch(c, r, 1, kOne);
  slots_.window->frames[next_].field.prefetch(c, r, 1, kOne);
}

// Measures the edge again for each new frame, and when the finger has moved so far that another edge may be near, at a
// limited rate for a fast finger.
void FeltSurface::followEdge(const SurfaceWindow& window, MediaTime next, const FrameMoment& moment, double x_mm,
                             double y_mm) RELIEVO_RT {
  constexpr double kNearMm = 1.5;
  constexpr Duration kNotSooner = std::chrono::milliseconds(4);
  const TimedSurface& from = window.frames[static_cast<std::size_t>(moment.present)];
  const glm::dvec2 place(x_mm, y_mm), moved = place - edge_.place_mm;
  if (from.time == edge_.from) {
    const bool near = std::max(std::abs(moved.x), std::abs(moved.y)) < kNearMm;
    if (near || std::chrono::abs(next - edge_.looked) < kNotSooner) return;
  }
  if (moment.present >= moment.last && moment.present + 1 >= window.count) {
    edge_.way_mm = glm::dvec2(0);  // the next frame has not arrived
    return;
  }
  edge_.looked = next;
  edge_.from = from.time;
  edge_.place_mm = place;
  edge_.way_mm = glm::dvec2(0);
  if (scale_.narrow_time == TimeLaw::Hold || moment.present >= moment.last) return;
  const TimedSurface& to = window.frames[static_cast<std::size_t>(moment.present) + 1];
  if (!to.repeats) edge_.way_mm = edgeMotion(from.field, to.field, x_mm, y_mm);
}

RELIEVO_TICK_CODE FeltSurface::Weighed FeltSurface::weighedAt(const SurfaceWindow& window,
                                                              const FrameMoment& moment) RELIEVO_RT {
  const auto time = [&](int frame) RELIEVO_RT {
    return window.frames[static_cast<std::size_t>(std::clamp(frame, moment.first, moment.last))].time;
  };
  return {time(moment.present - 2), time(moment.present), time(moment.present + 3)};
}

// Reads blocks of the next frame before it is due, at the place that the finger will have reached. Only in the last 20
// ms and kFarthestMm: earlier, a fast finger could still go elsewhere.
void FeltSurface::readAhead(const SurfaceWindow& window, MediaTime next, const FrameMoment& moment,
                            const glm::dvec2& place_mm, const glm::dvec2& mm_per_s) RELIEVO_RT {
  constexpr Duration kAhead = std::chrono::milliseconds(20);
  constexpr double kFarthestMm = 10;
  if (moment.present >= moment.last) return;
  const Duration left = window.frames[static_cast<std::size_t>(moment.present) + 1].time - next;
  if (left > kAhead) return;
  const glm::dvec2 way = toSeconds(left) * mm_per_s;
  if (glm::dot(way, way) > kFarthestMm * kFarthestMm) return;
  const glm::dvec2 then = place_mm + way;
  narrow_.readAhead(slots_, then.x, then.y, moment);
  if (two_levels_) smooth_.readAhead(slots_, then.x, then.y, moment);
}

void FeltSurface::prepare(const SurfaceWindow& window, MediaTime next, double x_mm, double y_mm,
                          const glm::dvec2& mm_per_s) RELIEVO_RT {
  constexpr Duration kStep = kPreparedWithin;
  next -= window.carried;
  const FrameMoment moment(window, next), later = moment.at(window, next + kStep);
  prepared_ = true;
  prepared_for_ = next;
  prepared_on_ = weighedAt(window, moment);
  if (two_levels_) followEdge(window, next, moment, x_mm, y_mm);
  // If a new frame begins in between, the later moment does not give the surface's rate of change.
  const FrameMoment& comparable = later.share < 1 ? later : moment;
  narrow_.prepare(slots_, x_mm, y_mm, moment, comparable, toSeconds(kStep));
  if (two_levels_) smooth_.prepare(slots_, x_mm, y_mm, moment, comparable, toSeconds(kStep));
  readAhead(window, next, moment, {x_mm, y_mm}, mm_per_s);
}

void FeltSurface::prefetch() const RELIEVO_RT {
  relievo::prefetch(&scale_, &narrow_);
  narrow_.prefetch();
  smooth_.prefetch();
  relievo::prefetch(&two_levels_, this + 1);
}

}  // namespace relievo
