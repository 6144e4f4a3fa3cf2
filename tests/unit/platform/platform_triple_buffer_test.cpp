// SPDX-License-Identifier: Apache-2.0
// The triple buffer: the newest value wins, none is torn, and only the writer releases what a slot owns.
#include "platform/triple_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>
#include <utility>

namespace relievo {
namespace {

TEST(TripleBuffer, HasNothingNewBeforeTheFirstPublish) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 0);
}

TEST(TripleBuffer, HandsValuesOnInOrder) {
  TripleBuffer<int> buffer;
  for (int value = 1; value <= 10; ++value) {
    buffer.back() = value;
    buffer.publish();
    EXPECT_TRUE(buffer.refresh());
    EXPECT_EQ(buffer.front(), value);
    EXPECT_FALSE(buffer.refresh()) << "the same value twice";
    EXPECT_EQ(buffer.front(), value);
  }
}

TEST(TripleBuffer, GivesTheNewestOfSeveral) {
  TripleBuffer<int> buffer;
  for (int value = 1; value <= 7; ++value) {
    buffer.back() = value;
    buffer.publish();
  }
  EXPECT_TRUE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 7);
  EXPECT_FALSE(buffer.refresh());
}

TEST(TripleBuffer, LeavesTheReadersSlotAloneWhileTheWriterGoesOn) {
  TripleBuffer<int> buffer;
  buffer.back() = 1;
  buffer.publish();
  ASSERT_TRUE(buffer.refresh());
  const int* const held = &buffer.front();
  for (int value = 2; value <= 9; ++value) {
    EXPECT_NE(&buffer.back(), held);
    buffer.back() = value;
    buffer.publish();
    EXPECT_EQ(*held, 1);
  }
}

// Records the thread that destroyed it.
struct Owned {
  Owned(std::atomic<int>& here, std::atomic<int>& elsewhere) : here_(here), elsewhere_(elsewhere) {}
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { ++(std::this_thread::get_id() == maker_ ? here_ : elsewhere_); }
  std::atomic<int>& here_;
  std::atomic<int>& elsewhere_;
  std::thread::id maker_ = std::this_thread::get_id();
};

TEST(TripleBuffer, DestroysWhatASlotOwnsWhenTheWriterFillsItAgain) {
  std::atomic<int> destroyed{0};
  std::atomic<int> elsewhere{0};
  TripleBuffer<std::unique_ptr<Owned>> buffer;
  const auto publishOne = [&] {
    buffer.back() = std::make_unique<Owned>(destroyed, elsewhere);
    buffer.publish();
  };
  publishOne();
  EXPECT_TRUE(buffer.refresh());  // the reader holds the first
  publishOne();
  publishOne();
  EXPECT_EQ(destroyed, 0);  // three slots, three values
  EXPECT_TRUE(buffer.refresh());
  EXPECT_EQ(destroyed, 0);  // the reader has given the first back, alive
  publishOne();
  EXPECT_EQ(destroyed, 1);  // its slot, or the second's, was filled again
  publishOne();
  EXPECT_EQ(destroyed, 2);
}

TEST(TripleBuffer, DestroysNothingOnTheReadersThread) {
  constexpr int kTaken = 1000;
  int published = 0;
  std::atomic<int> taken{0};
  std::atomic<int> by_writer{0};
  std::atomic<int> by_reader{0};
  {
    TripleBuffer<std::unique_ptr<Owned>> buffer;
    std::thread reader([&] {
      while (taken < kTaken) buffer.refresh() ? void(++taken) : std::this_thread::yield();
    });
    while (taken < kTaken) {
      buffer.back() = std::make_unique<Owned>(by_writer, by_reader);
      buffer.publish();
      ++published;
      if (published % 16 == 0) std::this_thread::yield();
    }
    reader.join();
  }
  EXPECT_EQ(by_writer, published);
  EXPECT_EQ(by_reader, 0);
}

TEST(TripleBuffer, NeverTearsAValueBetweenTwoThreads) {
  constexpr std::uint64_t kLast = 200'000;
  using Value = std::array<std::uint64_t, 32>;  // several cache lines, all words the same
  TripleBuffer<Value> buffer;
  std::thread writer([&] {
    for (std::uint64_t n = 1; n <= kLast; ++n) {
      buffer.back().fill(n);
      buffer.publish();
    }
  });
  std::uint64_t newest = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  while (newest != kLast) {
    if (!buffer.refresh()) {
      std::this_thread::yield();
      continue;
    }
    const Value& value = buffer.front();
    for (const std::uint64_t word : value) torn += word != value[0];
    backwards += value[0] <= newest;
    newest = value[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
}

}  // namespace
}  // namespace relievo
