// SPDX-License-Identifier: Apache-2.0
// The reliefs of a film of two views, in simulated time: how many, which, and how large, by what they take.
#include "app/player/views/relief_maker.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

namespace relievo {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(40);
using Ms = std::chrono::milliseconds;

// Takes as much time as the test says; the depth that it makes holds nothing but its picture's time.
class SlowMatcher final : public StereoMatcher {
 public:
  SlowMatcher(ManualClock& clock, std::array<Duration, 3> taken) : costs(taken), clock_(clock) {}
  [[nodiscard]] std::span<const int> sizes() const noexcept override { return kSizes; }
  void setSize(int cols) noexcept override { wished_ = cols; }
  [[nodiscard]] int size() const noexcept override { return size_; }
  void beginShot() noexcept override { cut_ = true; }
  [[nodiscard]] Frame depthOf(const Frame& left, const Frame&) override {
    if (std::exchange(cut_, false)) size_ = wished_;
    const std::size_t place = size_ == kSizes[0] ? 0 : size_ == kSizes[1] ? 1 : 2;
    clock_.sleepUntil(clock_.now() + costs[place]);
    Frame depth = grayFrame(std::make_shared<std::vector<std::uint16_t>>(1), 1, 1);
    depth.pts = left.pts;
    return depth;
  }
  [[nodiscard]] Caution caution() const noexcept override { return wrong; }
  std::array<Duration, 3> costs;  // of the three sizes
  Caution wrong;

 private:
  static constexpr std::array kSizes{160, 320, 640};
  ManualClock& clock_;
  bool cut_ = true;
  int size_ = 0, wished_ = 0;
};

class ReliefMakerTest : public testing::Test {
 protected:
  ReliefMaker& with(std::array<Duration, 3> costs) {
    auto matcher = std::make_unique<SlowMatcher>(clock_, costs);
    matcher_ = matcher.get();
    maker_ = std::make_unique<ReliefMaker>(std::move(matcher), clock_);
    maker_->begin(kPeriod);
    return *maker_;
  }
  static FramePair pairAt(int k) {
    FramePair pair;
    pair.color = pair.right = grayFrame(std::make_shared<std::vector<std::uint16_t>>(1), 1, 1);
    pair.color.pts = pair.right.pts = MediaTime(k * kPeriod);
    return pair;
  }
  // Plays so many pictures, each shown for its time; one core makes reliefs meanwhile. Returns the pictures that had
  // their relief before they were shown.
  std::vector<int> play(int pictures) {
    constexpr int kAhead = static_cast<int>(ReliefMaker::kAhead);
    std::vector<int> in_time;
    for (int k = 0; k <= kAhead; ++k) maker_->offer(pairAt(k));
    while (maker_->work() && clock_.now() < MonotonicTime(Ms(400))) {  // before the film starts
    }
    const MonotonicTime start = clock_.now();
    for (int shown = 0; shown < pictures; ++shown) {
      while (const auto relief = maker_->take()) {
        const auto k = static_cast<int>(relief->pts.time_since_epoch() / kPeriod);
        if (k >= shown) in_time.push_back(k);
      }
      maker_->passed(MediaTime(shown * kPeriod));
      maker_->offer(pairAt(shown + kAhead + 1));
      while (clock_.now() < start + (shown + 1) * kPeriod && maker_->work()) {
      }
      if (clock_.now() < start + (shown + 1) * kPeriod) clock_.sleepUntil(start + (shown + 1) * kPeriod);
    }
    return in_time;
  }

  ManualClock clock_;
  SlowMatcher* matcher_ = nullptr;
  std::unique_ptr<ReliefMaker> maker_;
};

TEST_F(ReliefMakerTest, AQuickMachineMakesOneForEachPictureAtTheLargestSize) {
  with({Ms(2), Ms(8), Ms(20)});
  const std::vector<int> made = play(50);
  EXPECT_EQ(maker_->summary().cols, 640);
  EXPECT_EQ(maker_->summary().dropped, 0U);
  ASSERT_GE(made.size(), 50U);
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_EQ(made[i], static_cast<int>(i));
  EXPECT_EQ(maker_->takeSlowness(), std::nullopt);
}

TEST_F(ReliefMakerTest, WhatIsWrongWithTheViewsIsSaidOnceAFilm) {
  with({Ms(2), Ms(8), Ms(20)});
  static_cast<void>(play(3));
  EXPECT_FALSE(maker_->takeCaution());
  matcher_->wrong = {"both views are one", "it is flat"};
  for (const bool first : {true, false}) {
    maker_->begin(kPeriod);
    static_cast<void>(play(10));
    ASSERT_TRUE(maker_->takeCaution()) << first;
    static_cast<void>(play(10));
    EXPECT_FALSE(maker_->takeCaution()) << first;
  }
}

TEST_F(ReliefMakerTest, TheSizeIsTheLargestThatKeepsWithinThePicturesTime) {
  with({Ms(6), Ms(22), Ms(90)});
  const std::vector<int> made = play(50);
  EXPECT_EQ(maker_->summary().cols, 320);
  EXPECT_GE(made.size(), 50U);
}

// 70 ms a relief are over one picture's 40: every second picture has one, evenly, and each before it is shown.
TEST_F(ReliefMakerTest, ASlowMachineMakesFewerButEvenly) {
  with({Ms(70), Ms(200), Ms(900)});
  std::vector<int> made = play(100);
  EXPECT_EQ(maker_->summary().cols, 160);
  ASSERT_GE(made.size(), 48U);
  made.erase(made.begin(), made.begin() + 4);
  for (std::size_t i = 1; i < made.size(); ++i) EXPECT_EQ(made[i] - made[i - 1], 2) << i;
  EXPECT_NEAR(static_cast<double>(maker_->summary().dropped), 50, 8);
}

// Something else has kept the machine for long: the reliefs begin again far enough ahead to come before their pictures.
TEST_F(ReliefMakerTest, OnceLateItDoesNotStayLate) {
  with({Ms(70), Ms(200), Ms(900)});
  play(20);
  int in_time = 0;
  const MonotonicTime start = clock_.now();
  const auto shownNow = [&] { return 60 + static_cast<int>((clock_.now() - start) / kPeriod); };
  while (shownNow() < 160) {
    for (int k = shownNow() + 1; k <= shownNow() + 12; ++k) maker_->offer(pairAt(k));
    maker_->passed(MediaTime(shownNow() * kPeriod));
    if (!maker_->work()) clock_.sleepUntil(clock_.now() + Ms(1));
    while (const auto relief = maker_->take()) in_time += relief->pts > MediaTime(shownNow() * kPeriod) ? 1 : 0;
  }
  EXPECT_GE(in_time, 54) << "of 50 while they play, and 6 ahead";
}

TEST_F(ReliefMakerTest, ItSaysOnceThatTheMachineIsSlow) {
  with({Ms(150), Ms(400), Ms(900)});
  play(60);
  const auto told = maker_->takeSlowness();
  ASSERT_TRUE(told);
  EXPECT_NE(told->find("makes about 5 reliefs a second from the film's two views, which has 25 pictures"),
            std::string::npos)
      << *told;
  play(20);
  EXPECT_EQ(maker_->takeSlowness(), std::nullopt);
}

TEST_F(ReliefMakerTest, AReliefWhosePictureIsGoneIsNotMade) {
  with({Ms(2), Ms(8), Ms(20)});
  for (int k = 0; k < 10; ++k) maker_->offer(pairAt(k));
  maker_->passed(MediaTime(6 * kPeriod));
  while (maker_->work()) {
  }
  EXPECT_EQ(maker_->take()->pts, MediaTime(7 * kPeriod));
  EXPECT_EQ(maker_->summary().dropped, 7U);
}

TEST_F(ReliefMakerTest, AJumpForgetsWhatWasOfferedAndMade) {
  with({Ms(2), Ms(8), Ms(20)});
  for (int k = 20; k < 26; ++k) maker_->offer(pairAt(k));
  EXPECT_TRUE(maker_->work());
  EXPECT_FALSE(maker_->idle());
  maker_->jump();
  EXPECT_TRUE(maker_->idle());
  EXPECT_EQ(maker_->take(), std::nullopt);
  maker_->offer(pairAt(3));  // a seek back
  EXPECT_TRUE(maker_->work());
  EXPECT_EQ(maker_->take()->pts, MediaTime(3 * kPeriod));
}

// Another process takes half of the machine meanwhile: after the next cut one size less is matched.
TEST_F(ReliefMakerTest, ReliefsThatHaveBecomeSlowAreSmallerAfterACut) {
  with({Ms(6), Ms(22), Ms(90)});
  maker_->offer(pairAt(0));
  EXPECT_TRUE(maker_->work());
  EXPECT_EQ(maker_->summary().cols, 320);
  matcher_->costs = {Ms(20), Ms(60), Ms(300)};
  for (int k = 1; k < 200; ++k) {
    maker_->offer(pairAt(k));
    maker_->work();
    if (k != 150) continue;
    EXPECT_EQ(maker_->summary().cols, 320) << "until the cut";
    matcher_->beginShot();
  }
  EXPECT_EQ(maker_->summary().cols, 160);
}

}  // namespace
}  // namespace relievo
