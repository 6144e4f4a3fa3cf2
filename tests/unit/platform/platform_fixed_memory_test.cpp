// SPDX-License-Identifier: Apache-2.0
// Touched and locked memory as the kernel reports it, and the arena in it.
#include "platform/memory/fixed_memory.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

constexpr std::size_t kPages = 32;

std::size_t pageBytes() {
  return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// Fresh pages of zeros; small ones, so that the kernel maps each by itself.
class FreshPages {
 public:
  FreshPages()
      : base_(static_cast<unsigned char*>(
            ::mmap(nullptr, kPages * pageBytes(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))) {
    ::madvise(base_, kPages * pageBytes(), MADV_NOHUGEPAGE);
  }
  ~FreshPages() { ::munmap(base_, kPages * pageBytes()); }
  unsigned char* operator[](std::size_t page) const { return base_ + page * pageBytes(); }

  [[nodiscard]] std::size_t resident() const {
    std::array<unsigned char, kPages> state{};
    EXPECT_EQ(::mincore(base_, kPages * pageBytes(), state.data()), 0);
    std::size_t count = 0;
    for (const unsigned char s : state) count += s & 1;
    return count;
  }

 private:
  unsigned char* base_;
};

std::uint64_t pageFaults() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt);
}

// One mapping of this process: the fields of /proc/self/smaps that the tests ask for.
struct Mapping {
  std::string permissions;
  std::string file;
  bool locked = false;
};

std::vector<Mapping> mappings() {
  std::vector<Mapping> all;
  std::ifstream file("/proc/self/smaps");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "VmFlags:") all.back().locked = (line + ' ').find(" lo ") != std::string::npos;
    if (first.back() == ':') continue;
    Mapping mapping;
    std::string skipped;
    words >> mapping.permissions >> skipped >> skipped >> skipped >> mapping.file;
    all.push_back(mapping);
  }
  return all;
}

// Runs `act` in a process that may not lock memory; the exit code is 0 if `act` returns true.
template <class Act>
void withoutTheRight(Act act) {
  const auto child = [&] {
    const rlimit none{.rlim_cur = 0, .rlim_max = 0};
    const bool dropped = ::setrlimit(RLIMIT_MEMLOCK, &none) == 0 && (::getuid() != 0 || ::setuid(65534) == 0);
    std::_Exit(dropped && act() ? 0 : 1);
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(0), "");
}

TEST(LockAndTouch, MapsEachPageSoThatWritingDoesNotFault) {
  FreshPages pages;
  ASSERT_EQ(pages.resident(), 0u);
  const auto locked = lockAndTouch(pages[0], kPages * pageBytes());
  EXPECT_TRUE(locked || locked.error().code == ErrorCode::PermissionDenied);
  EXPECT_EQ(pages.resident(), kPages);
  if (kMemorySanitizer) return;
  const std::uint64_t before = pageFaults();
  for (std::size_t page = 0; page < kPages; ++page) *pages[page] = 1;
  EXPECT_EQ(pageFaults(), before);
}

TEST(LockAndTouch, TakesTheWholeOfAPageThatTheRangeOnlyMeets) {
  FreshPages pages;
  static_cast<void>(lockAndTouch(pages[4] - 1, pageBytes() + 2));  // the last of 3, all of 4, the first of 5
  EXPECT_EQ(pages.resident(), 3u);
}

TEST(LockAndTouch, LeavesTheContentAsItWas) {
  FreshPages pages;
  for (std::size_t page = 0; page < kPages; ++page) *pages[page] = static_cast<unsigned char>(page + 1);
  static_cast<void>(lockAndTouch(pages[0], kPages * pageBytes()));
  for (std::size_t page = 0; page < kPages; ++page) EXPECT_EQ(*pages[page], page + 1);
}

TEST(LockAndTouch, DoesNothingToAnEmptyRange) {
  FreshPages pages;
  EXPECT_TRUE(lockAndTouch(pages[0], 0).has_value());
  EXPECT_EQ(pages.resident(), 0u);
}

TEST(LockAndTouch, SaysWhenTheRightIsMissingAndTouchesAllTheSame) {
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer's mlock always succeeds";
  withoutTheRight([] {
    FreshPages pages;
    const auto locked = lockAndTouch(pages[0], kPages * pageBytes());
    const std::uint64_t before = pageFaults();
    for (std::size_t page = 0; page < kPages; ++page) *pages[page] = 1;
    return !locked && locked.error().code == ErrorCode::PermissionDenied && locked.error().os_error != 0 &&
           pageFaults() == before;
  });
}

TEST(LockAndTouchCode, LocksTheProgramsAndItsLibrariesCode) {
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer's mlock does nothing";
  volatile double argument = 2.0;
  ASSERT_GT(std::sin(argument), 0.0);  // so that the maths library is linked
  const auto locked = lockAndTouchCode();
  if (!locked) GTEST_SKIP() << locked.error().message;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  for (const std::string& wanted : {program, std::string("/libc.so."), std::string("/libm.so."),
                                    std::string("/libstdc++.so."), std::string("/libgcc_s.so."), std::string("/ld-")}) {
    int code = 0;
    for (const Mapping& mapping : mappings()) {
      if (mapping.file.find(wanted) == std::string::npos || mapping.permissions[1] == 'w') continue;
      EXPECT_TRUE(mapping.locked) << mapping.permissions << ' ' << mapping.file;
      code += mapping.permissions[2] == 'x';
    }
    EXPECT_EQ(code, 1) << wanted;
  }
}

TEST(LockAndTouchCode, LeavesOtherLibrariesAlone) {
  void* const other = ::dlopen("libresolv.so.2", RTLD_NOW);  // part of the C library, but not used by a loop
  ASSERT_NE(other, nullptr);
  static_cast<void>(lockAndTouchCode());
  int seen = 0;
  for (const Mapping& mapping : mappings()) {
    if (mapping.file.find("/libresolv") == std::string::npos) continue;
    ++seen;
    EXPECT_FALSE(mapping.locked) << mapping.permissions;
  }
  EXPECT_GT(seen, 0);
  ::dlclose(other);
}

TEST(LockAndTouchCode, SaysWhenTheRightIsMissing) {
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer's mlock always succeeds";
  withoutTheRight([] {
    const auto locked = lockAndTouchCode();
    return !locked && locked.error().code == ErrorCode::PermissionDenied;
  });
}

TEST(FixedArena, RefusesToBeEmpty) {
  const auto arena = FixedArena::create(0);
  ASSERT_FALSE(arena.has_value());
  EXPECT_EQ(arena.error().code, ErrorCode::InvalidArgument);
}

TEST(FixedArena, SaysWhenThereIsNoMemory) {
  const auto arena = FixedArena::create(SIZE_MAX / 8 * 7);  // 32 bits have a quarter of it to spare
  ASSERT_FALSE(arena.has_value());
  EXPECT_EQ(arena.error().code, ErrorCode::Exhausted);
}

TEST(FixedArena, AlignsEachObject) {
  struct alignas(64) Line {
    char bytes[64];
  };
  auto arena = FixedArena::create(4096);
  ASSERT_TRUE(arena.has_value());
  EXPECT_EQ(arena->used(), 0u);
  char* const letter = arena->make<char>('x');
  double* const number = arena->make<double>(2.5);
  Line* const line = arena->make<Line>();
  ASSERT_TRUE(letter != nullptr && number != nullptr && line != nullptr);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(number) % alignof(double), 0u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(line) % 64, 0u);
  EXPECT_EQ(*letter, 'x');
  EXPECT_EQ(*number, 2.5);
  EXPECT_EQ(arena->used(), 128u);  // 1, 8 from 8 on, 64 from 64 on
}

TEST(FixedArena, GivesNothingOnceItIsFullAndWhatFitsBefore) {
  auto arena = FixedArena::create(64);
  ASSERT_TRUE(arena.has_value());
  EXPECT_EQ(arena->capacity(), 64u);
  using Block = std::array<std::uint64_t, 4>;
  EXPECT_NE(arena->make<Block>(), nullptr);
  EXPECT_NE(arena->make<Block>(), nullptr);
  EXPECT_EQ(arena->make<char>('x'), nullptr);
  EXPECT_EQ(arena->used(), 64u);
}

struct Named {
  Named(std::vector<int>& gone, int name) : gone_(gone), name_(name) {}
  Named(const Named&) = delete;
  Named& operator=(const Named&) = delete;
  ~Named() { gone_.push_back(name_); }
  std::vector<int>& gone_;
  int name_;
};

TEST(FixedArena, DestroysItsObjectsInReverseOrder) {
  std::vector<int> gone;
  {
    auto arena = FixedArena::create(4096);
    ASSERT_TRUE(arena.has_value());
    for (int name = 1; name <= 3; ++name) ASSERT_NE(arena->make<Named>(gone, name), nullptr);
    EXPECT_TRUE(gone.empty());
  }
  EXPECT_EQ(gone, (std::vector<int>{3, 2, 1}));
}

TEST(FixedArena, DestroysItsObjectsOnceWhenItIsMoved) {
  std::vector<int> gone;
  {
    auto made = FixedArena::create(4096);
    ASSERT_TRUE(made.has_value());
    ASSERT_NE(made->make<Named>(gone, 1), nullptr);
    FixedArena arena = std::move(*made);
    ASSERT_NE(arena.make<Named>(gone, 2), nullptr);
    EXPECT_EQ(made->capacity(), 0u);
    EXPECT_EQ(made->make<int>(1), nullptr);
  }
  EXPECT_EQ(gone, (std::vector<int>{2, 1}));
}

// The object fits but its clean-up record does not: `make` fails, since the object would never be destroyed.
TEST(FixedArena, MakesNoObjectThatItCouldNotDestroy) {
  std::vector<int> gone;
  {
    auto arena = FixedArena::create(sizeof(Named) + 8);
    ASSERT_TRUE(arena.has_value());
    EXPECT_EQ(arena->make<Named>(gone, 1), nullptr);
  }
  EXPECT_TRUE(gone.empty());
}

TEST(FixedArena, CostsNoPageFaultOnceItIsMade) {
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer's shadow memory faults";
  auto arena = FixedArena::create(kPages * pageBytes());
  ASSERT_TRUE(arena.has_value());
  const std::uint64_t before = pageFaults();
  for (std::size_t page = 0; page < kPages; ++page) {
    auto* const block = arena->make<std::array<unsigned char, 4096>>();
    ASSERT_NE(block, nullptr);
  }
  EXPECT_EQ(pageFaults(), before);
}

TEST(FixedArena, SaysWhetherItCouldBeLocked) {
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer's mlock always succeeds";
  withoutTheRight([] {
    const auto arena = FixedArena::create(4096);
    return arena.has_value() && !arena->locked();
  });
}

}  // namespace
}  // namespace relievo
