// SPDX-License-Identifier: Apache-2.0
// A missing device may appear within a second: its reason is reported once, and it is tried again.
#include "app/player/touch/device_keeper.h"

#include <cstring>

namespace relievo {

void DeviceKeeper::begin() {
  {
    const std::lock_guard guard(lock_);
    if (phase_ != Phase::Idle) return;
    phase_ = Phase::Trying;
    entered_ = next_try_ = clock_.now();
    homing_told_ = false;
  }
  if (own_thread_) thread_ = std::jthread([this](const std::stop_token& stopping) { run(stopping); });
}

std::optional<DeviceKeeper::News> DeviceKeeper::poll() {
  if (!own_thread_ && phase_ == Phase::Trying && clock_.now() >= next_try_) {
    next_try_ = clock_.now() + kBetweenTries;
    static_cast<void>(bringUp());
  }
  std::unique_lock guard(lock_);
  if (refusal_) {
    const News news{News::Kind::Refused, *refusal_};
    told_refusal_ = refusal_->message;
    refusal_.reset();
    return news;
  }
  if (phase_ == Phase::Homing && !homing_told_ && clock_.now() - entered_ > kPatience) {
    homing_told_ = true;
    return News{News::Kind::Homing, {}};
  }
  if (phase_ != Phase::Ready) return std::nullopt;
  phase_ = Phase::Idle;
  told_refusal_ = nullptr;
  guard.unlock();
  if (thread_.joinable()) thread_.join();
  return News{News::Kind::Ready, {}};
}

void DeviceKeeper::stop() noexcept {
  if (thread_.joinable()) {
    thread_.request_stop();
    device_.cancel();
    thread_.join();
  }
  if (phase_ != Phase::Idle) device_.close();
  phase_ = Phase::Idle;
}

void DeviceKeeper::run(const std::stop_token& stopping) {
  while (!stopping.stop_requested()) {
    if (bringUp()) return;
    std::unique_lock guard(lock_);
    wake_.wait_for(guard, stopping, kBetweenTries, [] { return false; });
  }
}

bool DeviceKeeper::bringUp() {
  enter(Phase::Trying);
  if (auto opened = device_.open(); !opened) {
    refuse(opened.error());
    return false;
  }
  enter(Phase::Homing);
  if (auto homed = device_.home(); !homed) {
    device_.close();
    enter(Phase::Trying);
    refuse(homed.error());
    return false;
  }
  enter(Phase::Ready);
  return true;
}

void DeviceKeeper::enter(Phase phase) {
  const std::lock_guard guard(lock_);
  phase_ = phase;
  entered_ = clock_.now();
}

void DeviceKeeper::refuse(const Error& error) {
  const std::lock_guard guard(lock_);
  if (error.code == ErrorCode::Cancelled) return;
  if (told_refusal_ == nullptr || std::strcmp(told_refusal_, error.message) != 0) refusal_ = error;
}

}  // namespace relievo
