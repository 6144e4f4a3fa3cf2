// SPDX-License-Identifier: Apache-2.0
// The single-producer ring: first in, first out, and a full one refuses.
#include "platform/spsc_ring.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace relievo {
namespace {

TEST(SpscRing, IsEmptyAtFirst) {
  SpscRing<int, 4> ring;
  EXPECT_EQ(ring.tryPop(), std::nullopt);
}

TEST(SpscRing, RefusesWhatDoesNotFitAndKeepsWhatDid) {
  SpscRing<int, 4> ring;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.tryPush(i));
  EXPECT_FALSE(ring.tryPush(4));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(ring.tryPop(), i);
  EXPECT_EQ(ring.tryPop(), std::nullopt);
}

TEST(SpscRing, TakesOneMoreForEachThatWasTaken) {
  SpscRing<int, 2> ring;
  EXPECT_TRUE(ring.tryPush(1));
  EXPECT_TRUE(ring.tryPush(2));
  EXPECT_EQ(ring.tryPop(), 1);
  EXPECT_TRUE(ring.tryPush(3));
  EXPECT_FALSE(ring.tryPush(4));
  EXPECT_EQ(ring.tryPop(), 2);
  EXPECT_EQ(ring.tryPop(), 3);
}

TEST(SpscRing, KeepsTheOrderOverManyTurns) {
  SpscRing<int, 8> ring;
  int pushed = 0;
  int popped = 0;
  for (int turn = 0; turn < 1000; ++turn) {  // five per turn: the indices wrap at every position
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(ring.tryPush(pushed++));
    for (int i = 0; i < 5; ++i) ASSERT_EQ(ring.tryPop(), popped++);
  }
  EXPECT_EQ(ring.tryPop(), std::nullopt);
}

TEST(SpscRing, LosesTearsAndReordersNothingBetweenTwoThreads) {
  constexpr std::uint64_t kValues = 200'000;
  using Value = std::array<std::uint64_t, 16>;
  SpscRing<Value, 16> ring;
  std::thread producer([&] {
    for (std::uint64_t n = 0; n < kValues; ++n) {
      Value value;
      value.fill(n);
      while (!ring.tryPush(value)) std::this_thread::yield();
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < kValues;) {
    const auto value = ring.tryPop();
    if (!value) {
      std::this_thread::yield();
      continue;
    }
    for (const std::uint64_t word : *value) wrong += word != n;
    ++n;
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(ring.tryPop(), std::nullopt);
}

}  // namespace
}  // namespace relievo
