// SPDX-License-Identifier: Apache-2.0
// Opens and homes a haptic device while the film plays, and retries until it is available.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "hal/haptic_device.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// Owner's thread. With a thread of its own `poll` never waits; without one the device is opened and homed inside it,
// for simulated time. From `begin` until `poll` returns Ready, or `stop`, only this object may use the device.
class DeviceKeeper {
 public:
  static constexpr Duration kBetweenTries = std::chrono::seconds(1);
  static constexpr Duration kPatience = std::chrono::milliseconds(500);  // homing that takes longer is reported

  DeviceKeeper(HapticDevice& device, Clock& clock, bool own_thread) noexcept
      : device_(device), clock_(clock), own_thread_(own_thread) {}
  ~DeviceKeeper() { stop(); }
  DeviceKeeper(const DeviceKeeper&) = delete;
  DeviceKeeper& operator=(const DeviceKeeper&) = delete;

  // The device must be closed. Does nothing while an attempt is running.
  void begin();

  struct News {
    enum class Kind : std::uint8_t {
      Refused,  // not available, and why; returned once for each reason
      Homing,   // waits for the user to move the handle
      Ready,    // homed; returned once
    };
    Kind kind = Kind::Refused;
    Error error;
  };
  [[nodiscard]] std::optional<News> poll();

  // Cancels the attempt. The device is closed unless it was Ready.
  void stop() noexcept;

 private:
  enum class Phase : std::uint8_t { Idle, Trying, Homing, Ready };
  void run(const std::stop_token& stopping);
  [[nodiscard]] bool bringUp();
  void enter(Phase phase);
  void refuse(const Error& error);

  HapticDevice& device_;
  Clock& clock_;
  const bool own_thread_;
  std::jthread thread_;
  MonotonicTime next_try_;  // without a thread

  std::mutex lock_;  // guards everything below
  std::condition_variable_any wake_;
  Phase phase_ = Phase::Idle;
  MonotonicTime entered_;
  bool homing_told_ = false;
  std::optional<Error> refusal_;        // not yet returned
  const char* told_refusal_ = nullptr;  // the last one returned
};

}  // namespace relievo
