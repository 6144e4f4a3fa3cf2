// SPDX-License-Identifier: Apache-2.0
// One line of each book per tick.
#include "app/haptics/energy_books.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace relievo {

void EnergyBooks::tick(const glm::dvec3& hip_mm, const glm::dvec3& spring_n, const glm::dvec3& sent_n) RELIEVO_RT {
  if (primed_) {
    const glm::dvec3 moved = hip_mm - hip_;
    // The proxy that the spring's force stands for: h + F/K.
    const glm::dvec3 proxy_moved = moved + (spring_n - spring_) / stiffness_;
    const glm::dvec3 mean = 0.5 * (spring_ + spring_n);
    const double artefact = glm::dot(sent_ - mean, moved);
    scene_ += glm::dot(mean, proxy_moved);
    artefact_ += artefact;
    open_artefact_ = std::max(open_artefact_ + artefact, 0.0);
  }
  hip_ = hip_mm;
  spring_ = spring_n;
  sent_ = sent_n;
  primed_ = true;
}

}  // namespace relievo
