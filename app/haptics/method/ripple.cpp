// SPDX-License-Identifier: Apache-2.0
// Two sines, their fade with the speed, and the account of their work.
#include "app/haptics/method/ripple.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace relievo {
namespace {

// sin(2 pi turns), the same on all machines; off by less than 1e-7.
double sineOf(double turns) RELIEVO_RT {
  double t = turns - std::floor(turns + 0.5);
  if (std::abs(t) > 0.25) t = std::copysign(0.5, t) - t;
  const double a = 2 * std::numbers::pi * t, a2 = a * a;
  return a * (1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72 * (1 - a2 / 110)))));
}

// 1 up to kFlat ripples a tick, 0 from half a ripple on; smooth.
double withinTheRate(double ripples_a_tick) RELIEVO_RT {
  const double t = std::clamp((0.5 - std::abs(ripples_a_tick)) / (0.5 - Ripple::kFlat), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

Ripple::Ripple(double wavelength_mm, double tick_s) noexcept
    : per_mm_(1 / wavelength_mm), newest_(std::min(tick_s / kSpeedWithinS, 1.0)) {}

glm::dvec3 Ripple::offset(const Finger& finger) RELIEVO_RT {
  if (!feels_) {
    feels_ = true;
    hip_mm_ = finger.hip_mm;
    force_n_ = glm::dvec3(0);
    ripples_a_tick_ = glm::dvec2(0);
    own_mj_ = kGiftMj;
  }
  const glm::dvec3 moved = finger.hip_mm - hip_mm_;
  ripples_a_tick_ += newest_ * (per_mm_ * glm::dvec2(moved.x, moved.y) - ripples_a_tick_);
  hip_mm_ = finger.hip_mm;
  double height = 0;
  if (finger.amplitude_mm > 0) {
    const double full = 2 * finger.amplitude_mm, depth = finger.depth_mm;  // the highest crest: two sines
    height = finger.amplitude_mm * heightAt(finger.hip_mm) * depth / std::sqrt(depth * depth + full * full);
  }
  height = paidFor(height, finger.stiffness_n_per_mm, glm::dot(moved, finger.normal), moved);
  force_n_ = finger.stiffness_n_per_mm * height * finger.normal;
  return height * finger.normal;
}

// Of amplitude 1.
double Ripple::heightAt(const glm::dvec3& hip_mm) const RELIEVO_RT {
  return withinTheRate(ripples_a_tick_.x) * sineOf(hip_mm.x * per_mm_) +
         withinTheRate(ripples_a_tick_.y) * sineOf(hip_mm.y * per_mm_);
}

// The work of the last tick's force and this one's, by the trapezoid rule. The next tick is taken to move as this one.
double Ripple::paidFor(double height_mm, double stiffness, double out_mm, const glm::dvec3& moved_mm) RELIEVO_RT {
  own_mj_ -= 0.5 * glm::dot(force_n_, moved_mm);
  double gives = stiffness * height_mm * out_mm;
  const double has = std::max(own_mj_, 0.0);
  if (gives > has) {
    height_mm *= has / gives;
    gives = has;
  }
  own_mj_ = std::min(own_mj_ - 0.5 * gives, kMostOwnMj);
  return height_mm;
}

}  // namespace relievo
