// SPDX-License-Identifier: Apache-2.0
// The real-time task: finger position in, force out, once a tick. Its only side effect is the exchange with the device.
#pragma once

#include <atomic>
#include <cstdint>

#include "app/depth_window/surface_window.h"
#include "app/haptics/method/method.h"
#include "app/haptics/task/finger_state.h"
#include "app/haptics/task/safety.h"
#include "app/haptics/task/workspace_mapping.h"
#include "app/scene/display_volume.h"
#include "hal/haptic_device.h"
#include "platform/cyclic_thread.h"
#include "platform/log.h"
#include "platform/spsc_ring.h"
#include "platform/triple_buffer.h"

namespace relievo {

struct HapticFault {
  enum class Kind : std::uint8_t {
    DeviceLost,   // read or write returned Lost: zero force, and no device access until `deviceIsBack`
    DeviceError,  // one exchange failed: this tick is skipped
    FeedStale,    // no depth for the present moment: the force fades
    FeedRecovered,
  };
  Kind kind = Kind::DeviceError;
  MonotonicTime time;
};
[[nodiscard]] const char* name(HapticFault::Kind kind) noexcept;

// Written by the task; readable from any thread.
struct HapticCounters {
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<std::uint64_t> contact_ticks{0};
  std::atomic<double> max_force_n{0};
  std::atomic<double> max_scene_slew_n_per_s{0};
  std::atomic<double> scene_energy_mj{0};     // given to the hand by the surface's own motion
  std::atomic<double> artefact_energy_mj{0};  // given to the hand by sampling
  Histogram update;                           // time of the method and the limits, from position to force
};

class HapticTask final : public CyclicTask {
 public:
  // Everything is borrowed and must outlive the task. `clock` is only used to time `counters().update`.
  // `stiffness_n_per_mm` is the method's, in the scene; the device renders the mapping's scale times that.
  HapticTask(HapticDevice& device, TouchMethod& method, const Clock& clock, const DisplayVolume& volume,
             const SafetyLimits& limits, double stiffness_n_per_mm) noexcept;

  LoopControl loop(const Cycle& cycle) RELIEVO_RT override;

  // Call after a lost device has returned, while no tick runs; the force begins at zero.
  void deviceIsBack() noexcept { device_lost_ = false; }
  // Switches to another film with its own volume and method, while no tick runs; the force begins at zero.
  void changeScene(TouchMethod& method, const DisplayVolume& volume, const SafetyLimits& limits,
                   double stiffness_n_per_mm) noexcept;

  // For the feeder's thread: fill the whole window, then publish it. A window's previous contents are released when it
  // is filled again (see TripleBuffer).
  [[nodiscard]] SurfaceWindow& windowToFill() noexcept { return windows_.back(); }
  void publishWindow() noexcept { windows_.publish(); }
  // Releases the frames of all windows, while no tick runs.
  void forgetWindows() noexcept;

  // For the picture's thread: fetches the newest state; true if it is newer than the last one.
  [[nodiscard]] bool refreshFinger() noexcept { return finger_.refresh(); }
  [[nodiscard]] const FingerState& finger() const noexcept { return finger_.front(); }

  // For the recorder's thread: every tick in order; nullopt when caught up. A reader that falls 4096 ticks behind,
  // 4 s at 1 kHz and half a second at 8, loses ticks but not timestamps.
  [[nodiscard]] std::optional<FingerState> nextTick() noexcept { return ticks_.tryPop(); }
  // At most 64 that are unread are kept, and the loss of the device in any case.
  [[nodiscard]] std::optional<HapticFault> nextFault() noexcept;

  // For the thread that prints: the task's messages since the last call, in the area "haptic".
  void printLog() noexcept { log_.drain(); }

  [[nodiscard]] const HapticCounters& counters() const noexcept { return counters_; }

 private:
  void noteLate(const Cycle& cycle) RELIEVO_RT;
  void failed(const Error& error, MonotonicTime time) RELIEVO_RT;
  void noteFeed(bool stale, MonotonicTime time) RELIEVO_RT;
  void count(const FingerState& state) RELIEVO_RT;
  void publish(const FingerState& state) RELIEVO_RT;
  void report(HapticFault::Kind kind, MonotonicTime time) RELIEVO_RT;

  HapticDevice& device_;
  TouchMethod* method_;
  const Clock& clock_;
  WorkspaceMapping mapping_;
  SafetyFilter safety_;
  double scenes_before_mj_ = 0, artefacts_before_mj_ = 0;  // sums over earlier scenes
  bool rests_in_pause_ = false;                            // of the device
  bool stale_ = false;
  bool device_lost_ = false;
  bool primed_ = false;  // a previous tick exists
  MonotonicTime last_woken_;
  std::uint64_t next_index_ = 0;
  TripleBuffer<SurfaceWindow> windows_;
  TripleBuffer<FingerState> finger_;
  SpscRing<FingerState, 4096> ticks_;
  SpscRing<HapticFault, 64> faults_;
  HapticFault loss_;                     // of the device, if there was no room for it among the faults
  std::atomic<bool> loss_kept_ = false;  // `loss_` waits to be read
  RingLog log_{"haptic"};
  HapticCounters counters_;
};

}  // namespace relievo
