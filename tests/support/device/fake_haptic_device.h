// SPDX-License-Identifier: Apache-2.0
// A minimal haptic device: its position is set by the test, it remembers the force, and fails on request.
#pragma once

#include <utility>

#include "hal/haptic_device.h"

namespace relievo::test {

class FakeHapticDevice final : public HapticDevice {
 public:
  glm::dvec3 position{0, 0, 0};
  glm::dvec3 force{0};
  std::uint32_t buttons = 5;
  ErrorCode next_error = ErrorCode::InvalidState;  // of one reading; InvalidState: none
  ErrorCode next_write_error = ErrorCode::InvalidState;
  int reads = 0, writes = 0;
  bool rests_in_pause = false;

  HapticCapabilities capabilities() const noexcept override {
    return {"fake", glm::dvec3(-100, -100, -50), glm::dvec3(100, 100, 50), 4.0, 2.0, 1.0, 1000, false, rests_in_pause};
  }

 private:
  Result<void> openDevice() override { return {}; }
  Result<void> homeDevice() override { return {}; }
  Result<void> startDevice() override { return {}; }
  Result<HapticSample> readSample() RELIEVO_RT override {
    ++reads;
    if (next_error != ErrorCode::InvalidState) return failOnce(next_error);
    return HapticSample{position, buttons};
  }
  Result<void> writeForce(const glm::dvec3& f) RELIEVO_RT override {
    if (next_write_error != ErrorCode::InvalidState) return failOnce(next_write_error);
    force = f;
    ++writes;
    return {};
  }
  void stopDevice() noexcept override { force = glm::dvec3(0); }
  void closeDevice() noexcept override {}
  static std::unexpected<Error> failOnce(ErrorCode& next) RELIEVO_RT {
    return fail(std::exchange(next, ErrorCode::InvalidState), "as asked");
  }
};

}  // namespace relievo::test
