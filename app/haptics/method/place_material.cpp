// SPDX-License-Identifier: Apache-2.0
// Reads the material track, limits its values, and keeps the energy of a spring whose stiffness changes.
#include "app/haptics/method/place_material.h"

#include <algorithm>
#include <cmath>

#include "app/haptics/method/frame_weights.h"

namespace relievo {
namespace {

constexpr double kNearMm = 0.1;
constexpr Duration kNear = std::chrono::microseconds(500);
constexpr double kLeastStiffness = 1e-3;  // a place of none is felt as this, which is nothing

MaterialMap::Shares mixed(const MaterialMap::Shares& a, const MaterialMap::Shares& b, double t) RELIEVO_RT {
  return {a.stiffness + t * (b.stiffness - a.stiffness), a.friction + t * (b.friction - a.friction),
          a.texture + t * (b.texture - a.texture)};
}

}  // namespace

MaterialReader::MaterialReader(const PlaceMaterial& whole, const HeldScale& scale) noexcept
    : whole_(whole),
      found_(whole),
      scale_{.stiffness = scale.stiffness_n_per_mm.value_or(-1),
             .most_stiffness = scale.most_n_per_mm,
             .still = scale.friction ? scale.friction->static_coefficient : -1,
             .moving = scale.friction ? scale.friction->dynamic_coefficient : -1,
             .amplitude = scale.texture ? scale.texture->amplitude_mm : -1,
             .most_ripple_n = scale.most_ripple_n},
      exists_(scale.exists()) {}

bool MaterialReader::isNear(MediaTime now, double x_mm, double y_mm) const RELIEVO_RT {
  return std::chrono::abs(now - read_for_) <= kNear && std::abs(x_mm - x_mm_) < kNearMm &&
         std::abs(y_mm - y_mm_) < kNearMm;
}

void MaterialReader::read(const SurfaceWindow& window, MediaTime now, double x_mm, double y_mm) RELIEVO_RT {
  read_for_ = now;
  x_mm_ = x_mm;
  y_mm_ = y_mm;
  const FrameMoment moment(window, now);
  const auto present = static_cast<std::size_t>(std::max(moment.present, 0));
  const MaterialMap* const here = window.frames[present].material.get();
  if (here == nullptr) {
    found_ = whole_;
    return;
  }
  MaterialMap::Shares shares = here->at(x_mm, y_mm);
  const MaterialMap* const next = moment.present < moment.last ? window.frames[present + 1].material.get() : nullptr;
  if (next != nullptr && moment.share > 0) shares = mixed(shares, next->at(x_mm, y_mm), moment.share);
  found_ = madeOf(shares);
}

PlaceMaterial MaterialReader::madeOf(const MaterialMap::Shares& shares) const RELIEVO_RT {
  PlaceMaterial made = whole_;
  if (scale_.stiffness >= 0) {
    made.stiffness_n_per_mm = std::clamp(scale_.stiffness * shares.stiffness, kLeastStiffness, scale_.most_stiffness);
  }
  if (scale_.still >= 0) made.friction = {scale_.still * shares.friction, scale_.moving * shares.friction};
  if (scale_.amplitude >= 0) made.amplitude_mm = scale_.amplitude * shares.texture;
  made.amplitude_mm = std::min(made.amplitude_mm, scale_.most_ripple_n / made.stiffness_n_per_mm);
  return made;
}

double PlaceSpring::share(double depth_mm, double stiffness_n_per_mm) RELIEVO_RT {
  const double k = stiffness_n_per_mm;
  if (!holds_) {
    holds_ = true;
    length_mm_ = std::min(depth_mm, most_n_ / k);
    owned_mj_ = 0.5 * k * length_mm_ * length_mm_;
  } else {
    // The energy that the motion of the finger or of the surface puts into the spring, by the trapezoid rule. `own`
    // leaves out this tick's force.
    const double way = depth_mm - depth_mm_;
    const double own = std::max(owned_mj_ + 0.5 * stiffness_ * length_mm_ * way, 0.0);
    const double whole = own + 0.5 * k * depth_mm * way, stored = 0.5 * k * depth_mm * depth_mm;
    if (whole >= stored * (1 - 1e-9)) {
      length_mm_ = depth_mm;
      owned_mj_ = std::max(whole, stored);
    } else {  // k l^2/2 = own + k l way/2
      length_mm_ = std::clamp(0.5 * (way + std::sqrt(way * way + 8 * own / k)), 0.0, depth_mm);
      owned_mj_ = 0.5 * k * length_mm_ * length_mm_;
    }
  }
  depth_mm_ = depth_mm;
  stiffness_ = k;
  return depth_mm > 0 ? std::min(length_mm_ / depth_mm, 1.0) : 1.0;
}

}  // namespace relievo
