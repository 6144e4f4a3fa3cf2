// SPDX-License-Identifier: Apache-2.0
// A recorded session: where the device was at every tick, and what device it was.
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
  bool answered = true;  // false: the device did not
};

struct Recording {
  HapticCapabilities capabilities;
  std::vector<RecordedTick> ticks;  // one at least

  // CSV by the names of its columns, whatever their order: device_x_mm, _y_mm, _z_mm with buttons, device_present and,
  // in the first row, the device's workspace, forces, stiffness and rate, as `relievo play --record` writes them. Where
  // those are missing, hip_x_mm.. or x_mm.. in the scene frame of the default display depth of 40 mm: the device is
  // then one whose millimetres are the scene's, and that has no end. InvalidArgument otherwise; the failure names the
  // line.
  [[nodiscard]] static Outcome<Recording> parse(std::string_view csv, const std::string& name);
  // NotFound when the file cannot be read.
  [[nodiscard]] static Outcome<Recording> load(const std::string& path);
};

}  // namespace relievo
