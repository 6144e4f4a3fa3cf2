// SPDX-License-Identifier: Apache-2.0
// The limits in order: finite, magnitude, slew rate of the scene, energy of the artefacts.
#include "app/haptics/task/safety.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace relievo {

namespace {

// Moves from `from` towards `to` by at most `most`.
glm::dvec3 approach(const glm::dvec3& from, const glm::dvec3& to, double most) RELIEVO_RT {
  const glm::dvec3 change = to - from;
  const double wished = glm::length(change);
  return wished > most ? from + change * (most / wished) : to;
}

// Zero for a force that is not finite.
glm::dvec3 within(double most, const glm::dvec3& force) RELIEVO_RT {
  const double size = glm::length(force);
  if (!std::isfinite(size)) return glm::dvec3(0);
  return size > most ? force * (most / size) : force;
}

}  // namespace

void SafetyFilter::reset() RELIEVO_RT {
  spring_n_ = sent_n_ = lean_n_ = glm::dvec3(0);
  primed_ = false;
  books_.reset();
}

glm::dvec3 SafetyFilter::apply(const glm::dvec3& wanted_n, const glm::dvec3& device_mm, double elapsed_s,
                               const glm::dvec3& edge_n) RELIEVO_RT {
  const glm::dvec3 target = within(limits_.force_n, share() * within(limits_.force_n, wanted_n) + edge_n);

  glm::dvec3 moved = primed_ ? device_mm - last_device_mm_ : glm::dvec3(0);
  if (!std::isfinite(glm::dot(moved, moved))) moved = glm::dvec3(0);

  const double by_hand = stiffness_ * glm::length(moved);
  const double elapsed = elapsed_s > 0 ? std::min(elapsed_s, 0.1) : 0.0;  // NaN becomes 0
  const double allowed = by_hand + limits_.scene_slew_n_per_s * elapsed;
  const glm::dvec3 spring = approach(spring_n_, target, allowed);
  if (limits_.limit_energy) lean(spring, moved, elapsed);
  const glm::dvec3 sent = approach(sent_n_, within(limits_.force_n, spring + lean_n_), allowed);

  const double beyond_hand = std::max(glm::length(sent - sent_n_) - by_hand, 0.0);
  scene_slew_ = elapsed > 0 ? beyond_hand / elapsed : 0.0;
  spring_n_ = spring;
  sent_n_ = sent;
  if (std::isfinite(glm::dot(device_mm, device_mm))) {
    primed_ = true;
    last_device_mm_ = device_mm;
    books_.tick(device_mm, spring, target, sent, elapsed);
    payForLag(target, moved, elapsed);
  }
  return sent;
}

// Only a force that pushes the hand along gives it energy; one that brakes the hand too little does not.
void SafetyFilter::payForLag(const glm::dvec3& wanted_n, const glm::dvec3& moved_mm, double elapsed_s) RELIEVO_RT {
  const double given = std::max(glm::dot(spring_n_, moved_mm), 0.0), due = std::max(glm::dot(wanted_n, moved_mm), 0.0);
  const double left = tank_mj_ - std::max(given - due, 0.0) + limits_.tank_mj_per_s * elapsed_s;
  tank_mj_ = std::clamp(left, -limits_.tank_mj, limits_.tank_mj);
}

double SafetyFilter::share() const RELIEVO_RT {
  return limits_.limit_energy ? std::clamp(2 * tank_mj_ / limits_.tank_mj, 0.0, 1.0) : 1.0;
}

// Assumes that the next movement resembles the last: the same motion, the same change of force.
void SafetyFilter::lean(const glm::dvec3& spring_n, const glm::dvec3& moved_mm, double elapsed_s) RELIEVO_RT {
  // times the last interval between positions, since these may alternate between one tick and two
  constexpr double kOverdue = 2.5;
  since_moved_s_ += elapsed_s;
  const double moved2 = glm::dot(moved_mm, moved_mm);
  if (moved2 <= 0) {
    if (since_moved_s_ > kOverdue * pace_s_) lean_n_ = glm::dvec3(0);
    return;
  }
  pace_s_ = since_moved_s_ > EnergyBooks::kRestS ? elapsed_s : since_moved_s_;
  since_moved_s_ = 0;
  const double coming = 0.5 * glm::dot(spring_n_ - spring_n, moved_mm);
  const double excess = std::max(books_.openArtefactMj() + coming, 0.0);
  lean_n_ = -std::min(excess / moved2, stiffness_) * moved_mm;
}

}  // namespace relievo
