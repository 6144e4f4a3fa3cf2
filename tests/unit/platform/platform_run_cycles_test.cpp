// SPDX-License-Identifier: Apache-2.0
// The cyclic loop in simulated time: which cycles run, when, and how many are missed, as calculated by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "platform/cyclic_thread.h"

namespace relievo {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::ElementsAre;

constexpr Duration kPeriod = milliseconds(1);
constexpr MonotonicTime kStart = MonotonicTime{} + milliseconds(5);

// Takes a given time of the clock for each cycle, and records the cycles.
class RecordingTask final : public CyclicTask {
 public:
  using Work = std::function<Duration(const Cycle&)>;
  RecordingTask(ManualClock& clock, std::size_t cycles, Work work)
      : clock_(clock), cycles_(cycles), work_(std::move(work)) {
    seen_.reserve(cycles);
  }
  LoopControl loop(const Cycle& cycle) noexcept override {
    seen_.push_back(cycle);
    clock_.advance(work_(cycle));
    return seen_.size() == cycles_ ? LoopControl::Stop : LoopControl::Continue;
  }
  [[nodiscard]] const std::vector<Cycle>& seen() const { return seen_; }
  [[nodiscard]] std::vector<std::uint64_t> indices() const {
    std::vector<std::uint64_t> all;
    for (const Cycle& cycle : seen_) all.push_back(cycle.index);
    return all;
  }

 private:
  ManualClock& clock_;
  std::size_t cycles_;
  Work work_;
  std::vector<Cycle> seen_;
};

// Wakes late by each of the given delays in turn; then on time.
class LateClock final : public Clock {
 public:
  explicit LateClock(ManualClock& clock, std::vector<Duration> delays) : clock_(clock), delays_(std::move(delays)) {}
  [[nodiscard]] MonotonicTime now() const noexcept override { return clock_.now(); }
  void sleepUntil(MonotonicTime deadline) noexcept override {
    clock_.sleepUntil(deadline);
    if (slept_ < delays_.size()) clock_.advance(delays_[slept_]);
    ++slept_;
  }

 private:
  ManualClock& clock_;
  std::vector<Duration> delays_;
  std::size_t slept_ = 0;
};

class RunCycles : public testing::Test {
 protected:
  void run(RecordingTask& task) { runCycles(clock, kPeriod, task, statistics, stop); }

  ManualClock clock{kStart};
  CyclicStatistics statistics;
  std::atomic<bool> stop{false};
};

RecordingTask::Work always(Duration work) {
  return [work](const Cycle&) { return work; };
}

void expectOnPhase(const std::vector<Cycle>& cycles) {
  for (const Cycle& cycle : cycles) {
    EXPECT_EQ(cycle.scheduled, kStart + kPeriod * static_cast<Duration::rep>(cycle.index)) << "cycle " << cycle.index;
  }
}

TEST_F(RunCycles, RunsAtEachPeriodFromNowOn) {
  RecordingTask task(clock, 5, always(microseconds(300)));
  run(task);
  EXPECT_THAT(task.indices(), ElementsAre(0, 1, 2, 3, 4));
  expectOnPhase(task.seen());
  for (const Cycle& cycle : task.seen()) EXPECT_EQ(cycle.woken, cycle.scheduled);
  EXPECT_EQ(clock.now(), kStart + 4 * kPeriod + microseconds(300));
  EXPECT_EQ(statistics.cycles, 5u);
  EXPECT_EQ(statistics.overruns, 0u);
  EXPECT_EQ(statistics.wakeup.count(), 5u);
  EXPECT_EQ(statistics.wakeup.max(), Duration(0));
  EXPECT_EQ(statistics.work.count(), 5u);
  EXPECT_EQ(statistics.work.max(), microseconds(300));
}

// Work of 2.5 periods from 0 ends at 2.5: the cycles due at 1 and 2 are missed, the next is 3.
TEST_F(RunCycles, LeavesOutAndCountsTheCyclesThatHavePassed) {
  RecordingTask task(clock, 4, always(kPeriod * 5 / 2));
  run(task);
  EXPECT_THAT(task.indices(), ElementsAre(0, 3, 6, 9));
  expectOnPhase(task.seen());
  for (const Cycle& cycle : task.seen()) EXPECT_EQ(cycle.woken, cycle.scheduled);
  EXPECT_EQ(statistics.cycles, 4u);
  EXPECT_EQ(statistics.overruns, 6u);  // two after each cycle but the last
  EXPECT_EQ(statistics.work.max(), kPeriod * 5 / 2);
}

// Cycle 2 starts at 2 and ends at 5.25: 3, 4 and 5 are missed; 6, on the old phase, is the next.
TEST_F(RunCycles, KeepsThePhaseAfterOneLongCycle) {
  RecordingTask task(clock, 5, [](const Cycle& c) { return c.index == 2 ? kPeriod * 13 / 4 : Duration(0); });
  run(task);
  EXPECT_THAT(task.indices(), ElementsAre(0, 1, 2, 6, 7));
  expectOnPhase(task.seen());
  EXPECT_EQ(statistics.overruns, 3u);
}

TEST_F(RunCycles, MissesNothingWhenTheWorkEndsJustAsTheNextIsDue) {
  RecordingTask task(clock, 4, always(kPeriod));
  run(task);
  EXPECT_THAT(task.indices(), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(statistics.overruns, 0u);
  EXPECT_EQ(statistics.wakeup.max(), Duration(0));
}

TEST_F(RunCycles, MissesOneWhenTheWorkIsANanosecondTooLong) {
  RecordingTask task(clock, 3, always(kPeriod + Duration(1)));
  run(task);
  EXPECT_THAT(task.indices(), ElementsAre(0, 2, 4));
  EXPECT_EQ(statistics.overruns, 2u);
}

// Due at 0, 1, 2, woken at 0.3, 1, 3.25: the third ends at 3.45, so the one due at 3 is missed.
TEST_F(RunCycles, TellsLateWakingFromWork) {
  LateClock late(clock, {kPeriod * 3 / 10, Duration(0), kPeriod * 5 / 4});
  RecordingTask task(clock, 4, always(kPeriod / 5));
  runCycles(late, kPeriod, task, statistics, stop);
  EXPECT_THAT(task.indices(), ElementsAre(0, 1, 2, 4));
  expectOnPhase(task.seen());
  EXPECT_EQ(task.seen()[0].woken, kStart + kPeriod * 3 / 10);
  EXPECT_EQ(task.seen()[2].woken, kStart + kPeriod * 13 / 4);
  EXPECT_EQ(statistics.wakeup.max(), kPeriod * 5 / 4);
  EXPECT_EQ(statistics.work.max(), kPeriod / 5);
  EXPECT_EQ(statistics.overruns, 1u);
}

TEST_F(RunCycles, RunsNoCycleOnceItIsToldToStop) {
  stop = true;
  RecordingTask task(clock, 4, always(Duration(0)));
  run(task);
  EXPECT_TRUE(task.seen().empty());
  EXPECT_EQ(statistics.cycles, 0u);
}

TEST_F(RunCycles, EndsWithTheCycleInWhichItIsToldToStop) {
  RecordingTask task(clock, 100, [&](const Cycle& cycle) {
    if (cycle.index == 3) stop = true;
    return Duration(0);
  });
  run(task);
  EXPECT_THAT(task.indices(), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(statistics.cycles, 4u);
}

}  // namespace
}  // namespace relievo
