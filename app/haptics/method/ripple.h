// SPDX-License-Identifier: Apache-2.0
// Texture: adds ripples to the surface at the place under the finger.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/scene/material.h"
#include "platform/realtime.h"

namespace relievo {

// A (sin 2 pi x/L + sin 2 pi y/L), added to the surface along its normal; x and y are the finger's, which do not jump
// with the noise of the depth. A finger that moves at v along x feels stiffness x A at v/L. Ripples that pass at more
// than kFlat a tick fade out, and at half a ripple a tick nothing is left, since the device could not follow. A finger
// that has just entered feels none, and no ripple pulls.
//
// The force follows the ripples' height, not their slope, since the slope (2 pi A/L x the force) would be stiffer than
// devices are. Such a force does work: a finger that goes in at a valley and out at a crest would gain energy. So the
// ripples spend only what they have taken since the finger came in, plus kGiftMj, and get smaller where that is not
// enough.
class Ripple {
 public:
  static constexpr double kFlat = 0.35;          // ripples a tick
  static constexpr double kGiftMj = 0.005;       // imperceptible
  static constexpr double kMostOwnMj = 1;        // of what was taken
  static constexpr double kSpeedWithinS = 4e-3;  // averaging time of the speed; devices may answer every other tick

  Ripple(double wavelength_mm, double tick_s) noexcept;

  // The finger in this tick of contact, and what the surface is like there.
  struct Finger {
    glm::dvec3 hip_mm, normal;  // `normal`: the surface's, of length 1
    double depth_mm = 0;        // along it, without the ripples
    double amplitude_mm = 0, stiffness_n_per_mm = 0;
  };
  // The offset to add to the proxy.
  [[nodiscard]] glm::dvec3 offset(const Finger& finger) RELIEVO_RT;
  void release() RELIEVO_RT { feels_ = false; }

 private:
  [[nodiscard]] double heightAt(const glm::dvec3& hip_mm) const RELIEVO_RT;
  [[nodiscard]] double paidFor(double height_mm, double stiffness, double out_mm,
                               const glm::dvec3& moved_mm) RELIEVO_RT;

  double per_mm_;
  double newest_;  // share of the newest tick in the speed
  bool feels_ = false;
  glm::dvec3 hip_mm_{0};
  glm::dvec3 force_n_{0};  // of the last tick
  glm::dvec2 ripples_a_tick_{0};
  double own_mj_ = 0;
};

}  // namespace relievo
