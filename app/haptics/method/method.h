// SPDX-License-Identifier: Apache-2.0
// Interface of a method of touch: from the finger's position to the proxy that is held on the surface.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "app/depth_window/surface_window.h"
#include "hal/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// What a method answers. The force is stiffness x (proxy - HIP); it is zero without contact, where the proxy is the
// HIP.
struct Touch {
  glm::dvec3 proxy_mm{0};  // scene frame
  glm::dvec3 force_n{0};
  bool contact = false;
};

// Pure: no clock, no thread, no allocation after construction. Called on the real-time thread, once a tick: `update`
// first; `upkeep` when the force is out, with the same window and time, for whatever can wait. Before both, when the
// tick begins and the device has not answered yet, `prefetch`.
class TouchMethod {
 public:
  virtual ~TouchMethod() = default;

  // `hip_mm`: the haptic interface point in the scene frame. `window`: valid for this call only, count may be 0.
  // `now`: the film's time. A change of `window.epoch` is a discontinuity: what was remembered does not hold any more.
  [[nodiscard]] virtual Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window,
                                     MediaTime now) RELIEVO_RT = 0;
  // Asks for the memory that `update` will look at, and waits for none of it.
  virtual void prefetch(const SurfaceWindow& /*window*/) const RELIEVO_RT {}
  virtual void upkeep(const SurfaceWindow& /*window*/, MediaTime /*now*/) RELIEVO_RT {}
  // Forgets everything: the finger is free until it has been outside.
  virtual void reset() RELIEVO_RT = 0;
};

}  // namespace relievo
