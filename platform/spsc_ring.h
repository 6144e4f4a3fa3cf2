// SPDX-License-Identifier: Apache-2.0
// A lock-free queue of fixed size from one thread to another: a full queue rejects a value, it never waits.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <type_traits>

#include "platform/realtime.h"

namespace relievo {

template <class T, std::size_t Capacity>
class SpscRing {
  static_assert(Capacity > 0 && (Capacity & (Capacity - 1)) == 0, "Capacity must be a power of two");
  static_assert(std::is_trivially_copyable_v<T>, "a real-time thread copies T: no constructor may allocate");

 public:
  // Producer's side. False when the ring is full; nothing is stored then.
  [[nodiscard]] bool tryPush(const T& value) RELIEVO_RT {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == Capacity) return false;
    items_[head & (Capacity - 1)] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // Consumer's side. nullopt when the ring is empty.
  [[nodiscard]] std::optional<T> tryPop() RELIEVO_RT {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return std::nullopt;
    const T value = items_[tail & (Capacity - 1)];
    tail_.store(tail + 1, std::memory_order_release);
    return value;
  }

 private:
  std::array<T, Capacity> items_{};
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace relievo
