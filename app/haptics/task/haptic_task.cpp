// SPDX-License-Identifier: Apache-2.0
// One tick: read the device, compute the touch, limit the force, write it; then do the work that can wait.
#include "app/haptics/task/haptic_task.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace relievo {
namespace {

// How long the surface may run past its newest frame before the feed counts as stale: one and a half times the last
// period, and at least this, so that a late frame of a slow film is not taken for a loss. A surface that is carried
// forward in time runs that much behind the film.
constexpr Duration kLeastGrace = std::chrono::milliseconds(50);

bool isStale(const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (window.count == 0 || window.ended || window.clock.rate == 0) return false;
  const auto newest = static_cast<std::size_t>(window.count - 1);
  Duration grace = kLeastGrace;
  if (newest > 0) grace = std::max(grace, 3 * (window.frames[newest].time - window.frames[newest - 1].time) / 2);
  return now - window.carried > window.frames[newest].time + grace;
}

void raise(std::atomic<double>& highest, double value) RELIEVO_RT {
  if (value > highest.load(std::memory_order_relaxed)) highest.store(value, std::memory_order_relaxed);
}

void bump(std::atomic<std::uint64_t>& count) RELIEVO_RT {
  count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

const char* name(HapticFault::Kind kind) noexcept {
  switch (kind) {
    case HapticFault::Kind::DeviceLost:
      return "haptic device lost";
    case HapticFault::Kind::DeviceError:
      return "haptic exchange failed";
    case HapticFault::Kind::FeedStale:
      return "depth delayed";
    case HapticFault::Kind::FeedRecovered:
      return "depth back";
  }
  return "";
}

HapticTask::HapticTask(HapticDevice& device, TouchMethod& method, const Clock& clock, const DisplayVolume& volume,
                       const SafetyLimits& limits, double stiffness_n_per_mm) noexcept
    : device_(device), method_(&method), clock_(clock), mapping_(device.capabilities(), volume) {
  changeScene(method, volume, limits, stiffness_n_per_mm);
}

void HapticTask::changeScene(TouchMethod& method, const DisplayVolume& volume, const SafetyLimits& limits,
                             double stiffness_n_per_mm) noexcept {
  method_ = &method;
  mapping_ = WorkspaceMapping(device_.capabilities(), volume);
  SafetyLimits within_device = limits;
  rests_in_pause_ = device_.capabilities().rests_in_pause;
  within_device.force_n = std::min(limits.force_n, device_.capabilities().peak_force_n);
  scenes_before_mj_ += safety_.books().sceneMj();
  artefacts_before_mj_ += safety_.books().artefactMj();
  safety_ = SafetyFilter(within_device, stiffness_n_per_mm * mapping_.scale());
  device_lost_ = false;
  primed_ = false;
  stale_ = false;
}

void HapticTask::forgetWindows() noexcept {
  for (int slot = 0; slot < 3; ++slot) {
    windows_.back() = {};
    windows_.publish();
    windows_.refresh();
  }
}

LoopControl HapticTask::loop(const Cycle& cycle) RELIEVO_RT {
  bump(counters_.ticks);
  noteLate(cycle);
  FingerState state;
  state.time = cycle.woken;
  if (device_lost_) {
    publish(state);
    return LoopControl::Continue;
  }
  method_->prefetch(windows_.front());
  const auto sample = device_.read();
  if (!sample) {
    failed(sample.error(), cycle.woken);
    publish(state);
    return LoopControl::Continue;
  }

  const MonotonicTime started = clock_.now();
  windows_.refresh();
  const SurfaceWindow& window = windows_.front();
  state.device_present = true;
  state.device_mm = sample->position_mm;
  state.buttons = sample->buttons;
  const WorkspaceMapping::Finger finger = mapping_.follow(*sample);
  state.hip_mm = finger.hip_mm;
  state.media_time = state.surface_time = window.clock.at(cycle.woken);
  if (window.count > 0) {
    const MediaTime newest = window.frames[static_cast<std::size_t>(window.count - 1)].time + window.carried;
    state.surface_time = std::min(state.surface_time, newest);
  }
  const Touch touch = method_->update(state.hip_mm, window, state.media_time);
  noteFeed(isStale(window, state.media_time), cycle.woken);
  const double elapsed = primed_ ? toSeconds(cycle.woken - last_woken_) : 0.0;
  // Limits and energies apply to the hand, in the device's frame.
  const bool rests = rests_in_pause_ && window.clock.rate == 0;
  const bool felt = !stale_ && !finger.clutched && !rests;
  const glm::dvec3 wanted = felt ? touch.force_n : glm::dvec3(0);
  state.force_n = safety_.apply(wanted, sample->position_mm, elapsed, finger.edge_force_n);
  state.proxy_mm = touch.proxy_mm;
  state.contact = touch.contact;
  counters_.update.add(clock_.now() - started);

  primed_ = true;
  last_woken_ = cycle.woken;
  if (const auto written = device_.write(state.force_n); !written) failed(written.error(), cycle.woken);

  method_->upkeep(window, state.media_time);
  count(state);
  publish(state);
  return LoopControl::Continue;
}

void HapticTask::noteLate(const Cycle& cycle) RELIEVO_RT {
  if (cycle.index > next_index_ && next_index_ > 0) {
    log_.push({.level = LogLevel::Debug,
               .text = "missed ticks, and the us by which the next tick woke late:",
               .a = static_cast<double>(cycle.index - next_index_),
               .b = 1e6 * toSeconds(cycle.woken - cycle.scheduled)});
  }
  next_index_ = cycle.index + 1;
}

// A device that is lost sets its own force to zero (see HapticDevice). The task forgets its held force, so that the
// force of a device that returns fades in from zero.
void HapticTask::failed(const Error& error, MonotonicTime time) RELIEVO_RT {
  const bool lost = error.code == ErrorCode::Lost;
  log_.push({.level = lost ? LogLevel::Info : LogLevel::Debug, .text = error.message});
  report(lost ? HapticFault::Kind::DeviceLost : HapticFault::Kind::DeviceError, time);
  if (!lost) return;
  device_lost_ = true;
  primed_ = false;
  safety_.reset();
  method_->reset();
}

void HapticTask::noteFeed(bool stale, MonotonicTime time) RELIEVO_RT {
  if (stale == stale_) return;
  stale_ = stale;
  report(stale ? HapticFault::Kind::FeedStale : HapticFault::Kind::FeedRecovered, time);
}

void HapticTask::count(const FingerState& state) RELIEVO_RT {
  if (state.contact) bump(counters_.contact_ticks);
  raise(counters_.max_force_n, glm::length(state.force_n));
  raise(counters_.max_scene_slew_n_per_s, safety_.sceneSlew());
  counters_.scene_energy_mj.store(scenes_before_mj_ + safety_.books().sceneMj(), std::memory_order_relaxed);
  counters_.artefact_energy_mj.store(artefacts_before_mj_ + safety_.books().artefactMj(), std::memory_order_relaxed);
}

void HapticTask::publish(const FingerState& state) RELIEVO_RT {
  finger_.back() = state;
  finger_.publish();
  static_cast<void>(ticks_.tryPush(state));  // without a reader, or with a late one, the newest tick is dropped
}

void HapticTask::report(HapticFault::Kind kind, MonotonicTime time) RELIEVO_RT {
  if (faults_.tryPush({kind, time}) || kind != HapticFault::Kind::DeviceLost) return;
  loss_ = {kind, time};
  loss_kept_.store(true, std::memory_order_release);
}

std::optional<HapticFault> HapticTask::nextFault() noexcept {
  if (const auto fault = faults_.tryPop()) return fault;
  if (!loss_kept_.exchange(false, std::memory_order_acquire)) return std::nullopt;
  return loss_;
}

}  // namespace relievo
