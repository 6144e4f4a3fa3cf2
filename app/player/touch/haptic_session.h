// SPDX-License-Identifier: Apache-2.0
// Owns the haptic side of a film: the device's state, fixed memory, and the real-time thread.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/depth_window/look_ahead.h"
#include "app/depth_window/surface_feeder.h"
#include "app/haptics/task/haptic_task.h"
#include "app/player/touch/device_keeper.h"
#include "app/scene/display_volume.h"
#include "app/scene/material.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"
#include "platform/cyclic_thread.h"
#include "platform/error.h"
#include "platform/memory/fixed_memory.h"

namespace relievo {

// What runs the ticks: a thread of its own, or `tickByHand`, for simulated time.
enum class Ticking : std::uint8_t { Thread, ByHand };

// The haptic side's results for the report. All zero if it never ran.
struct HapticSummary {
  std::string device;     // "" without one
  std::string plan;       // the parts of the method chosen for this film, and why
  std::string scheduler;  // "SCHED_FIFO", "SCHED_OTHER", "simulated time", "none"
  bool memory_locked = false;
  double rate_hz = 0;
  std::uint64_t ticks = 0, contact_ticks = 0;
  std::uint64_t overruns = 0, allocations = 0, page_faults = 0;
  struct Times {
    std::int64_t p50 = 0, p99 = 0, p999 = 0, max = 0;  // ns
  } update, wakeup;
  std::optional<Times>
      contact_told;  // from a contact's first force until the device has taken it (HapticDevice::contactDelays)
  struct Bucket {
    std::int64_t ns = 0;
    std::uint64_t ticks = 0;
  };
  std::vector<Bucket> wakeup_histogram;  // within 6 %, the shortest first
  // Memory reserved for the ticks: the task with its rings, the method, the thread's stack, its counters. Without code
  // and the film's pictures, which the player needs anyway.
  struct Memory {
    std::size_t task = 0, method = 0, stack = 0, counters = 0;
    std::size_t stack_used = 0;  // of the stack, at most, in a run that has ended
  } memory;
  double max_force_n = 0, max_scene_slew_n_per_s = 0;
  double scene_mj = 0, artefact_mj = 0;
};

// Owner's thread only. A missing or lost device is looked for every second while the film plays.
class HapticSession {
 public:
  // `device` is borrowed and may be null: then no call does anything.
  HapticSession(HapticDevice* device, Clock& clock, Ticking ticking) noexcept;
  ~HapticSession();
  HapticSession(const HapticSession&) = delete;
  HapticSession& operator=(const HapticSession&) = delete;

  // Begins to open and home the device.
  void begin();
  // The result of that: why the device is refused, that it waits for the user, or that it is `waiting` to be started.
  [[nodiscard]] std::optional<DeviceKeeper::News> poll();
  // True if it is opened and homed, and not started.
  [[nodiscard]] bool waiting() const noexcept { return opened_ && !running_; }
  // Creates the task for this volume, material and look-ahead in locked memory, or reuses the one left by a lost device
  // or the last film; gives it the first window and starts it. The force begins at zero. InvalidState unless `waiting`.
  // After a failure the device is looked for anew.
  // `material_scale`: of the film's material track, empty if it has none.
  [[nodiscard]] Result<void> start(const DisplayVolume& volume, const Material& material,
                                   const Material& material_scale, const LookAhead& ahead, const SurfaceFeeder& first);
  // Between two films: zero force, and no ticks; the device stays homed. The next `start` may be for another scene.
  void rest() noexcept;
  // Sets the force to zero, then stops the thread and the device. May be called at any time.
  void stop() noexcept;

  [[nodiscard]] bool running() const noexcept { return running_; }
  // The capabilities of the device that was ready last.
  [[nodiscard]] const HapticCapabilities& capabilities() const noexcept { return capabilities_; }
  // Limitations that it started with: memory that is not locked, an ordinary scheduler. Null if there are none.
  [[nodiscard]] const char* missingMemory() const noexcept { return missing_memory_; }
  [[nodiscard]] const char* missingScheduler() const noexcept { return missing_scheduler_; }
  // The parts of the film's material that exceed the device, in words; empty if it can render all.
  [[nodiscard]] const std::string& reducedMaterial() const noexcept { return reduced_material_; }

  void publish(const SurfaceFeeder& surface) noexcept;
  // Null until the first tick, and without a device.
  [[nodiscard]] const FingerState* finger() noexcept;
  [[nodiscard]] std::optional<FingerState> nextTick() noexcept;
  // After DeviceLost the device has been closed and is looked for.
  [[nodiscard]] std::optional<HapticFault> nextFault();
  // Prints the real-time side's messages since the last call.
  void printLog() noexcept;

  // ByHand: when the next tick is due; MonotonicTime::max() if none is.
  [[nodiscard]] MonotonicTime nextTickByHand() const noexcept;
  // Sleeps until the next tick and runs it.
  void tickByHand() noexcept;

  [[nodiscard]] HapticSummary summary() const;

 private:
  [[nodiscard]] Result<void> setScene(const DisplayVolume& volume, const Material& material,
                                      const Material& material_scale, const LookAhead& ahead,
                                      const SurfaceWindow& first);
  [[nodiscard]] Result<void> run();
  void halt() noexcept;

  HapticDevice* device_;
  Clock& clock_;
  const Ticking ticking_;
  bool opened_ = false;
  bool running_ = false;
  bool memory_locked_ = false;
  const char* missing_memory_ = nullptr;
  const char* missing_scheduler_ = nullptr;
  HapticCapabilities capabilities_;
  Duration period_{0};
  std::optional<DeviceKeeper> keeper_;

  std::string plan_, reduced_material_;
  std::unique_ptr<TouchMethod> method_;
  std::optional<FixedArena> arena_;
  HapticTask* task_ = nullptr;  // in the arena
  bool new_scene_ = true;
  CyclicThread thread_;
  MonotonicTime next_tick_;  // for ByHand
  std::uint64_t tick_index_ = 0;
};

}  // namespace relievo
