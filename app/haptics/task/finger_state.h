// SPDX-License-Identifier: Apache-2.0
// The finger as the haptic task publishes it every tick: for the picture, the report and a recording.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "hal/media/media_time.h"
#include "platform/clock.h"

namespace relievo {

struct FingerState {
  MonotonicTime time;
  MediaTime media_time;
  MediaTime surface_time;   // of the surface that was felt: earlier where the frames for `media_time` have not come
  glm::dvec3 device_mm{0};  // device frame
  glm::dvec3 hip_mm{0};     // scene frame
  glm::dvec3 proxy_mm{0};   // scene frame
  glm::dvec3 force_n{0};    // on the hand, as sent
  std::uint32_t buttons = 0;
  bool contact = false;
  bool device_present = false;
};

}  // namespace relievo
