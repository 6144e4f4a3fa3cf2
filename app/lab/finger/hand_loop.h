// SPDX-License-Identifier: Apache-2.0
// A device held by a hand. The device has mass, friction, encoder, amplifier and delay; the hand spring, damper and
// mass.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "hal/device_profile.h"
#include "hal/moving_mass.h"

namespace relievo {

// The device alone, without dry friction and encoder, pushed by a constant force: the case of the theoretical bounds.
[[nodiscard]] DeviceProfile deviceAlone(int delay_ticks);

// Ignores the profile's forces, workspace and jitter: the paths of the methods stay within them.
class HandLoop {
 public:
  HandLoop(const DeviceProfile& profile, const glm::dvec3& position_mm);

  [[nodiscard]] glm::dvec3 encoded() const;  // the position that the device reports
  [[nodiscard]] const glm::dvec3& position() const { return mass_.position_mm; }
  // One tick: `written_n` enters the delay, and the force that leaves it is held; the hand pulls to `target_mm` and
  // adds `push_n`.
  void tick(const glm::dvec3& written_n, const glm::dvec3& target_mm, const glm::dvec3& push_n = glm::dvec3(0));

 private:
  DeviceProfile profile_;
  MovingMass mass_;
  std::array<glm::dvec3, DeviceProfile::kMaxDelayTicks + 1> late_{};  // [0] is the newest force
};

}  // namespace relievo
