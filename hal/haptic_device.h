// SPDX-License-Identifier: Apache-2.0
// Interface of a haptic device: tells where the finger is, and pushes it.
#pragma once

#include <atomic>
#include <cstdint>
#include <glm/vec3.hpp>

#include "platform/clock.h"
#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

struct HapticCapabilities {
  const char* name = "";
  glm::dvec3 workspace_min_mm{0};  // in the device frame: x right, y up, z toward the viewer
  glm::dvec3 workspace_max_mm{0};
  double peak_force_n = 0;
  double continuous_force_n = 0;
  double max_stiffness_n_per_mm = 0;  // that it holds at rate_hz
  double rate_hz = 1000;
};

struct HapticSample {
  glm::dvec3 position_mm{0};  // device frame
  std::uint32_t buttons = 0;  // bit 0 is the main one
};

// States: Closed -open-> Opened -home-> Ready -start-> Running -stop-> Ready; any -close-> Closed. A device that goes
// away answers Lost and is in state Lost until closed. A verb in a state that does not allow it returns InvalidState
// and changes nothing.
//
// Thread: `open`, `home`, `aim`, `start`, `stop`, `close` on the owner's thread while no exchange goes on; `read` and
// `write` on the real-time thread; `cancel` on any thread. Blocking: `open` may take seconds, and `home` as long as the
// user takes to move the handle through its range; `read` and `write` never longer than a tick.
// Safety: the force is zero from `open` to the first `write`, after `stop`, `close` and Lost, and when no `write` comes
// within the back end's watchdog.
class HapticDevice {
 public:
  enum class State : std::uint8_t { Closed, Opened, Ready, Running, Lost };
  virtual ~HapticDevice() = default;

  // NotFound, PermissionDenied, Unsupported, Timeout.
  [[nodiscard]] Result<void> open();
  // Finds the device's zero. Opened or Ready; Opened after a failure, since the zero is not known then.
  [[nodiscard]] Result<void> home();
  // For a device whose hand is computed, and sees nothing: a place of the workspace where there is something to touch.
  // Any other takes no notice. Ready; does nothing in the other states.
  void aim(const glm::dvec3& place_mm) noexcept;
  [[nodiscard]] Result<void> start();
  // Once a tick, `read` first. Running only.
  [[nodiscard]] Result<HapticSample> read() RELIEVO_RT;
  // The force on the hand, N, device frame. A value that is not finite or over the peak is refused
  // (InvalidArgument) and zero is sent in its place. Running only.
  [[nodiscard]] Result<void> write(const glm::dvec3& force_n) RELIEVO_RT;
  // Zero force, then Ready. Running; does nothing in the other states.
  void stop() noexcept;
  void close() noexcept;
  // An `open` or `home` that is under way, or comes before the next `close`, ends within 100 ms and answers Cancelled.
  void cancel() noexcept { cancelled_ = true; }

  [[nodiscard]] State state() const noexcept { return state_; }
  // Known from `open` on; never changes while open.
  [[nodiscard]] virtual HapticCapabilities capabilities() const noexcept = 0;

 protected:
  // For a back end whose `open` or `home` waits.
  [[nodiscard]] const std::atomic<bool>& cancelled() const noexcept { return cancelled_; }

 private:
  virtual Result<void> openDevice() = 0;
  virtual Result<void> homeDevice() = 0;
  virtual void aimHand(const glm::dvec3& /*place_mm*/) noexcept {}
  virtual Result<void> startDevice() = 0;
  virtual Result<HapticSample> readSample() RELIEVO_RT = 0;
  virtual Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT = 0;
  virtual void stopDevice() noexcept = 0;
  virtual void closeDevice() noexcept = 0;

  State state_ = State::Closed;
  std::atomic<bool> cancelled_{false};
};

}  // namespace relievo
