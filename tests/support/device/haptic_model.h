// SPDX-License-Identifier: Apache-2.0
// A haptic device in software, behind a USB cable: what a test asks of each, whatever its wire looks like.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "tests/support/device/usb_model.h"

namespace relievo::test {

class HapticModel : public UsbModel {
 public:
  // Where the hand holds it, mm in the driver's frame, `t_s` after the first command since its power came. Its default
  // does what homes it, and then rests in one place.
  std::function<glm::dvec3(double t_s)> grip;
  // Applied to the bytes of every answer.
  std::function<void(std::vector<std::uint8_t>& bytes)> spoil;

  virtual void powerOn() = 0;  // as after its power came back
  virtual void silence() = 0;  // it answers nothing any more
  [[nodiscard]] virtual bool homed() const = 0;
  // What its motors do to a hand at that place, N.
  [[nodiscard]] virtual glm::dvec3 forceAt(const glm::dvec3& place_mm, MonotonicTime now) const = 0;
  [[nodiscard]] virtual bool pushes(MonotonicTime now) const = 0;

  [[nodiscard]] int commands() const { return commands_; }
  [[nodiscard]] int pushingCommands() const { return pushing_; }  // of them, with a force
  [[nodiscard]] glm::dvec3 gripNow(MonotonicTime now) const { return grip(began_ ? toSeconds(now - *began_) : 0.0); }

 protected:
  int commands_ = 0, pushing_ = 0;
  std::optional<MonotonicTime> began_;
};

// By virtual work over differences of a micrometre: the force of these torques, N mm, about angles that `anglesAt`
// tells of a place.
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
