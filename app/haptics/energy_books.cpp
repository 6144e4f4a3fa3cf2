// SPDX-License-Identifier: Apache-2.0
// One line of each book per tick.
#include "app/haptics/energy_books.h"

#include <glm/geometric.hpp>

namespace relievo {

void EnergyBooks::tick(const glm::dvec3& hip_mm, const glm::dvec3& force_n) RELIEVO_RT {
  if (primed_) {
    const glm::dvec3 moved = hip_mm - hip_;
    // The proxy that the sent force stands for: h + F/K.
    const glm::dvec3 proxy_moved = moved + (force_n - force_) / stiffness_;
    const double scene = 0.5 * glm::dot(force_ + force_n, proxy_moved);
    const double held = glm::dot(force_, moved);
    const double smooth = 0.5 * glm::dot(force_ + force_n, moved);
    scene_ += scene;
    artefact_ += held - smooth;
  }
  hip_ = hip_mm;
  force_ = force_n;
  primed_ = true;
}

}  // namespace relievo
