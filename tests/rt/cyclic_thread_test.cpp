// SPDX-License-Identifier: Apache-2.0
// The real thread: its scheduling, its processor and its use of the system. Checks counts only, never times.
#include "platform/cyclic_thread.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "platform/memory/fixed_memory.h"
#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

constexpr std::uint64_t kCycles = 200;

// Runs `Work` in each of kCycles cycles, then signals the end.
template <class Work>
class CountedTask final : public CyclicTask {
 public:
  explicit CountedTask(Work work) : work_(work) {}
  LoopControl loop(const Cycle& cycle) noexcept override {
    work_(cycle);
    return ++cycles_ == kCycles ? LoopControl::Stop : LoopControl::Continue;
  }

 private:
  Work work_;
  std::uint64_t cycles_ = 0;
};

void waitForTheEnd(const CyclicThread& thread, std::uint64_t before = 0) {
  while (thread.statistics().cycles < before + kCycles) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

class CyclicThreadTest : public testing::Test {
 protected:
  // A complete run of a task that does `work` kCycles times.
  template <class Work>
  void run(Work work, const CyclicConfig& config = {}) {
    const std::uint64_t before = thread.statistics().cycles;
    CountedTask task(work);
    const auto started = thread.start(config, task);
    ASSERT_TRUE(started.has_value()) << started.error().message;
    EXPECT_EQ(thread.statistics().scheduler, *started);
    waitForTheEnd(thread, before);
    thread.stop();
    EXPECT_EQ(thread.statistics().cycles, before + kCycles);
  }

  MonotonicClock clock;
  CyclicThread thread{clock};
};

TEST_F(CyclicThreadTest, TakesNeitherMemoryNorPagesWhileItRuns) {
  std::uint64_t last_index = 0;
  std::uint64_t early = 0;
  run([&](const Cycle& cycle) {
    last_index = cycle.index;
    early += cycle.woken < cycle.scheduled;
  });
  const CyclicStatistics& statistics = thread.statistics();
  EXPECT_EQ(statistics.allocations, 0u);
  if (!kMemorySanitizer) {
    EXPECT_EQ(statistics.page_faults, 0u);
  }
  EXPECT_EQ(early, 0u);
  EXPECT_EQ(last_index, kCycles - 1 + statistics.overruns);  // each gap is a counted overrun
  EXPECT_EQ(statistics.wakeup.count(), kCycles);
  EXPECT_EQ(statistics.work.count(), kCycles);
}

TEST_F(CyclicThreadTest, CountsATaskThatAllocates) {
  if (kRealtimeSanitizer) GTEST_SKIP() << "the real-time sanitizer stops at such a task, as it should";
  run([](const Cycle&) {
    void* block = std::malloc(100);
    asm volatile("" : "+r"(block) : : "memory");
    std::free(block);
  });
  EXPECT_EQ(thread.statistics().allocations, kCycles);
}

TEST_F(CyclicThreadTest, CountsATaskThatTouchesFreshPages) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  void* const map = ::mmap(nullptr, kCycles * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(map, MAP_FAILED);
  ::madvise(map, kCycles * page, MADV_NOHUGEPAGE);  // one fault a page
  auto* next = static_cast<volatile unsigned char*>(map);
  run([&](const Cycle&) {
    *next = 1;
    next += page;
  });
  ::munmap(map, kCycles * page);
  EXPECT_GE(thread.statistics().page_faults, kCycles);
  if (!kMemorySanitizer) {
    EXPECT_EQ(thread.statistics().page_faults, kCycles);
  }
}

TEST_F(CyclicThreadTest, TellsHowMuchOfItsStackWasUsed) {
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer keeps locals elsewhere";
  constexpr std::size_t kDeep = 40'000;
  run([](const Cycle&) {});
  const std::size_t shallow = thread.statistics().stack_used_bytes;
  EXPECT_GT(shallow, 0u);
  run([](const Cycle&) {
    std::array<unsigned char, kDeep> deep;
    deep.fill(1);
    asm volatile("" : : "r"(deep.data()) : "memory");
  });
  const CyclicStatistics& statistics = thread.statistics();
  EXPECT_GE(statistics.stack_used_bytes, kDeep);
  EXPECT_LT(statistics.stack_used_bytes, shallow + 2 * kDeep);
  EXPECT_LT(statistics.stack_used_bytes, statistics.stack_bytes);
}

TEST_F(CyclicThreadTest, CountsOverAllItsRuns) {
  if (kRealtimeSanitizer) GTEST_SKIP() << "the real-time sanitizer stops at such a task, as it should";
  run([](const Cycle&) {
    void* block = std::malloc(100);
    asm volatile("" : "+r"(block) : : "memory");
    std::free(block);
  });
  run([](const Cycle&) {});
  EXPECT_EQ(thread.statistics().cycles, 2 * kCycles);
  EXPECT_EQ(thread.statistics().wakeup.count(), 2 * kCycles);
  EXPECT_EQ(thread.statistics().allocations, kCycles);
}

TEST_F(CyclicThreadTest, RunsAsItIsToldTo) {
  struct Seen {
    int policy = -1;
    int priority = -1;
    int cpu = -1;
    std::array<char, 16> name{};
  } seen;
  const int cpu = ::sched_getcpu();
  run(
      [&](const Cycle&) {
        sched_param parameters{};
        ::pthread_getschedparam(::pthread_self(), &seen.policy, &parameters);
        seen.priority = parameters.sched_priority;
        seen.cpu = ::sched_getcpu();
        ::prctl(PR_GET_NAME, seen.name.data());
      },
      {.name = "fifteen-letters", .priority = 42, .cpu = cpu});
  EXPECT_STREQ(seen.name.data(), "fifteen-letters");
  EXPECT_EQ(seen.cpu, cpu);
  if (thread.statistics().scheduler == Scheduler::Fifo) {
    EXPECT_EQ(seen.policy, SCHED_FIFO);
    EXPECT_EQ(seen.priority, 42);
  } else {
    EXPECT_EQ(seen.policy, SCHED_OTHER);
  }
}

// The C library puts it on top of each thread's stack.
constexpr std::size_t kThreadData = 96 * 1024;
thread_local std::array<volatile char, kThreadData> thread_data;

TEST_F(CyclicThreadTest, GivesTheTaskItsWholeStackWhateverThreadLocalDataThereIs) {
  constexpr std::size_t kStack = 48 * 1024;
  run(
      [](const Cycle&) {
        volatile char room[kStack / 2];
        for (std::size_t i = 0; i < sizeof room; i += 1024) room[i] = 1;
        thread_data[kThreadData - 1] = room[0];
      },
      {.stack_bytes = kStack});
}

// The stack's mapping in /proc/self/smaps, and the permissions of the mapping just below it.
struct StackMapping {
  std::uint64_t bytes = 0;
  bool locked = false;
  std::string below;
};

StackMapping mappingOf(std::uintptr_t address) {
  StackMapping found;
  std::ifstream file("/proc/self/smaps");
  std::string line;
  std::string previous;
  std::uintptr_t previous_end = 0;
  bool inside = false;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    char dash = 0;
    std::string permissions;
    if (words >> std::hex >> begin >> dash >> end >> permissions && dash == '-') {
      inside = begin <= address && address < end;
      if (inside) {
        found.bytes = end - begin;
        if (previous_end == begin) found.below = previous;
      }
      previous = permissions;
      previous_end = end;
    } else if (inside && line.starts_with("VmFlags:")) {
      found.locked = (line + ' ').find(" lo ") != std::string::npos;
    }
  }
  return found;
}

TEST_F(CyclicThreadTest, HasALockedStackWithAGuardPage) {
  struct Task final : CyclicTask {
    LoopControl loop(const Cycle&) noexcept override {
      int local = 0;
      address = reinterpret_cast<std::uintptr_t>(&local);
      return LoopControl::Continue;
    }
    std::atomic<std::uintptr_t> address{0};
  } task;
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer keeps locals elsewhere and locks nothing";
  const CyclicConfig config{.stack_bytes = 256 * 1024};
  ASSERT_TRUE(thread.start(config, task).has_value());
  while (task.address == 0) std::this_thread::yield();
  const StackMapping stack = mappingOf(task.address);
  thread.stop();
  EXPECT_GE(stack.bytes, config.stack_bytes);
  EXPECT_LT(stack.bytes, config.stack_bytes + kThreadData + 64 * 1024);
  EXPECT_EQ(stack.below.substr(0, 3), "---");
  int may_lock = 0;
  if (lockAndTouch(&may_lock, sizeof may_lock)) {
    EXPECT_TRUE(stack.locked);
  }
}

TEST_F(CyclicThreadTest, StopsATaskThatWouldGoOnForEver) {
  struct Task final : CyclicTask {
    LoopControl loop(const Cycle&) noexcept override { return LoopControl::Continue; }
  } task;
  EXPECT_FALSE(thread.running());
  thread.stop();  // not running: nothing happens
  ASSERT_TRUE(thread.start({}, task).has_value());
  EXPECT_TRUE(thread.running());
  const auto again = thread.start({}, task);
  ASSERT_FALSE(again.has_value());
  EXPECT_EQ(again.error().code, ErrorCode::InvalidState);
  waitForTheEnd(thread);
  thread.stop();
  EXPECT_FALSE(thread.running());
  EXPECT_GE(thread.statistics().cycles, kCycles);
}

TEST_F(CyclicThreadTest, RunsInSimulatedTimeOnAManualClock) {
  ManualClock manual;
  CyclicThread simulated(manual);
  CountedTask task([&](const Cycle&) { manual.advance(std::chrono::microseconds(2500)); });
  ASSERT_TRUE(simulated.start({}, task).has_value());
  waitForTheEnd(simulated);
  simulated.stop();
  EXPECT_EQ(simulated.statistics().overruns, 2 * (kCycles - 1));  // 2.5 periods of work: two missed each time
  EXPECT_EQ(simulated.statistics().wakeup.max(), Duration(0));
}

TEST_F(CyclicThreadTest, RefusesWhatCannotBe) {
  CountedTask task([](const Cycle&) {});
  const auto codeOf = [&](const CyclicConfig& config) {
    const auto started = thread.start(config, task);
    return started ? ErrorCode::InvalidState : started.error().code;
  };
  EXPECT_EQ(codeOf({.name = "sixteen-letters!"}), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeOf({.name = nullptr}), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeOf({.period = Duration(0)}), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeOf({.priority = 0}), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeOf({.priority = 100}), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeOf({.cpu = CPU_SETSIZE}), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeOf({.cpu = CPU_SETSIZE - 1}), ErrorCode::InvalidArgument);  // a processor that does not exist
  EXPECT_EQ(codeOf({.stack_bytes = 1024}), ErrorCode::InvalidArgument);
  EXPECT_FALSE(thread.running());
}

TEST_F(CyclicThreadTest, RunsWithoutTheRightToRealTimeAndSaysSo) {
  if (kMemorySanitizer) GTEST_SKIP() << "a sanitizer's own thread keeps the process from forking well";
  const auto child = [this] {
    const rlimit none{.rlim_cur = 0, .rlim_max = 0};
    const bool dropped = ::setrlimit(RLIMIT_RTPRIO, &none) == 0 && ::setrlimit(RLIMIT_MEMLOCK, &none) == 0 &&
                         (::getuid() != 0 || ::setuid(65534) == 0);
    CountedTask task([](const Cycle&) {});
    const auto started = thread.start({.name = "unprivileged"}, task);
    if (started) waitForTheEnd(thread);
    thread.stop();
    const CyclicStatistics& statistics = thread.statistics();
    const bool good = dropped && started == Scheduler::Other && statistics.scheduler == Scheduler::Other &&
                      statistics.cycles == kCycles && statistics.allocations == 0 && statistics.page_faults == 0;
    std::_Exit(good ? 0 : 1);
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(0),
              "^relievo: cyclic: unprivileged: memory could not be locked; raise LimitMEMLOCK or grant "
              "CAP_IPC_LOCK\n"
              "relievo: cyclic: unprivileged: runs without real-time priority; grant CAP_SYS_NICE or raise "
              "LimitRTPRIO\n$");
}

}  // namespace
}  // namespace relievo
