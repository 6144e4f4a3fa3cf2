// SPDX-License-Identifier: Apache-2.0
// Uploads force-feedback effects to the device on a separate thread, since an upload may block.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "drivers/gamepad/pad_effects.h"
#include "drivers/gamepad/pad_port.h"
#include "platform/clock.h"
#include "platform/cyclic_thread.h"
#include "platform/histogram.h"
#include "platform/triple_buffer.h"

namespace relievo {

// `start` and `stop` on the owner's thread, `want` and `check` on the real-time one.
class EffectPlayer final : private CyclicTask {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(4);
  static constexpr Duration kWatchdog = std::chrono::milliseconds(20);
  static constexpr Duration kPlayAgain = std::chrono::milliseconds(500);  // an effect ends after kEffectMs
  // While it plays, a rumble gets another level only after this time: a Switch pad's driver sends one in 25 ms and
  // queues eight, and older kernels' may leave the motors on once that queue has overflowed. It begins and ends at
  // once.
  static constexpr Duration kRumbleEvery = std::chrono::milliseconds(32);

  EffectPlayer(PadPort& port, Clock& clock) : port_(port), clock_(clock), thread_(clock) {}

  // Creates the effects at level zero. Without a thread of its own, `want` and `check` send them. Errors: Exhausted,
  // Lost, and the device's own.
  [[nodiscard]] Result<void> start(const PadMotors& motors, bool own_thread);
  // Stops and erases every effect.
  void stop() noexcept;

  // Sets the levels to play. `contact_since`: the time of this contact's first force; read only if `contact`.
  void want(const PadLevels& levels, bool contact, MonotonicTime contact_since, MonotonicTime now) RELIEVO_RT;
  // Once a tick, also without a force. Lost.
  [[nodiscard]] Result<void> check(MonotonicTime now) RELIEVO_RT;

  // From the first force of a contact until the device has taken its effect.
  [[nodiscard]] const Histogram& contactDelays() const noexcept { return contact_delays_; }

 private:
  struct Wanted {
    PadLevels levels;
    MonotonicTime time;
    bool contact = false;
    MonotonicTime contact_since;
  };
  template <class Level>
  struct Slot {
    std::int16_t id = -1;  // not made
    Level in_device;
    bool playing = false;
    MonotonicTime played, changed;
  };

  LoopControl loop(const Cycle& cycle) RELIEVO_RT override;
  void bring(MonotonicTime now) noexcept;
  template <class Level>
  Result<void> make(Slot<Level>& slot);
  template <class Level>
  Result<void> bring(Slot<Level>& slot, const Level& level, MonotonicTime now) noexcept;
  template <class Level>
  void unmake(Slot<Level>& slot) noexcept;

  PadPort& port_;
  Clock& clock_;
  bool own_thread_ = false;
  TripleBuffer<Wanted> wanted_;
  std::atomic<bool> lost_{false};
  Slot<RumbleLevel> rumble_;
  Slot<ConstantLevel> constant_;
  Slot<SpringLevel> spring_;
  MonotonicTime told_contact_;  // start of the contact whose delay was counted last
  Histogram contact_delays_;
  CyclicThread thread_;
};

}  // namespace relievo
