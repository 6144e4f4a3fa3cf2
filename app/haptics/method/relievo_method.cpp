// SPDX-License-Identifier: Apache-2.0
// Inside and outside, contact and release, and re-seating at a cut.
#include "app/haptics/method/relievo_method.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "platform/prefetch.h"

namespace relievo {
namespace {

constexpr int kMostPasses = 4;
// 128 samples half a pitch apart: 28 mm, as for a finger at 5 m/s after a gap of 5 ms.
constexpr int kMostSamples = 128;
constexpr int kBisections = 6;
constexpr double kRiseMmPerS = 100.0;  // rate at which a lowered surface rises back: 50 N/s at 0.5 N/mm
constexpr Duration kLongestStep = std::chrono::milliseconds(10);

bool isFinite(const glm::dvec3& p) RELIEVO_RT {
  constexpr double kFar = 1e6;  // a coordinate beyond this is a bad reading and would overflow an index
  return std::abs(p.x) < kFar && std::abs(p.y) < kFar && std::abs(p.z) < kFar;
}

// How much the surface itself has risen between two contacts.
double riseBetween(const Contact& from, const Contact& to) RELIEVO_RT {
  const double dx = to.x_mm - from.x_mm, dy = to.y_mm - from.y_mm;
  return to.surface.z - from.surface.z -
         0.5 * ((from.surface.zx + to.surface.zx) * dx + (from.surface.zy + to.surface.zy) * dy);
}

bool isWall(const Contact& c) RELIEVO_RT {
  return c.surface.zx * c.surface.zx + c.surface.zy * c.surface.zy > kWallSlope * kWallSlope;
}

}  // namespace

RELIEVO_TICK_CODE glm::dvec3 RelievoMethod::proxy() const RELIEVO_RT {
  return {contact_.x_mm, contact_.y_mm, contact_.surface.z - lowered_mm_};
}

RELIEVO_TICK_CODE bool RelievoMethod::inside(const glm::dvec3& place_mm) RELIEVO_RT {
  return place_mm.z < surface_.height(place_mm.x, place_mm.y) - lowered_mm_;
}

double RelievoMethod::depthMm() RELIEVO_RT {
  return had_surface_ ? surface_.height(hip_mm_.x, hip_mm_.y) - lowered_mm_ - hip_mm_.z : 0;
}

RELIEVO_TICK_CODE Touch RelievoMethod::update(const glm::dvec3& hip_mm, const SurfaceWindow& window,
                                              MediaTime now) RELIEVO_RT {
  if (!surface_.moveTo(window, now)) {
    had_surface_ = false;  // `force_n_` is kept, so that a surface that returns is felt as before
    return {.proxy_mm = hip_mm};
  }
  if (!isFinite(hip_mm)) return {.proxy_mm = hip_mm};  // skip this tick; the next one continues from the last position
  const bool other_scene = isOtherScene(window);
  const Contact before = contact_;
  const bool continues = state_ == State::Contact && !other_scene;
  if (material_.exists() && other_scene) material_.read(window, now, hip_mm.x, hip_mm.y);
  changeState(hip_mm, other_scene);
  if (material_.exists() && state_ == State::Contact && !material_.isNear(now, contact_.x_mm, contact_.y_mm)) {
    material_.read(window, now, contact_.x_mm, contact_.y_mm);
  }
  const Touch touch = touchAt(hip_mm);
  if (lowered_mm_ > 0) settleLowering(hip_mm);
  foresee(hip_mm, before, continues);
  hip_mm_ = hip_mm;
  return touch;
}

// Compares with the previous tick's scene, and stores this tick's.
RELIEVO_TICK_CODE bool RelievoMethod::isOtherScene(const SurfaceWindow& window) RELIEVO_RT {
  const std::uint32_t shot = surface_.shot();
  const bool other = !had_surface_ || window.epoch != epoch_ || shot != shot_;
  had_surface_ = true;
  epoch_ = window.epoch;
  shot_ = shot;
  return other;
}

RELIEVO_TICK_CODE void RelievoMethod::changeState(const glm::dvec3& hip_mm, bool other_scene) RELIEVO_RT {
  if (state_ == State::Unknown) {
    lowered_mm_ = 0;
    state_ = inside(hip_mm) ? State::Buried : State::Free;
  } else if (other_scene && state_ != State::Buried) {
    enterScene(hip_mm);
  } else if (state_ == State::Buried) {
    if (!inside(hip_mm)) state_ = State::Free;
  } else if (state_ == State::Contact) {
    slideAlong(hip_mm);
    follow(proxy(), hip_mm);
  } else {
    follow(hip_mm_, hip_mm);
  }
  if (state_ != State::Contact) carried_.release();
}

// Extrapolates the finger's motion and the surface's rise from the previous tick: a good first guess saves an
// evaluation of the surface.
RELIEVO_TICK_CODE void RelievoMethod::slideAlong(const glm::dvec3& hip_mm) RELIEVO_RT {
  const Contact before = contact_;
  const double sample2 = surface_.sampleMm() * surface_.sampleMm();
  const glm::dvec3 moved = hip_mm - hip_mm_ - glm::dvec3(0, 0, rise_mm_);
  const glm::dvec2 step = predictedStep(contact_, hip_mm_, moved, lowered_mm_);
  contact_.x_mm += step.x;
  contact_.y_mm += step.y;
  // On a wall, a guess of more than one sample may lead over its edge.
  if (isWall(before) && glm::dot(step, step) > sample2) contact_ = before;
  slide(hip_mm, SlideUntil::MuchRead);
  // If a long jump ends further from the finger than staying would have, it has crossed a ridge.
  if (glm::dot(step, step) > 4 * sample2) {
    const glm::dvec3 stayed(before.x_mm, before.y_mm, before.surface.z - lowered_mm_);
    if (glm::distance(proxy(), hip_mm) > glm::distance(stayed, hip_mm) + surface_.sampleMm()) {
      contact_ = before;
      slide(hip_mm, SlideUntil::MuchRead);
    }
  }
  if (carried_.sweptAway(surface_, contact_, hip_mm, lowered_mm_)) {
    contact_.x_mm = hip_mm.x;
    contact_.y_mm = hip_mm.y;
    slide(hip_mm, SlideUntil::MuchRead);
  }
}

RELIEVO_TICK_CODE Touch RelievoMethod::touchAt(const glm::dvec3& hip_mm) RELIEVO_RT {
  Touch touch{.proxy_mm = hip_mm};
  if (state_ == State::Contact) {
    touch.contact = true;
    touch.proxy_mm = spring_.end(surface_, material_.found(), contact_, hip_mm, lowered_mm_);
    touch.force_n = material_.found().stiffness_n_per_mm * (touch.proxy_mm - hip_mm);
  }
  if (!touch.contact) spring_.release();
  if (config_.jump_threshold_n > 0 && glm::distance(touch.force_n, force_n_) > config_.jump_threshold_n) {
    touch = Touch{.proxy_mm = hip_mm};
    state_ = State::Buried;
  }
  force_n_ = touch.force_n;
  return touch;
}

// Predicts where the next tick will evaluate the surface, and how the surface rises there. `before` is the last tick's
// contact if this one continues it.
RELIEVO_TICK_CODE void RelievoMethod::foresee(const glm::dvec3& hip_mm, const Contact& before,
                                              bool continues) RELIEVO_RT {
  const bool sliding = state_ == State::Contact;
  rise_mm_ = sliding && continues ? riseBetween(before, contact_) : 0;
  const glm::dvec2 here = sliding ? glm::dvec2(contact_.x_mm, contact_.y_mm) : glm::dvec2(hip_mm.x, hip_mm.y);
  const glm::dvec2 last = sliding && continues ? glm::dvec2(before.x_mm, before.y_mm)
                          : sliding            ? here
                                               : glm::dvec2(hip_mm_.x, hip_mm_.y);
  ahead_mm_ = 2.0 * here - last;
}

void RelievoMethod::upkeep(const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (!had_surface_) return;
  // Assume the same interval to the next tick as from the last; while paused it is 0.
  const Duration step = std::clamp(now - now_, Duration(0), kLongestStep);
  if (material_.exists()) material_.read(window, now + step, ahead_mm_.x, ahead_mm_.y);
  if (surface_.hasReadAFrame()) {  // the next tick will read the rest
    now_ = now;
    return;
  }
  if (state_ == State::Contact) surface_.prefetchSample(hip_mm_.x, hip_mm_.y);
  const glm::dvec2 here = state_ == State::Contact ? glm::dvec2(contact_.x_mm, contact_.y_mm) : glm::dvec2(hip_mm_);
  const glm::dvec2 mm_per_s = step > Duration(0) ? (ahead_mm_ - here) / toSeconds(step) : glm::dvec2(0);
  surface_.prepare(window, now + step, ahead_mm_.x, ahead_mm_.y, mm_per_s);
  if (offTheEdge(window, now)) {
    state_ = State::Free;
    spring_.release();
    force_n_ = {};
    ahead_mm_ = {hip_mm_.x, hip_mm_.y};
    surface_.prepare(window, now + step, ahead_mm_.x, ahead_mm_.y);
  }
  if (spring_.sticks() && surface_.moveTo(window, now + step)) spring_.prepare(surface_);
  now_ = now;
}

void RelievoMethod::prefetch(const SurfaceWindow& window) const RELIEVO_RT {
  prefetchTickCode();
  relievo::prefetch(&config_, &surface_);
  surface_.prefetch();
  relievo::prefetch(&state_, this + 1);
  relievo::prefetch(&window, &window + 1);
}

// The finger stays in place and the scene has changed.
void RelievoMethod::enterScene(const glm::dvec3& hip_mm) RELIEVO_RT {
  const double depth = surface_.height(hip_mm.x, hip_mm.y) - hip_mm.z;
  force_before_cut_n_ = glm::length(force_n_);
  spring_.release(force_before_cut_n_);  // the point where friction held belongs to the old scene
  lowered_mm_ = std::max(depth - force_before_cut_n_ / material_.found().stiffness_n_per_mm, 0.0);
  if (depth <= 0) {
    state_ = State::Free;
    return;
  }
  contact_.x_mm = hip_mm.x;
  contact_.y_mm = hip_mm.y;
  state_ = State::Contact;
  slide(hip_mm, SlideUntil::MuchRead);
  follow(proxy(), hip_mm);
}

// A finger that left through a wall is off the edge above it, but a hollow in the noise may still hold its proxy up
// there. No ridge separates them if nothing on the path to the finger rises above the proxy by more than the noise that
// the surface passes.
bool RelievoMethod::offTheEdge(const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (state_ != State::Contact || surface_.lowestSample(hip_mm_.x, hip_mm_.y) - lowered_mm_ >= hip_mm_.z) return false;
  if (!surface_.moveTo(window, now)) return false;
  const glm::dvec2 from(contact_.x_mm, contact_.y_mm);
  const glm::dvec2 way(hip_mm_.x - from.x, hip_mm_.y - from.y);
  const double length = glm::length(way);
  const int steps = static_cast<int>(std::min<double>(length / surface_.sampleMm(), kMostSamples + 1));
  if (steps == 0 || steps > kMostSamples || inside(hip_mm_)) return false;
  const double most = contact_.surface.z + config_.scale.clamp_mm;
  for (int k = 1; k <= steps; ++k) {
    const glm::dvec2 place = from + way * (static_cast<double>(k) / (steps + 1));
    if (surface_.height(place.x, place.y) > most) return false;
  }
  return true;
}

RELIEVO_TICK_CODE void RelievoMethod::slide(const glm::dvec3& hip_mm, SlideUntil until) RELIEVO_RT {
  contact_ = closestPoint(surface_, contact_.x_mm, contact_.y_mm, hip_mm, lowered_mm_, until);
}

// Follows the path from a point on or outside the surface to the finger: in contact if the surface lies between.
RELIEVO_TICK_CODE void RelievoMethod::follow(glm::dvec3 from_mm, const glm::dvec3& hip_mm) RELIEVO_RT {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    if (state_ == State::Contact) {
      if (proxy().z > hip_mm.z) return;
      state_ = State::Free;
      spring_.release();
      from_mm = proxy();
    }
    if (!enterOnPath(from_mm, hip_mm)) return;
    state_ = State::Contact;
    slide(hip_mm, SlideUntil::Settled);
  }
  if (proxy().z > hip_mm.z) return;
  // Still entering and leaving after four rounds: the path's end decides.
  state_ = State::Free;
  if (!inside(hip_mm)) return;
  contact_ = {hip_mm.x, hip_mm.y, surface_.at(hip_mm.x, hip_mm.y)};
  state_ = State::Contact;
}

// Sets `contact_` to the first point where the path enters the solid.
bool RelievoMethod::enterOnPath(const glm::dvec3& from_mm, const glm::dvec3& hip_mm) RELIEVO_RT {
  // Splines stay below the volume's front, except for an overshoot of less than half by the fitted one.
  if (std::min(from_mm.z, hip_mm.z) > 1.5 * surface_.volumeDepthMm()) return false;
  const glm::dvec3 way = hip_mm - from_mm;
  const double length = std::sqrt(way.x * way.x + way.y * way.y);
  const int samples = std::clamp(static_cast<int>(std::ceil(length / surface_.sampleMm())), 1, kMostSamples);
  constexpr double kRoundingMm = 1e-6;  // a proxy is on the surface up to rounding
  double outside = 0;
  for (int k = 0; k <= samples; ++k) {
    double in = static_cast<double>(k) / samples;
    const double slack = k == 0 ? kRoundingMm : 0;
    if (!inside(from_mm + way * in + glm::dvec3(0, 0, slack))) {
      outside = in;
      continue;
    }
    for (int i = 0; i < kBisections && k > 0; ++i) {
      const double middle = 0.5 * (outside + in);
      (inside(from_mm + way * middle) ? in : outside) = middle;
    }
    const glm::dvec3 entry = from_mm + way * in;
    contact_ = {entry.x, entry.y, surface_.at(entry.x, entry.y)};
    return true;
  }
  return false;
}

void RelievoMethod::settleLowering(const glm::dvec3& hip_mm) RELIEVO_RT {
  if (state_ == State::Contact) {
    const double rise = kRiseMmPerS * config_.tick_s;
    const double after = glm::length(force_n_) + material_.found().stiffness_n_per_mm * rise;
    if (after <= force_before_cut_n_) lowered_mm_ = std::max(lowered_mm_ - rise, 0.0);
  } else if (state_ == State::Free) {
    // The finger is above the lowered surface, which may rise by that much without being felt.
    lowered_mm_ = std::max(surface_.height(hip_mm.x, hip_mm.y) - hip_mm.z, 0.0);
  }
}

}  // namespace relievo
