// SPDX-License-Identifier: Apache-2.0
// A recorded session: the device's position at every tick, and its properties.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "hal/haptic_device.h"
#include "platform/failure.h"

namespace relievo {

struct RecordedTick {
  glm::dvec3 position_mm{0};
  std::uint32_t buttons = 0;
  bool answered = true;  // false: the device did not answer at this tick
};

struct Recording {
  HapticCapabilities capabilities;
  std::vector<RecordedTick> ticks;  // at least one

  // CSV with named columns in any order: device_x_mm, _y_mm, _z_mm, buttons, device_present and, in the first row, the
  // device's workspace, forces, stiffness and rate, as `relievo play --record` writes them. Without a
  // workspace, device millimetres are scene millimetres, whatever the box. Without those columns, hip_x_mm.. or x_mm..
  // in the scene frame, likewise. Otherwise InvalidArgument; the failure names the line.
  [[nodiscard]] static Outcome<Recording> parse(std::string_view csv, const std::string& name);
  // NotFound if the file cannot be read.
  [[nodiscard]] static Outcome<Recording> load(const std::string& path);
};

}  // namespace relievo
