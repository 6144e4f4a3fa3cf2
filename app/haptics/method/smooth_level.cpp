// SPDX-License-Identifier: Apache-2.0
// The levels, from the widest to the narrowest, blended by the product rule.
#include "app/haptics/method/smooth_level.h"

#include "platform/prefetch.h"

namespace relievo {
namespace {

SurfaceLevel levelOf(const FeltScale& scale, double width_mm, int samples, TimeLaw law) {
  return {width_mm > 0 ? width_mm : scale.wide_mm,
          samples,
          scale.space,
          law,
          SurfaceLevel::Curvature::Kept,
          scale.wide_steady_mm};
}

// A crease needs no more of time than that its place is right, so that few frames are read. Flicker needs them.
TimeLaw ofMiddle(TimeLaw wide) {
  return wide == TimeLaw::Mean || wide == TimeLaw::Hold ? wide : TimeLaw::Linear;
}

// a + t (b - a).
SurfacePoint blended(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& t) RELIEVO_RT {
  const double d = b.z - a.z, dx = b.zx - a.zx, dy = b.zy - a.zy;
  return {a.z + t.z * d,
          a.zx + t.z * dx + t.zx * d,
          a.zy + t.z * dy + t.zy * d,
          a.zxx + t.z * (b.zxx - a.zxx) + 2 * t.zx * dx + t.zxx * d,
          a.zxy + t.z * (b.zxy - a.zxy) + t.zx * dy + t.zy * dx + t.zxy * d,
          a.zyy + t.z * (b.zyy - a.zyy) + 2 * t.zy * dy + t.zyy * d};
}

}  // namespace

SmoothLevel::SmoothLevel(const FeltScale& scale) noexcept
    : levels_{Level{levelOf(scale, scale.middle_mm, kWideSamples, ofMiddle(scale.wide_time)),
                    Evenness(0, Evenness::Edges::Even)},
              Level{levelOf(scale, scale.wide_mm, kWideSamples, scale.wide_time),
                    Evenness(scale.wide_even_mm, Evenness::Edges::Even)},
              Level{levelOf(scale, scale.broad_mm, kBroadSamples, scale.wide_time),
                    Evenness(scale.broad_even_mm, Evenness::Edges::Uneven)}},
      narrowest_(scale.middle_mm > scale.narrow_mm && scale.wide_even_mm > 0 ? kMiddle : kWide),
      widest_(scale.broad_mm > scale.wide_mm && scale.broad_even_mm > 0 ? kBroad : kWide) {}

void SmoothLevel::setPicture(const HeightField& field) RELIEVO_RT {
  for (Level& level : levels_) {
    level.surface.grid().setPicture(field);
    level.evenness.forget();
    level.absent = false;
  }
}

void SmoothLevel::forgetFrame(int slot) RELIEVO_RT {
  for (Level& level : levels_) {
    level.surface.grid().forgetFrame(slot);
    level.evenness.forget(slot);
  }
}

bool SmoothLevel::isWiderThan(const ControlGrid& narrow) const RELIEVO_RT {
  const ControlGrid& wide = levels_[kWide].surface.grid();
  return wide.blockCols() > narrow.blockCols() || wide.blockRows() > narrow.blockRows();
}

std::uint64_t SmoothLevel::blocksRead() const RELIEVO_RT {
  std::uint64_t blocks = 0;
  for (const Level& level : levels_) blocks += level.surface.grid().blocksRead();
  return blocks;
}

RELIEVO_TICK_CODE void SmoothLevel::begin(const FrameSlots& slots, const FrameMoment& moment,
                                          std::optional<double> since_prepared_s) RELIEVO_RT {
  for (std::size_t k = narrowest_; k <= widest_; ++k) {
    levels_[k].evenness.begin(slots, moment);
    levels_[k].surface.begin(slots, moment, levels_[k].prepared ? since_prepared_s : std::nullopt);
  }
}

RELIEVO_TICK_CODE bool SmoothLevel::counts(Level& level, double x_mm, double y_mm) RELIEVO_RT {
  if (level.absent) return false;
  level.evenness.judge(level.surface.grid(), x_mm, y_mm);
  return !level.evenness.none();
}

RELIEVO_TICK_CODE SurfacePoint SmoothLevel::at(std::size_t k, double x_mm, double y_mm) RELIEVO_RT {
  Level& level = levels_[k];
  if (k == narrowest_) return level.surface.at(x_mm, y_mm);
  if (!counts(level, x_mm, y_mm)) return at(k - 1, x_mm, y_mm);
  const SurfacePoint v = level.surface.at(x_mm, y_mm);
  if (level.evenness.all()) return v;
  return blended(at(k - 1, x_mm, y_mm), v, level.evenness.at(level.surface.grid(), x_mm, y_mm));
}

RELIEVO_TICK_CODE double SmoothLevel::height(std::size_t k, double x_mm, double y_mm) RELIEVO_RT {
  Level& level = levels_[k];
  if (k == narrowest_) return level.surface.height(x_mm, y_mm);
  if (!counts(level, x_mm, y_mm)) return height(k - 1, x_mm, y_mm);
  const double v = level.surface.height(x_mm, y_mm);
  if (level.evenness.all()) return v;
  const double f = height(k - 1, x_mm, y_mm);
  return f + level.evenness.at(level.surface.grid(), x_mm, y_mm).z * (v - f);
}

// A level that was absent is read in a few ticks before it counts.
void SmoothLevel::prepare(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next,
                          const FrameMoment& later, double step_s) RELIEVO_RT {
  constexpr int kBlocksAtOnce = 32;
  for (Level& level : levels_) level.prepared = false;
  for (std::size_t k = widest_;; --k) {
    Level& level = levels_[k];
    if (k > narrowest_) {
      level.evenness.begin(slots, next);
      level.evenness.judge(level.surface.grid(), x_mm, y_mm);
      level.absent = level.evenness.none() ||
                     (level.absent && !level.surface.readAllAhead(slots, x_mm, y_mm, next, kBlocksAtOnce));
      if (level.absent) continue;
    }
    level.prepared = true;
    level.surface.prepare(slots, x_mm, y_mm, next, later, step_s);
    if (k == narrowest_) return;
    if (!level.evenness.all()) continue;
    // What was found to be absent at another place is read in time if this level ceases to be alone.
    for (std::size_t below = narrowest_; below < k; ++below) levels_[below].absent = false;
    return;
  }
}

void SmoothLevel::readAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next) RELIEVO_RT {
  for (Level& level : levels_) {
    if (level.prepared) level.surface.readAhead(slots, x_mm, y_mm, next);
  }
}

void SmoothLevel::prefetch() const RELIEVO_RT {
  for (const Level& level : levels_) level.surface.prefetch();
}

}  // namespace relievo
