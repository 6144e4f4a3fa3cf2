// SPDX-License-Identifier: Apache-2.0
// Interface of a haptic device: reports the finger's position and applies a force to it.
#pragma once

#include <atomic>
#include <cstdint>
#include <glm/vec3.hpp>

#include "hal/haptic_rate.h"
#include "platform/clock.h"
#include "platform/error.h"
#include "platform/histogram.h"
#include "platform/realtime.h"

namespace relievo {

struct HapticCapabilities {
  const char* name = "";
  glm::dvec3 workspace_min_mm{0};  // in the device frame: x right, y up, z toward the viewer
  glm::dvec3 workspace_max_mm{0};
  double peak_force_n = 0;
  double continuous_force_n = 0;
  double max_stiffness_n_per_mm = 0;  // stable at rate_hz
  double rate_hz = 1000;
  bool in_scene = false;        // its frame is the scene's: it points at the picture
  bool rests_in_pause = false;  // it signals the force by rumble, which would go on while the film is paused
};

struct HapticSample {
  glm::dvec3 position_mm{0};  // device frame
  std::uint32_t buttons = 0;  // bit 0 is the main one
};

// States: Closed -open-> Opened -home-> Ready -start-> Running -stop-> Ready; any -close-> Closed. A device that goes
// away answers Lost and stays in state Lost until closed. A call in a state that does not allow it returns InvalidState
// and changes nothing.
//
// Thread: `open`, `home`, `start`, `stop`, `close` on the owner's thread, never during a `read` or `write`; `read` and
// `write` on the real-time thread; `cancel` on any thread. Blocking: `open` may take seconds, and `home` as long as the
// user takes to move the handle through its range; `read` and `write` never longer than a tick.
// Safety: the force is zero from `open` to the first `write`, after `stop`, `close` and Lost, and when no `write` comes
// within the back end's watchdog time. That holds while the real-time thread hangs and calls nothing: a thread of the
// back end's own, or the device itself, has to watch.
class HapticDevice {
 public:
  enum class State : std::uint8_t { Closed, Opened, Ready, Running, Lost };
  virtual ~HapticDevice() = default;

  // Requests `hz` ticks per second instead of the device's default rate. Returns the rate that `capabilities` reports
  // from then on: `hz`, or the device's highest rate, or its only one. InvalidArgument if not from kLeastRateHz to
  // kMostRateHz; Closed only.
  [[nodiscard]] Result<double> setRate(double hz);
  // NotFound, PermissionDenied, Unsupported, Timeout.
  [[nodiscard]] Result<void> open();
  // Finds the device's zero. Opened or Ready. After a failure the state is Opened, since the zero is then unknown.
  [[nodiscard]] Result<void> home();
  [[nodiscard]] Result<void> start();
  // Once a tick, `read` first. Running only.
  [[nodiscard]] Result<HapticSample> read() RELIEVO_RT;
  // The force on the hand, N, device frame. A value that is not finite or over the peak is rejected
  // (InvalidArgument) and zero is sent instead. Running only.
  [[nodiscard]] Result<void> write(const glm::dvec3& force_n) RELIEVO_RT;
  // Sends zero force, then is Ready. Does nothing unless Running.
  void stop() noexcept;
  void close() noexcept;
  // A running `open` or `home` returns Cancelled within 100 ms; so does each later one until the next `close`.
  void cancel() noexcept { cancelled_ = true; }

  [[nodiscard]] State state() const noexcept { return state_; }
  // Known from `open` on; never changes while open.
  [[nodiscard]] virtual HapticCapabilities capabilities() const noexcept = 0;
  // For a device that sends forces on a thread of its own: a histogram, since construction, of the time from the first
  // `write` of a contact until the device has taken it. Null for others. Any thread.
  [[nodiscard]] virtual const Histogram* contactDelays() const noexcept { return nullptr; }

 protected:
  // For a back end whose `open` or `home` waits.
  [[nodiscard]] const std::atomic<bool>& cancelled() const noexcept { return cancelled_; }
  // For `capabilities`: the rate that `setRate` asked for, but at most `most_hz`; `own_hz` if it did not.
  [[nodiscard]] double rateWithin(double own_hz, double most_hz) const RELIEVO_RT;

 private:
  virtual Result<void> openDevice() = 0;
  virtual Result<void> homeDevice() = 0;
  virtual Result<void> startDevice() = 0;
  virtual Result<HapticSample> readSample() RELIEVO_RT = 0;
  virtual Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT = 0;
  virtual void stopDevice() noexcept = 0;
  virtual void closeDevice() noexcept = 0;

  State state_ = State::Closed;
  double asked_hz_ = 0;  // 0: `setRate` was not called
  std::atomic<bool> cancelled_{false};
};

}  // namespace relievo
