// SPDX-License-Identifier: Apache-2.0
// The two levels, blended by the product rule.
#include "app/haptics/method/smooth_level.h"

#include <algorithm>

#include "platform/prefetch.h"

namespace relievo {
namespace {

// The weight of points that are not straight at which the broad level no longer counts.
constexpr double kMostBent = 0.05;

// h(t): from 0 at t = 1 - kMostBent to 1 at t = 1, with two continuous derivatives (6 e^5 - 15 e^4 + 10 e^3).
SurfacePoint shareOf(const SurfacePoint& t) RELIEVO_RT {
  const double e = 1 - std::min(std::max(1 - t.z, 0.0), kMostBent) / kMostBent, rest = 1 - e;
  const double slope = 30 * e * e * rest * rest / kMostBent;
  const double bend = 60 * e * rest * (rest - e) / (kMostBent * kMostBent);
  return {e * e * e * (10 + e * (6 * e - 15)),
          slope * t.zx,
          slope * t.zy,
          slope * t.zxx + bend * t.zx * t.zx,
          slope * t.zxy + bend * t.zx * t.zy,
          slope * t.zyy + bend * t.zy * t.zy};
}

}  // namespace

SmoothLevel::SmoothLevel(const FeltScale& scale) noexcept
    : straight_{.most_mm = static_cast<float>(scale.straight_mm)},
      wide_(scale.wide_mm, kWideSamples, scale.space, scale.wide_time, SurfaceLevel::Curvature::Kept, nullptr,
            scale.wide_steady_mm),
      broad_(scale.broad_mm, kBroadSamples, scale.space, scale.wide_time, SurfaceLevel::Curvature::Kept,
             scale.straight_mm > 0 ? &straight_ : nullptr, scale.wide_steady_mm),
      has_broad_(scale.broad_mm > scale.wide_mm && scale.straight_mm > 0) {}

void SmoothLevel::setPicture(const HeightField& field) RELIEVO_RT {
  wide_.grid().setPicture(field);
  broad_.grid().setPicture(field);
}

void SmoothLevel::forgetFrame(int slot) RELIEVO_RT {
  wide_.grid().forgetFrame(slot);
  broad_.grid().forgetFrame(slot);
}

bool SmoothLevel::isWiderThan(const ControlGrid& narrow) const RELIEVO_RT {
  return wide_.grid().blockCols() > narrow.blockCols() || wide_.grid().blockRows() > narrow.blockRows();
}

RELIEVO_TICK_CODE void SmoothLevel::begin(const FrameSlots& slots, const FrameMoment& moment,
                                          std::optional<double> since_prepared_s) RELIEVO_RT {
  // The wide level is not prepared where the broad one alone counts.
  const bool wide_prepared = !has_broad_ || !broad_.preparedStraight();
  wide_.begin(slots, moment, wide_prepared ? since_prepared_s : std::nullopt);
  if (has_broad_) broad_.begin(slots, moment, since_prepared_s);
}

RELIEVO_TICK_CODE SurfacePoint SmoothLevel::at(double x_mm, double y_mm) RELIEVO_RT {
  if (!has_broad_) return wide_.at(x_mm, y_mm);
  const auto straight = broad_.straightness(x_mm, y_mm);
  if (straight.all) return broad_.at(x_mm, y_mm);
  const SurfacePoint w = wide_.at(x_mm, y_mm);
  if (straight.share.z <= 1 - kMostBent) return w;
  const SurfacePoint b = broad_.at(x_mm, y_mm), t = shareOf(straight.share);
  const double d = b.z - w.z, dx = b.zx - w.zx, dy = b.zy - w.zy;
  return {w.z + t.z * d,
          w.zx + t.z * dx + t.zx * d,
          w.zy + t.z * dy + t.zy * d,
          w.zxx + t.z * (b.zxx - w.zxx) + 2 * t.zx * dx + t.zxx * d,
          w.zxy + t.z * (b.zxy - w.zxy) + t.zx * dy + t.zy * dx + t.zxy * d,
          w.zyy + t.z * (b.zyy - w.zyy) + 2 * t.zy * dy + t.zyy * d};
}

RELIEVO_TICK_CODE double SmoothLevel::height(double x_mm, double y_mm) RELIEVO_RT {
  if (!has_broad_) return wide_.height(x_mm, y_mm);
  const auto straight = broad_.straightness(x_mm, y_mm);
  if (straight.all) return broad_.height(x_mm, y_mm);
  const double w = wide_.height(x_mm, y_mm);
  if (straight.share.z <= 1 - kMostBent) return w;
  return w + shareOf(straight.share).z * (broad_.height(x_mm, y_mm) - w);
}

void SmoothLevel::prepare(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next,
                          const FrameMoment& later, double step_s) RELIEVO_RT {
  if (has_broad_) {
    broad_.prepare(slots, x_mm, y_mm, next, later, step_s);
    if (broad_.preparedStraight()) return;
  }
  wide_.prepare(slots, x_mm, y_mm, next, later, step_s);
}

void SmoothLevel::readAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next) RELIEVO_RT {
  if (has_broad_ && !broad_.bent()) broad_.readAhead(slots, x_mm, y_mm, next);
  if (!has_broad_ || !broad_.preparedStraight()) wide_.readAhead(slots, x_mm, y_mm, next);
}

void SmoothLevel::prefetch() const RELIEVO_RT {
  wide_.prefetch();
  broad_.prefetch();
}

}  // namespace relievo
