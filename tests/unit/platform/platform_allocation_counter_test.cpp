// SPDX-License-Identifier: Apache-2.0
// Every kind of allocation is counted once, on its thread, from any library.
#include "platform/allocation_counter.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <thread>

#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

// Keeps the compiler from removing an allocation whose result is unused.
template <class T>
T* keep(T* pointer) {
  asm volatile("" : "+r"(pointer) : : "memory");
  return pointer;
}

template <class Act>
std::uint64_t allocationsOf(Act act) {
  const std::uint64_t before = threadAllocations();
  act();
  return threadAllocations() - before;
}

class ThreadAllocations : public testing::Test {
 protected:
  void SetUp() override {
    if (kRealtimeSanitizer) GTEST_SKIP() << "the real-time sanitizer stops at an allocation instead of counting it";
  }
};

TEST_F(ThreadAllocations, StandsStillWhileNothingIsAllocated) {
  int on_the_stack = 0;
  EXPECT_EQ(allocationsOf([&] { on_the_stack = 1; }), 0u);
}

TEST_F(ThreadAllocations, CountsTheCFunctions) {
  void* block = nullptr;
  EXPECT_EQ(allocationsOf([&] { block = keep(std::malloc(100)); }), 1u);
  EXPECT_EQ(allocationsOf([&] { block = keep(std::realloc(block, 100'000)); }), 1u);
  EXPECT_EQ(allocationsOf([&] { std::free(block); }), 0u);
  EXPECT_EQ(allocationsOf([] { std::free(keep(std::calloc(10, 10))); }), 1u);
}

TEST_F(ThreadAllocations, CountsTheAlignedCFunctions) {
  if (kThreadSanitizer) GTEST_SKIP() << "the thread sanitizer's hooks do not report these";
  EXPECT_EQ(allocationsOf([] { std::free(keep(std::aligned_alloc(64, 128))); }), 1u);
  EXPECT_EQ(allocationsOf([] { std::free(keep(::memalign(64, 100))); }), 1u);
  EXPECT_EQ(allocationsOf([] {
              void* block = nullptr;
              EXPECT_EQ(::posix_memalign(&block, 64, 100), 0);
              std::free(keep(block));
            }),
            1u);
}

TEST_F(ThreadAllocations, CountsEachKindOfNewOnce) {
  struct alignas(256) Wide {
    char bytes[256];
  };
  EXPECT_EQ(allocationsOf([] { delete keep(new int(1)); }), 1u);
  EXPECT_EQ(allocationsOf([] { delete[] keep(new int[50]); }), 1u);
  EXPECT_EQ(allocationsOf([] { delete keep(new (std::nothrow) int(1)); }), 1u);
  EXPECT_EQ(allocationsOf([] { delete keep(new Wide); }), 1u);
}

TEST_F(ThreadAllocations, CountsWhatALibraryAllocatesForItsCaller) {
  EXPECT_EQ(allocationsOf([] { std::free(keep(::strdup("inside the C library"))); }), 1u);
  EXPECT_EQ(allocationsOf([] { keep(std::string(100, 'x').data()); }), 1u);  // made inside the C++ library
}

TEST_F(ThreadAllocations, DoesNotCountAnotherThreads) {
  std::thread([] {}).join();  // the first thread costs the C library more than the next
  std::thread other;
  const std::uint64_t of_the_start = allocationsOf([&] { other = std::thread([] {}); });
  other.join();

  std::uint64_t of_the_other = 0;
  const std::uint64_t of_this = allocationsOf([&] {
    other = std::thread([&] {
      of_the_other = allocationsOf([] {
        for (int i = 0; i < 1000; ++i) std::free(keep(std::malloc(10)));
      });
    });
    other.join();
  });
  EXPECT_EQ(of_the_other, 1000u);
  EXPECT_EQ(of_this, of_the_start);
}

TEST(CountingAllocator, GivesBlocksThatAreAlignedAndClear) {
  void* block = keep(std::aligned_alloc(4096, 4096));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 4096, 0u);
  std::free(block);
  ASSERT_EQ(::posix_memalign(&block, 1024, 10), 0);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 1024, 0u);
  std::free(block);
  auto* const cleared = static_cast<unsigned char*>(keep(std::calloc(64, 16)));
  for (int i = 0; i < 64 * 16; ++i) ASSERT_EQ(cleared[i], 0);
  std::free(cleared);
}

TEST(CountingAllocator, KeepsTheContentWhenABlockGrows) {
  auto* block = static_cast<char*>(std::malloc(6));
  std::memcpy(block, "relie", 6);
  block = static_cast<char*>(keep(std::realloc(block, 1 << 20)));
  EXPECT_STREQ(block, "relie");
  std::free(block);
}

TEST(CountingAllocator, RefusesAnAlignmentThatIsNoPowerOfTwo) {
  if (kMemorySanitizer || kRealtimeSanitizer) GTEST_SKIP() << "a sanitizer's allocator ends the program here";
  void* untouched = &untouched;
  EXPECT_EQ(::posix_memalign(&untouched, 3 * sizeof(void*), 8), EINVAL);
  EXPECT_EQ(::posix_memalign(&untouched, sizeof(void*) / 2, 8), EINVAL);
  EXPECT_EQ(untouched, &untouched);
  volatile std::size_t three = 3;  // unknown to the compiler, which would warn
  errno = 0;
  EXPECT_EQ(std::aligned_alloc(three, 8), nullptr);
  EXPECT_EQ(errno, EINVAL);
}

}  // namespace
}  // namespace relievo
