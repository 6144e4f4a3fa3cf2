// SPDX-License-Identifier: Apache-2.0
// An effect is uploaded when its level changes, played when it is not silent, and stopped when it is.
#include "drivers/gamepad/effect_player.h"

#include <type_traits>

namespace relievo {
namespace {

constexpr int kPriority = 20;  // of SCHED_FIFO, below the haptic task's

}  // namespace

Result<void> EffectPlayer::start(const PadMotors& motors, bool own_thread) {
  own_thread_ = own_thread;
  lost_ = false;
  told_contact_ = {};
  want({}, false, {}, clock_.now());
  Result<void> made;
  if (motors.constant) made = make(constant_);
  if (made && motors.spring) made = make(spring_);
  if (made && motors.rumble) made = make(rumble_);
  if (made && own_thread) {
    const CyclicConfig config{.name = "relievo-effects", .period = kPeriod, .priority = kPriority};
    if (auto started = thread_.start(config, *this); !started) made = std::unexpected(started.error());
  }
  if (!made) stop();
  return made;
}

void EffectPlayer::stop() noexcept {
  thread_.stop();
  unmake(rumble_);
  unmake(spring_);
  unmake(constant_);
}

void EffectPlayer::want(const PadLevels& levels, bool contact, MonotonicTime contact_since,
                        MonotonicTime now) RELIEVO_RT {
  wanted_.back() = {.levels = levels, .time = now, .contact = contact, .contact_since = contact_since};
  wanted_.publish();
  if (!own_thread_) bring(now);
}

Result<void> EffectPlayer::check(MonotonicTime now) RELIEVO_RT {
  if (!own_thread_) bring(now);
  if (lost_.load(std::memory_order_relaxed)) return fail(ErrorCode::Lost, "the gamepad has gone away");
  return {};
}

LoopControl EffectPlayer::loop(const Cycle& cycle) RELIEVO_RT {
  bring(cycle.woken);
  return LoopControl::Continue;
}

void EffectPlayer::bring(MonotonicTime now) noexcept {
  wanted_.refresh();
  const Wanted& wanted = wanted_.front();
  const PadLevels levels = now - wanted.time > kWatchdog ? PadLevels{} : wanted.levels;
  bool all = true;
  for (const Result<void>& brought : {bring(constant_, levels.constant, now), bring(spring_, levels.spring, now),
                                      bring(rumble_, levels.rumble, now)}) {
    all = all && brought;  // what was not taken is tried again
    if (!brought && brought.error().code == ErrorCode::Lost) lost_.store(true, std::memory_order_relaxed);
  }
  if (!all || !wanted.contact || wanted.contact_since == told_contact_) return;
  told_contact_ = wanted.contact_since;
  contact_delays_.add(clock_.now() - wanted.contact_since);
}

template <class Level>
Result<void> EffectPlayer::make(Slot<Level>& slot) {
  const auto id = port_.upload(effectOf(Level{}));
  if (!id) return std::unexpected(id.error());
  slot = {.id = *id};
  return {};
}

template <class Level>
Result<void> EffectPlayer::bring(Slot<Level>& slot, const Level& level, MonotonicTime now) noexcept {
  if (slot.id < 0) return {};
  if (level == Level{}) {
    if (!slot.playing) return {};
    auto stopped = port_.send(static_cast<std::uint16_t>(slot.id), 0);
    slot.playing = !stopped;
    return stopped;
  }
  constexpr Duration kEvery = std::is_same_v<Level, RumbleLevel> ? kRumbleEvery : Duration(0);
  if (level != slot.in_device && (!slot.playing || now - slot.changed >= kEvery)) {
    ff_effect effect = effectOf(level);
    effect.id = slot.id;
    if (auto taken = port_.upload(effect); !taken) return std::unexpected(taken.error());
    slot.in_device = level;
    slot.changed = now;
  }
  if (slot.playing && now - slot.played < kPlayAgain) return {};
  auto played = port_.send(static_cast<std::uint16_t>(slot.id), 1);
  if (played) {
    slot.playing = true;
    slot.played = now;
  }
  return played;
}

template <class Level>
void EffectPlayer::unmake(Slot<Level>& slot) noexcept {
  if (slot.id < 0) return;
  // Nothing more can be done for a device that is gone.
  (void)port_.send(static_cast<std::uint16_t>(slot.id), 0);
  (void)port_.erase(slot.id);
  slot = {};
}

}  // namespace relievo
