// SPDX-License-Identifier: Apache-2.0
// A film on machines of different speed, in simulated time: which pictures are left out, and for how long.
#include "app/player/film/decode_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <utility>

namespace relievo {
namespace {

constexpr double kPeriodMs = 1000.0 / 30;
constexpr int kBuffered = 8, kKeyInterval = 30;

// A reader that decodes one picture after the other into a buffer, every second one referred to by no other, and a
// player that takes them by its clock, in rounds of a millisecond.
class Machine {
 public:
  // The film begins with full buffers.
  explicit Machine(std::function<double(int)> cost) : cost_ms(std::move(cost)) {
    while (buffer_.size() < kBuffered) buffer_.push_back(next_++);
  }

  std::function<double(int)> cost_ms;  // of a picture
  bool source_slow = false;            // nothing comes from the source

  void play(double seconds) {
    for (const double end = now_ms_ + 1e3 * seconds; now_ms_ < end; now_ms_ += 1) {
      read();
      take();
      look();
    }
  }

  DecodePace pace;
  int changes = 0, hurries = 0, shown = 0;
  double latest_ms = 0;  // the most that a picture has been over for lack of the next one

 private:
  void read() {
    double left_ms = 1;
    decodes_ = false;
    while (left_ms > 0 && buffer_.size() < kBuffered && !source_slow) {
      decodes_ = true;
      const bool left_out = pace.leavesOut() && next_ % 2 == 1;
      const double missing_ms = left_out ? 0 : cost_ms(next_) - spent_ms_;
      if (missing_ms > left_ms) {
        spent_ms_ += left_ms;
        return;
      }
      left_ms -= missing_ms;
      spent_ms_ = 0;
      if (!left_out) buffer_.push_back(next_);
      ++next_;
    }
    rested_ms_ += source_slow ? 0 : left_ms;
  }

  void take() {
    for (; !buffer_.empty() && buffer_.front() * kPeriodMs <= now_ms_; buffer_.pop_front()) {
      present_ = buffer_.front();
      ++shown;
    }
  }

  void look() {
    const bool left_out = pace.leavesOut();
    const double late_ms = buffer_.empty() ? now_ms_ - (present_ + 1) * kPeriodMs : 0;
    latest_ms = std::max(latest_ms, late_ms);
    pace.look({.filled = buffer_.size() >= kBuffered / 2,
               .rested = fromSeconds(1e-3 * rested_ms_),
               .decodes = decodes_,
               .late = fromSeconds(1e-3 * late_ms)},
              MonotonicTime{} + fromSeconds(1e-3 * now_ms_));
    changes += left_out != pace.leavesOut();
    if (!pace.takeHurry()) return;
    ++hurries;
    const int key = static_cast<int>((now_ms_ + 300) / kPeriodMs) / kKeyInterval * kKeyInterval;
    if (key > next_) next_ = key;
  }

  double now_ms_ = 0, spent_ms_ = 0, rested_ms_ = 0;
  int next_ = 0, present_ = 0;
  bool decodes_ = false;
  std::deque<int> buffer_;
};

std::function<double(int)> each(double ms) {
  return [ms](int) { return ms; };
}

TEST(DecodePace, AFilmInTimeIsShownWhole) {
  for (const double ms : {3.0, 20.0, 31.0}) {
    Machine machine(each(ms));
    machine.play(60);
    EXPECT_EQ(machine.changes, 0) << ms;
    EXPECT_GE(machine.shown, 30 * 60 - 1) << ms;
  }
}

// 50 ms for each of 30 pictures a second is too much, 50 ms for each of 15 is not.
TEST(DecodePace, UnreferencedPicturesAreLeftOutBeforeAnythingIsLate) {
  Machine machine(each(50));
  machine.play(1);
  EXPECT_TRUE(machine.pace.leavesOut());
  machine.play(59);
  EXPECT_EQ(machine.changes, 1);
  EXPECT_EQ(machine.hurries, 0);
  EXPECT_LT(machine.latest_ms, 100);
  EXPECT_NEAR(machine.shown, 15 * 60, 30);
}

// 100 ms for each of 15 pictures a second: the film goes on by key frames, which come once a second.
TEST(DecodePace, AFilmThatIsLateAllTheSameHurriesToItsKeyFrames) {
  Machine machine(each(100));
  machine.play(60);
  EXPECT_TRUE(machine.pace.leavesOut());
  EXPECT_FALSE(machine.pace.waitsForSource());
  EXPECT_EQ(machine.changes, 1);
  EXPECT_GT(machine.hurries, 10);
  EXPECT_LT(machine.latest_ms, 1500);
  EXPECT_NEAR(machine.shown, 10 * 60, 60) << "the decoder is never idle";
}

TEST(DecodePace, AllPicturesComeBackWhenThereIsTimeForThem) {
  Machine machine(each(50));
  machine.play(20);
  machine.cost_ms = each(12);
  machine.play(4.5);  // three seconds of patience, and two spans at the most
  EXPECT_FALSE(machine.pace.leavesOut());
  EXPECT_EQ(machine.changes, 2);
  machine.play(60);
  EXPECT_EQ(machine.changes, 2);
}

TEST(DecodePace, ItDoesNotOscillateAtTheLimit) {
  for (const double ms : {32.0, 33.0, 34.0, 36.0, 40.0}) {
    Machine machine(each(ms));
    machine.play(600);
    EXPECT_LE(machine.changes, 1) << ms;
  }
}

// Most of the time goes into the pictures that are left out, so that the rest seems to leave time for them.
TEST(DecodePace, AnAttemptThatFailsIsRepeatedMoreAndMoreSeldom) {
  Machine machine([](int picture) { return picture % 2 == 1 ? 60.0 : 10.0; });
  machine.play(600);
  EXPECT_GT(machine.changes, 4);   // it tries
  EXPECT_LT(machine.changes, 24);  // after 3, 6, 12, .. 120 s, not every 3 s: 400
  EXPECT_EQ(machine.hurries, 0);
}

TEST(DecodePace, ASlowSourceIsNoReasonToLeaveAnythingOut) {
  Machine machine(each(10));
  machine.play(5);
  machine.source_slow = true;
  machine.play(5);
  EXPECT_FALSE(machine.pace.leavesOut());
  EXPECT_TRUE(machine.pace.waitsForSource());
  EXPECT_EQ(machine.hurries, 0);
}

}  // namespace
}  // namespace relievo
