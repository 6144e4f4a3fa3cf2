// SPDX-License-Identifier: Apache-2.0
// The interface of a touch method: from the finger's position to the proxy on the surface.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "app/depth_window/surface_window.h"
#include "hal/media/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// The result of a tick. The force is stiffness x (proxy - HIP); without contact it is zero and the proxy equals the
// HIP.
struct Touch {
  glm::dvec3 proxy_mm{0};  // scene frame
  glm::dvec3 force_n{0};
  bool contact = false;
};

// Pure: no clock, no thread, no allocation after construction. Called on the real-time thread once a tick: `prefetch`
// at the start, while the device has not answered; then `update`; then, after the force is sent, `upkeep` with the same
// window and time, for work that can wait.
class TouchMethod {
 public:
  virtual ~TouchMethod() = default;

  // `hip_mm`: the haptic interface point, scene frame. `window`: valid during this call only; its count may be 0.
  // `now`: the film's time. A changed `window.epoch` is a discontinuity that invalidates remembered state.
  [[nodiscard]] virtual Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window,
                                     MediaTime now) RELIEVO_RT = 0;
  // Prefetches the memory that `update` will read, without waiting.
  virtual void prefetch(const SurfaceWindow& /*window*/) const RELIEVO_RT {}
  virtual void upkeep(const SurfaceWindow& /*window*/, MediaTime /*now*/) RELIEVO_RT {}
  // Forgets all state: the finger is free until it has been outside the solid.
  virtual void reset() RELIEVO_RT = 0;
};

}  // namespace relievo
