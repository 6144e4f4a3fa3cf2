// SPDX-License-Identifier: Apache-2.0
// Passes the newest value from one writer to one reader without a lock or a copy, by exchanging three slots.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "platform/realtime.h"

namespace relievo {

// The writer fills `back()` and calls `publish()`; the reader calls `refresh()` and reads `front()`. Each slot belongs
// to one side at a time. The WRITER releases what a slot owns (a frame's reference) when it fills the slot again; the
// reader never does, so a real-time reader frees nothing.
template <class T>
class TripleBuffer {
 public:
  // Writer's side.
  [[nodiscard]] T& back() noexcept { return slots_[back_]; }
  void publish() noexcept {
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }

  // Reader's side. True if a newer value was published since the last call.
  bool refresh() RELIEVO_RT {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  [[nodiscard]] const T& front() const RELIEVO_RT { return slots_[front_]; }

 private:
  static constexpr std::uint8_t kFresh = 4;
  static constexpr std::uint8_t kIndex = 3;
  std::array<T, 3> slots_{};
  std::uint8_t back_ = 0;
  std::atomic<std::uint8_t> middle_{1};
  std::uint8_t front_ = 2;
};

}  // namespace relievo
