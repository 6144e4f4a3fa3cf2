// SPDX-License-Identifier: Apache-2.0
// A simulated haptic device on a USB cable: the interface that tests use for every kind of device.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "tests/support/device/usb/usb_model.h"

namespace relievo::test {

class HapticModel : public UsbModel {
 public:
  // The hand's position, mm in the driver's frame, `t_s` after the first command since power-on. The default makes the
  // motion that homes the device, and then rests.
  std::function<glm::dvec3(double t_s)> grip;
  // Applied to the bytes of every answer.
  std::function<void(std::vector<std::uint8_t>& bytes)> spoil;

  virtual void powerOn() = 0;  // restarts as after a power failure
  virtual void silence() = 0;  // it stops answering
  [[nodiscard]] virtual bool homed() const = 0;
  // The force of its motors on a hand at that position, N.
  [[nodiscard]] virtual glm::dvec3 forceAt(const glm::dvec3& place_mm, MonotonicTime now) const = 0;
  [[nodiscard]] virtual bool pushes(MonotonicTime now) const = 0;

  [[nodiscard]] int commands() const { return commands_; }
  [[nodiscard]] int pushingCommands() const { return pushing_; }  // commands with a force
  [[nodiscard]] glm::dvec3 gripNow(MonotonicTime now) const { return grip(began_ ? toSeconds(now - *began_) : 0.0); }

 protected:
  int commands_ = 0, pushing_ = 0;
  std::optional<MonotonicTime> began_;
};

// The force of torques, N mm, about the joint angles that `anglesAt` returns for a position, by virtual work over
// differences of 1 um.
template <class AnglesAt>
glm::dvec3 forceOfTorques(const glm::dvec3& torques_nmm, const glm::dvec3& place_mm, const AnglesAt& anglesAt) {
  constexpr double kStepMm = 1e-3;
  glm::dvec3 force{0};
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 before = place_mm, after = place_mm;
    before[axis] -= kStepMm;
    after[axis] += kStepMm;
    const glm::dvec3 turn = anglesAt(after) - anglesAt(before);
    force[axis] = (torques_nmm.x * turn.x + torques_nmm.y * turn.y + torques_nmm.z * turn.z) / (2 * kStepMm);
  }
  return force;
}

}  // namespace relievo::test
