// SPDX-License-Identifier: Apache-2.0
// The spring between finger and surface: finds its end on a surface with friction, texture and soft places.
#pragma once

#include <glm/vec3.hpp>
#include <limits>

#include "app/haptics/method/closest_point.h"
#include "app/haptics/method/felt_surface.h"
#include "app/haptics/method/place_material.h"
#include "app/haptics/method/ripple.h"
#include "app/haptics/method/stick_point.h"
#include "app/scene/material.h"
#include "platform/realtime.h"

namespace relievo {

// Friction, stiffness and texture change the spring's end in this order (StickPoint, PlaceSpring, Ripple); without them
// it is the closest point.
class FingerSpring {
 public:
  // The whole film's friction and texture, and what the film's material track changes from place to place.
  FingerSpring(const Friction& friction, const Texture& texture, const HeldScale& places, double tick_s) noexcept
      : rubs_(friction.static_coefficient > 0 || places.friction.has_value()),
        ripples_(texture.amplitude_mm > 0 || places.texture.has_value()),
        softens_(places.stiffness_n_per_mm.value_or(0) > 0),
        stick_(tick_s),
        ripple_(places.texture.value_or(texture).wavelength_mm, tick_s) {}

  // Call once in each tick of contact; scene mm. `material` is that at the closest point of the surface, which lies
  // `lowered_mm` below the stored one.
  [[nodiscard]] glm::dvec3 end(FeltSurface& surface, const PlaceMaterial& material, const Contact& closest,
                               const glm::dvec3& hip_mm, double lowered_mm) RELIEVO_RT;
  // Reads the surface where friction holds the finger; `surface` is at the next tick's moment. Only while it `sticks`.
  void prepare(FeltSurface& surface) RELIEVO_RT { stick_.prepare(surface); }
  [[nodiscard]] bool sticks() const RELIEVO_RT { return stick_.holds(); }
  // Call when contact ends, or begins anew with a force of at most `most_n`.
  void release(double most_n = std::numeric_limits<double>::infinity()) RELIEVO_RT;

  // For tests: true while friction drags, and shortly afterwards.
  [[nodiscard]] bool slides() const RELIEVO_RT { return stick_.slides(); }

 private:
  bool rubs_, ripples_, softens_;  // properties that the film's material has
  PlaceSpring place_;
  StickPoint stick_;
  Ripple ripple_;
};

}  // namespace relievo
