// SPDX-License-Identifier: Apache-2.0
// A thread that runs a task at a fixed rate: SCHED_FIFO, absolute sleep, locked stack, lateness statistics.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "platform/clock.h"
#include "platform/error.h"
#include "platform/histogram.h"

namespace relievo {

enum class LoopControl : std::uint8_t { Continue, Stop };

struct Cycle {
  std::uint64_t index = 0;  // 0, 1, 2, ..; a missed cycle leaves a gap
  MonotonicTime scheduled;  // when the thread should have woken
  MonotonicTime woken;      // when it did
};

// The work of a cyclic thread. `loop` is called on the real-time thread: no allocation, no lock, no system call.
class CyclicTask {
 public:
  virtual ~CyclicTask() = default;
  virtual LoopControl loop(const Cycle& cycle) RELIEVO_RT = 0;
};

enum class Scheduler : std::uint8_t { Fifo, Other };

struct CyclicConfig {
  const char* name = "relievo-cyclic";  // at most 15 characters, the kernel's limit
  Duration period = std::chrono::milliseconds(1);
  int priority = 80;                     // of SCHED_FIFO, 1 to 99
  int cpu = -1;                          // -1: any
  std::size_t stack_bytes = 128 * 1024;  // locked and touched; room for the libraries' thread-local data is added
};

// Written by the loop, over all of a thread's runs; readable from any thread at any time.
struct CyclicStatistics {
  Histogram wakeup;  // woken - scheduled
  Histogram work;    // from waking to the return of `loop`
  std::atomic<std::uint64_t> cycles{0};
  std::atomic<std::uint64_t> overruns{0};     // cycles skipped because an earlier one's work had not ended
  std::atomic<std::uint64_t> page_faults{0};  // of the thread, from a run's first cycle to its last; added at its end
  std::atomic<std::uint64_t> allocations{0};  // likewise
  std::atomic<Scheduler> scheduler{Scheduler::Other};
  // Memory held for the thread while it runs: its stack; its state and statistics.
  std::size_t stack_bytes = 0, other_bytes = 0;
  std::size_t stack_used_bytes = 0;  // the most used at any time; set at a run's end
};

// Runs the loop on the calling thread until the task returns Stop or `stop` is set. On a ManualClock it runs in
// simulated time. The first cycle is due at once, cycle n `period` (> 0) times n later. A cycle that is due before the
// previous one's work ends is skipped and counted, never made up for: the phase is kept.
void runCycles(Clock& clock, Duration period, CyclicTask& task, CyclicStatistics& statistics,
               const std::atomic<bool>& stop) noexcept;

// Owner's thread only. The task, the clock and the statistics must outlive the run.
class CyclicThread {
 public:
  explicit CyclicThread(Clock& clock);
  ~CyclicThread();
  CyclicThread(const CyclicThread&) = delete;
  CyclicThread& operator=(const CyclicThread&) = delete;

  // Starts the task. Without permission for SCHED_FIFO the thread runs under the ordinary scheduler; the result says
  // which. InvalidState while it runs, Exhausted when no thread can be created.
  [[nodiscard]] Result<Scheduler> start(const CyclicConfig& config, CyclicTask& task);

  // Asks the loop to end and waits for it: at most one period and one cycle's work. Does nothing when not running.
  void stop() noexcept;

  [[nodiscard]] bool running() const noexcept { return run_ != nullptr; }
  // Of all runs since the object was made.
  [[nodiscard]] const CyclicStatistics& statistics() const noexcept { return *statistics_; }

 private:
  struct Run;
  static void* entry(void* run) noexcept;
  Clock& clock_;
  std::unique_ptr<Run> run_;
  std::unique_ptr<CyclicStatistics> statistics_ = std::make_unique<CyclicStatistics>();
};

}  // namespace relievo
