// SPDX-License-Identifier: Apache-2.0
// One line of each book per tick.
#include "app/haptics/energy_books.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace relievo {

void EnergyBooks::tick(const glm::dvec3& hip_mm, const glm::dvec3& spring_n, const glm::dvec3& wanted_n,
                       const glm::dvec3& sent_n) RELIEVO_RT {
  if (primed_) {
    const glm::dvec3 moved = hip_mm - hip_;
    // The proxy that the spring's force stands for: h + F/K.
    const glm::dvec3 proxy_moved = moved + (spring_n - spring_) / stiffness_;
    scene_ += 0.5 * glm::dot(spring_ + spring_n, proxy_moved);
    const double artefact = glm::dot(sent_ - 0.5 * (wanted_ + wanted_n), moved);
    artefact_ += artefact;
    open_artefact_ = std::clamp(open_artefact_ + artefact, 0.0, kMostOpenMj);
  }
  hip_ = hip_mm;
  spring_ = spring_n;
  wanted_ = wanted_n;
  sent_ = sent_n;
  primed_ = true;
}

}  // namespace relievo
