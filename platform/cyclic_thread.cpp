// SPDX-License-Identifier: Apache-2.0
// The cyclic loop and its thread, whose memory is mapped, touched and locked before the first cycle.
#include "platform/cyclic_thread.h"

#include <link.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

#include "platform/allocation_counter.h"
#include "platform/log.h"
#include "platform/memory/fixed_memory.h"

namespace relievo {
namespace {

constexpr std::size_t kNameBytes = 16;  // the kernel's limit, with the terminating zero

void count(std::atomic<std::uint64_t>& n, std::uint64_t by) noexcept {
  n.store(n.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);  // one writer
}

// How many of the cycles that follow `scheduled` were due before `now`.
std::uint64_t missedCycles(MonotonicTime scheduled, MonotonicTime now, Duration period) noexcept {
  const Duration late = now - (scheduled + period);
  if (late <= Duration(0)) return 0;
  return static_cast<std::uint64_t>((late.count() + period.count() - 1) / period.count());  // rounded up
}

// A thread's page faults and allocations since it began.
struct ThreadUsage {
  std::uint64_t page_faults = 0;
  std::uint64_t allocations = 0;
};

ThreadUsage threadUsage() noexcept {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);  // cannot fail: both arguments are good
  return {.page_faults = static_cast<std::uint64_t>(usage.ru_minflt) + static_cast<std::uint64_t>(usage.ru_majflt),
          .allocations = threadAllocations()};
}

int addThreadData(dl_phdr_info* object, std::size_t, void* sum) {
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr) & segment = object->dlpi_phdr[i];
    if (segment.p_type == PT_TLS) *static_cast<std::size_t*>(sum) += segment.p_memsz + segment.p_align;
  }
  return 0;  // go on to the next object
}

// An upper bound of what the C library takes from the top of a thread's stack, mainly thread_local data of all
// libraries. It is added to the stack size that the task asks for.
std::size_t threadDataBytes() noexcept {
  std::size_t sum = 8 * 1024;  // the thread's descriptor, and the C library's reserve for later libraries
  ::dl_iterate_phdr(addThreadData, &sum);
  return sum;
}

// A thread's stack, with a guard page below it that stops an overflow.
class Stack {
 public:
  Stack() noexcept = default;
  Stack(Stack&& other) noexcept
      : base_(std::exchange(other.base_, nullptr)), bytes_(other.bytes_), locked_(other.locked_) {}
  Stack& operator=(Stack&&) = delete;
  ~Stack() {
    if (base_ != nullptr) ::munmap(base_, guardBytes() + bytes_);
  }

  static Result<Stack> create(std::size_t wanted) noexcept {
    const std::size_t page = guardBytes();
    Stack stack;
    stack.bytes_ = (wanted + threadDataBytes() + page - 1) / page * page;
    void* const base =
        ::mmap(nullptr, page + stack.bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
    if (base == MAP_FAILED) return fail(ErrorCode::Exhausted, "no memory for the cyclic thread's stack", errno);
    stack.base_ = static_cast<std::byte*>(base);
    if (::mprotect(base, page, PROT_NONE) != 0) {
      return fail(ErrorCode::Exhausted, "no guard page for the cyclic thread's stack", errno);
    }
    stack.locked_ = lockAndTouch(stack.bottom(), stack.bytes_).has_value();
    return stack;
  }

  [[nodiscard]] void* bottom() const noexcept { return base_ + guardBytes(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  [[nodiscard]] bool locked() const noexcept { return locked_; }
  // Bytes from the lowest nonzero one to the top: the stack starts zeroed. Only while no thread runs on it.
  [[nodiscard]] std::size_t used() const noexcept {
    const auto* const begin = static_cast<const std::byte*>(bottom());
    return static_cast<std::size_t>(begin + bytes_ -
                                    std::find_if(begin, begin + bytes_, [](std::byte b) { return b != std::byte{}; }));
  }

 private:
  static std::size_t guardBytes() noexcept { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

  std::byte* base_ = nullptr;
  std::size_t bytes_ = 0;
  bool locked_ = false;
};

// Owns pthread attributes.
class ThreadAttributes {
 public:
  ThreadAttributes() noexcept { ::pthread_attr_init(&attributes_); }
  ThreadAttributes(const ThreadAttributes&) = delete;
  ThreadAttributes& operator=(const ThreadAttributes&) = delete;
  ~ThreadAttributes() { ::pthread_attr_destroy(&attributes_); }

  [[nodiscard]] const pthread_attr_t* get() const noexcept { return &attributes_; }
  [[nodiscard]] int setStack(const Stack& stack) noexcept {
    return ::pthread_attr_setstack(&attributes_, stack.bottom(), stack.bytes());
  }
  [[nodiscard]] int setCpu(int cpu) noexcept {
    if (cpu < 0) return 0;
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(cpu), &set);
    return ::pthread_attr_setaffinity_np(&attributes_, sizeof set, &set);
  }
  // Explicit: the thread must not inherit its owner's scheduler.
  [[nodiscard]] int setScheduler(Scheduler scheduler, int priority) noexcept {
    const bool fifo = scheduler == Scheduler::Fifo;
    sched_param parameters{};
    parameters.sched_priority = fifo ? priority : 0;
    if (const int error = ::pthread_attr_setinheritsched(&attributes_, PTHREAD_EXPLICIT_SCHED)) return error;
    if (const int error = ::pthread_attr_setschedpolicy(&attributes_, fifo ? SCHED_FIFO : SCHED_OTHER)) return error;
    return ::pthread_attr_setschedparam(&attributes_, &parameters);
  }

 private:
  pthread_attr_t attributes_{};
};

Result<void> checked(const CyclicConfig& config) noexcept {
  if (config.name == nullptr || ::strnlen(config.name, kNameBytes) == kNameBytes) {
    return fail(ErrorCode::InvalidArgument, "the name of a cyclic thread must have at most 15 characters");
  }
  if (config.period <= Duration(0)) {
    return fail(ErrorCode::InvalidArgument, "the period of a cyclic thread must be over 0");
  }
  if (config.priority < 1 || config.priority > 99) {  // SCHED_FIFO on Linux
    return fail(ErrorCode::InvalidArgument, "the priority of a cyclic thread must be 1 to 99");
  }
  if (config.cpu >= CPU_SETSIZE) return fail(ErrorCode::InvalidArgument, "there is no processor of that number");
  if (config.stack_bytes < static_cast<std::size_t>(PTHREAD_STACK_MIN)) {
    return fail(ErrorCode::InvalidArgument, "the stack of a cyclic thread must be at least PTHREAD_STACK_MIN");
  }
  return {};
}

}  // namespace

void runCycles(Clock& clock, Duration period, CyclicTask& task, CyclicStatistics& statistics,
               const std::atomic<bool>& stop) noexcept {
  assert(period > Duration(0));
  Cycle cycle;
  cycle.scheduled = clock.now();
  for (;;) {
    clock.sleepUntil(cycle.scheduled);
    if (stop.load(std::memory_order_acquire)) return;
    cycle.woken = clock.now();
    const LoopControl control = task.loop(cycle);
    const MonotonicTime done = clock.now();
    statistics.wakeup.add(cycle.woken - cycle.scheduled);
    statistics.work.add(done - cycle.woken);
    count(statistics.cycles, 1);
    if (control == LoopControl::Stop) return;
    const std::uint64_t missed = missedCycles(cycle.scheduled, done, period);
    if (missed > 0) count(statistics.overruns, missed);
    cycle.index += 1 + missed;
    cycle.scheduled += period * static_cast<Duration::rep>(1 + missed);
  }
}

struct CyclicThread::Run {
  Clock& clock;
  CyclicTask& task;
  CyclicStatistics& statistics;
  Duration period;
  std::array<char, kNameBytes> name{};
  Stack stack;
  std::atomic<bool> stop{false};
  pthread_t thread{};

  // Returns 0 or an error number.
  [[nodiscard]] int create(const CyclicConfig& config, Scheduler scheduler) noexcept {
    ThreadAttributes attributes;
    if (const int error = attributes.setStack(stack)) return error;
    if (const int error = attributes.setCpu(config.cpu)) return error;
    if (const int error = attributes.setScheduler(scheduler, config.priority)) return error;
    return ::pthread_create(&thread, attributes.get(), &entry, this);
  }

  // Calls everything that the loop calls once, so that lazy binding and page mapping are over before faults are
  // counted.
  void warmUp() noexcept {
    Histogram scratch;
    clock.sleepUntil(clock.now());
    scratch.add(Duration(1));
    static_cast<void>(threadUsage());
  }

  void loop() noexcept {
    ::pthread_setname_np(::pthread_self(), name.data());
    ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // the ordinary scheduler would add 50 us to each sleep
    warmUp();
    const ThreadUsage before = threadUsage();
    runCycles(clock, period, task, statistics, stop);
    const ThreadUsage after = threadUsage();
    count(statistics.page_faults, after.page_faults - before.page_faults);
    count(statistics.allocations, after.allocations - before.allocations);
  }
};

void* CyclicThread::entry(void* run) noexcept {
  static_cast<Run*>(run)->loop();
  return nullptr;
}

CyclicThread::CyclicThread(Clock& clock) : clock_(clock) {}

CyclicThread::~CyclicThread() {
  stop();
}

Result<Scheduler> CyclicThread::start(const CyclicConfig& config, CyclicTask& task) {
  if (running()) return fail(ErrorCode::InvalidState, "the cyclic thread is running already; stop it first");
  if (const auto good = checked(config); !good) return std::unexpected(good.error());
  auto stack = Stack::create(config.stack_bytes);
  if (!stack) return std::unexpected(stack.error());

  auto run = std::unique_ptr<Run>(new Run{
      .clock = clock_, .task = task, .statistics = *statistics_, .period = config.period, .stack = std::move(*stack)});
  std::strncpy(run->name.data(), config.name, kNameBytes - 1);
  const bool code_locked = lockAndTouchCode().has_value();
  const bool run_locked = lockAndTouch(run.get(), sizeof *run).has_value();
  const bool statistics_locked = lockAndTouch(statistics_.get(), sizeof *statistics_).has_value();
  if (!(code_locked && run_locked && statistics_locked && run->stack.locked())) {
    log(LogLevel::Warning, "cyclic", "%s: memory could not be locked; raise LimitMEMLOCK or grant CAP_IPC_LOCK",
        config.name);
  }

  Scheduler scheduler = Scheduler::Fifo;
  int error = run->create(config, scheduler);
  if (error == EPERM) {
    scheduler = Scheduler::Other;
    error = run->create(config, scheduler);
    if (error == 0) {
      log(LogLevel::Warning, "cyclic", "%s: runs without real-time priority; grant CAP_SYS_NICE or raise LimitRTPRIO",
          config.name);
    }
  }
  if (error == EINVAL) {
    return fail(ErrorCode::InvalidArgument, "the cyclic thread's processor does not exist, or its stack is too small",
                error);
  }
  if (error != 0) {
    return fail(ErrorCode::Exhausted, "the system cannot create another thread; stop other programs", error);
  }
  statistics_->scheduler.store(scheduler, std::memory_order_relaxed);
  statistics_->stack_bytes = run->stack.bytes();
  statistics_->other_bytes = sizeof *run + sizeof *statistics_;
  run_ = std::move(run);
  return scheduler;
}

void CyclicThread::stop() noexcept {
  if (!running()) return;
  run_->stop.store(true, std::memory_order_release);
  ::pthread_join(run_->thread, nullptr);
  statistics_->stack_used_bytes = std::max(statistics_->stack_used_bytes, run_->stack.used());
  run_.reset();
}

}  // namespace relievo
