// SPDX-License-Identifier: Apache-2.0
// Updates both books once a tick.
#include "app/haptics/task/energy_books.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace relievo {

void EnergyBooks::tick(const glm::dvec3& device_mm, const glm::dvec3& spring_n, const glm::dvec3& wanted_n,
                       const glm::dvec3& sent_n, double elapsed_s) RELIEVO_RT {
  if (primed_) {
    const glm::dvec3 moved = device_mm - last_device_mm_;
    // The proxy implied by the spring's force: h + F/K.
    const glm::dvec3 proxy_moved = moved + (spring_n - spring_) / stiffness_;
    scene_ += 0.5 * glm::dot(spring_ + spring_n, proxy_moved);
    held_impulse_ += sent_ * elapsed_s;
    held_s_ += elapsed_s;
    if (moved != glm::dvec3(0)) {
      const glm::dvec3 held = held_s_ > 0 ? held_impulse_ / held_s_ : sent_;
      const double artefact = glm::dot(held - 0.5 * (wanted_ + wanted_n), moved);
      artefact_ += artefact;
      open_artefact_ = std::clamp(open_artefact_ + artefact, 0.0, kMostOpenMj);
      beginWay(wanted_n);
    } else if (held_s_ > kRestS) {
      beginWay(wanted_n);
    }
  } else {
    beginWay(wanted_n);
  }
  last_device_mm_ = device_mm;
  spring_ = spring_n;
  sent_ = sent_n;
  primed_ = true;
}

void EnergyBooks::beginWay(const glm::dvec3& wanted_n) RELIEVO_RT {
  wanted_ = wanted_n;
  held_impulse_ = glm::dvec3(0);
  held_s_ = 0;
}

}  // namespace relievo
