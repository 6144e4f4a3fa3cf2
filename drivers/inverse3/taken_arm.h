// SPDX-License-Identifier: Apache-2.0
// The arms that this process pushes: two fingers may reach one arm by two names of its service.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>

#include "drivers/inverse3/snapshot.h"

namespace relievo::inverse3 {

// Holds at most one arm, for one finger. `take` and `letGo` on any thread.
class TakenArm {
 public:
  TakenArm() = default;
  ~TakenArm() { letGo(); }
  TakenArm(const TakenArm&) = delete;
  TakenArm& operator=(const TakenArm&) = delete;

  // False if another finger has it.
  [[nodiscard]] bool take(const DeviceId& arm) {
    letGo();
    const std::lock_guard guard(lock_);
    const auto has = [](std::string_view name) {
      return std::ranges::find(taken_, name, [](const DeviceId& each) { return each.text(); });
    };
    const auto place = has("");
    if (has(arm.text()) != taken_.end() || place == taken_.end()) return false;
    *place = arm;
    arm_ = &*place;
    ++count_;
    return true;
  }
  void letGo() noexcept {
    const std::lock_guard guard(lock_);
    if (arm_ == nullptr) return;
    *arm_ = {};
    arm_ = nullptr;
    --count_;
  }
  // Whether another finger has an arm as well.
  [[nodiscard]] static bool several() RELIEVO_RT { return count_.load(std::memory_order_relaxed) > 1; }

 private:
  static inline std::mutex lock_;
  static inline std::array<DeviceId, 8> taken_;
  static inline std::atomic<int> count_ = 0;  // of `taken_`
  DeviceId* arm_ = nullptr;                   // in `taken_`
};

}  // namespace relievo::inverse3
