// SPDX-License-Identifier: Apache-2.0
// Drawing keeps within its frame budget, with simulated drawing times.
#include "app/render/relief/detail_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace relievo {
namespace {

using std::chrono::milliseconds;

constexpr Duration kBudget = milliseconds(24);

// A renderer that takes `fixed_ms`, plus `fine_ms` at the finest level in proportion to the triangles, whose number is
// inversely proportional to the error. Returns the level after each frame.
std::vector<int> run(DetailLevel& detail, int frames, double fixed_ms, double fine_ms) {
  std::vector<int> levels;
  for (int i = 0; i < frames; ++i) {
    detail.drew(fromSeconds(1e-3 * (fixed_ms + fine_ms / detail.factor())));
    levels.push_back(detail.level());
  }
  return levels;
}

int changes(const std::vector<int>& levels) {
  int count = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) count += levels[i] != levels[i - 1];
  return count;
}

TEST(DetailLevel, BeginsAsFineAsIsWishedFor) {
  const DetailLevel detail(kBudget);
  EXPECT_EQ(detail.level(), 0);
  EXPECT_EQ(detail.factor(), 1.0);
}

TEST(DetailLevel, GoesCoarserUntilTheBudgetHolds) {
  // 10 + 30 / 2 = 25 ms at level 2, 10 + 30 / 2.83 = 20.6 at level 3.
  DetailLevel detail(kBudget);
  run(detail, 200, 10.0, 30.0);
  EXPECT_EQ(detail.level(), 3);
  EXPECT_NEAR(detail.factor(), 2.828, 0.001);
}

TEST(DetailLevel, GoesFinerAgainWhereHalfTheBudgetIsLeft) {
  DetailLevel detail(kBudget);
  run(detail, 200, 10.0, 30.0);
  run(detail, 200, 3.0, 5.0);
  EXPECT_EQ(detail.level(), 0);
}

TEST(DetailLevel, StopsAtTheCoarsest) {
  DetailLevel detail(kBudget);
  run(detail, 500, 100.0, 0.0);
  EXPECT_EQ(detail.level(), DetailLevel::kCoarsest);
  EXPECT_EQ(detail.factor() / detail.size(), 8.0);
}

TEST(DetailLevel, DrawsSmallerWhereThePixelsCost) {
  // 2 + 40 x size^2 ms: 42 ms at its size; 27.6 at .8; 18.4 at .64.
  DetailLevel detail(kBudget);
  for (int i = 0; i < 300; ++i) detail.drew(fromSeconds(1e-3 * (2 + 40 * detail.size() * detail.size())));
  EXPECT_EQ(detail.size(), 0.64);
  EXPECT_NEAR(detail.factor(), 2.828, 0.001);  // the relief was made coarser first
  for (int i = 0; i < 500; ++i) detail.drew(fromSeconds(1e-3 * (1 + 10 * detail.size() * detail.size())));
  EXPECT_EQ(detail.size(), 1.0);
  EXPECT_EQ(detail.factor(), 1.0);
}

TEST(DetailLevel, SettlesAndStaysOnASteadyMachine) {
  for (const double fixed_ms : {0.0, 5.0, 11.0, 20.0}) {
    for (const double fine_ms : {5.0, 20.0, 50.0, 200.0}) {
      DetailLevel detail(kBudget);
      run(detail, 20'000, fixed_ms, fine_ms);
      EXPECT_LE(changes(run(detail, 2000, fixed_ms, fine_ms)), 2) << fixed_ms << " ms + " << fine_ms << " ms";
    }
  }
}

TEST(DetailLevel, OneLateFrameChangesNothing) {
  DetailLevel detail(kBudget);
  run(detail, 20, 10.0, 5.0);
  detail.drew(milliseconds(150));
  EXPECT_EQ(changes(run(detail, 20, 10.0, 5.0)), 0);
  EXPECT_EQ(detail.level(), 0);
}

// A player of a film: shows each picture when it is due, or at once if that is past, and leaves out those whose
// successor is due. `fine_ms` is what drawing takes at the finest level; half of it grows with the triangles, half with
// the pixels.
class Playing {
 public:
  explicit Playing(Duration period) : period_(period), detail_(period * 3 / 5) {}

  // Returns how many pictures were left out.
  int play(int pictures, const std::function<double(int)>& fine_ms) {
    int left_out = 0;
    for (const int end = picture_ + pictures; picture_ < end; ++picture_) {
      now_ = std::max(now_, picture_ * period_);
      if (now_ >= (picture_ + 1) * period_) {
        ++left_out;
        continue;
      }
      const Duration took = drawing(fine_ms(picture_));
      detail_.drew(took, now_ - picture_ * period_);
      now_ += took;
    }
    return left_out;
  }
  void rehearse(double fine_ms) {
    while (detail_.rehearsed(drawing(fine_ms))) {
    }
  }
  [[nodiscard]] const DetailLevel& detail() const { return detail_; }

 private:
  [[nodiscard]] Duration drawing(double fine_ms) const {
    const double share = 0.5 / detail_.factor() + 0.5 * detail_.size() * detail_.size();
    return fromSeconds(1e-3 * fine_ms * share);
  }

  Duration period_, now_{0};
  DetailLevel detail_;
  int picture_ = 0;
};

constexpr Duration k60Hz = std::chrono::microseconds(16'667), k30Hz = std::chrono::microseconds(33'333);

std::function<double(int)> always(double ms) {
  return [ms](int) { return ms; };
}

TEST(DetailLevel, StaysWhileNoPictureIsLate) {
  Playing slow_but_in_time(k60Hz);
  EXPECT_EQ(slow_but_in_time.play(1000, always(15)), 0);
  EXPECT_EQ(slow_but_in_time.detail().level(), 0);
  Playing large(k30Hz);
  EXPECT_EQ(large.play(1000, always(28)), 0);
  EXPECT_EQ(large.detail().level(), 0);
}

TEST(DetailLevel, ADelayByOtherWorkIsNoProof) {
  Playing film(k60Hz);
  film.play(100, always(13));
  EXPECT_LE(film.play(600, [](int picture) { return picture % 60 == 0 ? 60.0 : 13.0; }), 30);
  EXPECT_EQ(film.detail().level(), 0);
}

TEST(DetailLevel, GivesWayWithinThreePicturesThatComeLaterAndLater) {
  const std::pair<double, int> cases[] = {{18, 0}, {20, 1}, {22, 1}, {25, 2}};
  for (const auto& [ms, left_out] : cases) {
    Playing film(k60Hz);
    EXPECT_EQ(film.play(60, always(11)), 0);
    EXPECT_LE(film.play(600, always(ms)), left_out) << ms;
    EXPECT_GT(film.detail().level(), 0) << ms;
  }
}

TEST(DetailLevel, BeginsWhereARehearsalSaysThatItHolds) {
  for (const double ms : {9.0, 12.0, 20.0, 30.0, 45.0}) {
    Playing film(k60Hz);
    film.rehearse(ms);
    const int level = film.detail().level();
    EXPECT_EQ(level > 0, ms > 12) << ms;
    EXPECT_EQ(film.play(600, always(ms)), 0) << ms;
    EXPECT_LE(film.detail().level(), level) << ms << ": only finer again";
  }
}

TEST(DetailLevel, TriesAgainMoreAndMoreSeldom) {
  // A machine that is idle while the relief is coarse and busy as soon as it is fine.
  DetailLevel detail(kBudget);
  std::vector<int> levels;
  for (int i = 0; i < 20'000; ++i) {
    detail.drew(detail.level() >= 2 ? milliseconds(5) : milliseconds(30));
    levels.push_back(detail.level());
  }
  // If it always waited 30 frames, there would be an attempt every 30 + 9 frames: over 500 attempts. It waits longer
  // after each failure: 30, 60, .. 3840, 3840, .. frames.
  EXPECT_LT(changes(levels), 40);
  EXPECT_GT(changes(levels), 10);
}

}  // namespace
}  // namespace relievo
