// SPDX-License-Identifier: Apache-2.0
// A histogram of durations in fixed memory: 8 buckets per octave, from 1 ns to 17 s, within 6 % of the true value.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>

#include "platform/clock.h"
#include "platform/realtime.h"

namespace relievo {

// One writer (real-time), any number of readers. A reader may see some counts newer than others.
class Histogram {
 public:
  void add(Duration value) RELIEVO_RT {
    const auto ns = static_cast<std::uint64_t>(std::max<Duration::rep>(value.count(), 0));
    bump(counts_[bucketOf(ns)]);
    bump(count_);
    if (ns > max_.load(std::memory_order_relaxed)) max_.store(ns, std::memory_order_relaxed);
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }
  [[nodiscard]] Duration max() const noexcept {
    return Duration(static_cast<Duration::rep>(max_.load(std::memory_order_relaxed)));
  }

  // The middle of the bucket that holds the `fraction` quantile (0.5, 0.99, ..), never above max(); 0 when empty.
  [[nodiscard]] Duration quantile(double fraction) const noexcept {
    std::uint64_t total = 0;
    for (const auto& c : counts_) total += c.load(std::memory_order_relaxed);
    if (total == 0) return Duration(0);
    const double rank = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(total - 1);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      below += counts_[i].load(std::memory_order_relaxed);
      if (static_cast<double>(below) > rank) return std::min(middleOf(i), max());
    }
    return max();
  }

  // Calls `take(middle, count)` for each bucket that is not empty, the shortest first.
  template <class Take>
  void forEachBucket(Take&& take) const {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      if (const std::uint64_t count = counts_[i].load(std::memory_order_relaxed); count > 0) take(middleOf(i), count);
    }
  }

 private:
  static constexpr unsigned kSubBits = 3;
  static constexpr unsigned kSub = 1u << kSubBits;
  static constexpr unsigned kOctaves = 32;
  static constexpr std::size_t kBuckets = kSub * kOctaves;

  static void bump(std::atomic<std::uint64_t>& n) noexcept {
    n.store(n.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  static constexpr std::size_t bucketOf(std::uint64_t ns) noexcept {
    if (ns < kSub) return static_cast<std::size_t>(ns);
    const unsigned top = static_cast<unsigned>(std::bit_width(ns)) - 1;
    const unsigned shift = top - kSubBits;
    const std::size_t bucket = static_cast<std::size_t>(shift + 1) * kSub + ((ns >> shift) & (kSub - 1));
    return std::min(bucket, kBuckets - 1);
  }
  static constexpr Duration middleOf(std::size_t bucket) noexcept {
    if (bucket < kSub) return Duration(static_cast<Duration::rep>(bucket));
    const auto shift = static_cast<unsigned>(bucket / kSub - 1);
    const std::uint64_t low = kSub + bucket % kSub;
    // The harmonic mean of the edges has the same relative error to both, 1/17 at most.
    return Duration(static_cast<Duration::rep>(((2 * low * (low + 1)) << shift) / (2 * low + 1)));
  }

  std::array<std::atomic<std::uint64_t>, kBuckets> counts_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::uint64_t> max_{0};
};

}  // namespace relievo
