// SPDX-License-Identifier: Apache-2.0
// Brings a haptic device up beside the film: opens and homes it, again and again until it is there.
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
// for simulated time. From `begin` until `poll` says Ready, or `stop`, the device is this object's alone.
class DeviceKeeper {
 public:
  static constexpr Duration kBetweenTries = std::chrono::seconds(1);
  static constexpr Duration kPatience = std::chrono::milliseconds(500);  // until homing is worth a word

  DeviceKeeper(HapticDevice& device, Clock& clock, bool own_thread) noexcept
      : device_(device), clock_(clock), own_thread_(own_thread) {}
  ~DeviceKeeper() { stop(); }
  DeviceKeeper(const DeviceKeeper&) = delete;
  DeviceKeeper& operator=(const DeviceKeeper&) = delete;

  // The device is closed then. Does nothing while it is at it.
  void begin();

  struct News {
    enum class Kind : std::uint8_t {
      Refused,  // not to be had, and why; told once for each reason
      Homing,   // it waits for the user to move its handle
      Ready,    // it is homed; told once
    };
    Kind kind = Kind::Refused;
    Error error;
  };
  [[nodiscard]] std::optional<News> poll();

  // Calls off what is under way. The device is closed unless it was Ready.
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

  std::mutex lock_;  // of all that follows
  std::condition_variable_any wake_;
  Phase phase_ = Phase::Idle;
  MonotonicTime entered_;
  bool homing_told_ = false;
  std::optional<Error> refusal_;        // not yet told
  const char* told_refusal_ = nullptr;  // the last one told
};

}  // namespace relievo
