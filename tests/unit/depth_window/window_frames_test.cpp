// SPDX-License-Identifier: Apache-2.0
// Which frames a window holds as time goes on and frames come in any order.
#include "app/depth_window/window_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using testing::Each;
using testing::ElementsAre;

constexpr DisplayVolume kVolume{160, 108, 40};

// A flat frame whose height identifies its scene.
TimedSurface frameAt(int time_ms, double height_mm = 10) {
  const Frame frame = test::makeReliefFrame(16, 12, kVolume, MediaTime(std::chrono::milliseconds(time_ms)),
                                            [&](double, double) { return height_mm; });
  return test::surfaceOf(frame, kVolume);
}

MediaTime ms(int time_ms) {
  return MediaTime(std::chrono::milliseconds(time_ms));
}

class WindowFramesTest : public testing::Test {
 protected:
  void add(std::initializer_list<int> times_ms) {
    for (const int t : times_ms) frames_.add(frameAt(t));
  }
  std::vector<std::int64_t> times() const {
    std::vector<std::int64_t> times;
    for (const TimedSurface& f : frames_.frames()) times.push_back((f.time - MediaTime{}).count() / 1'000'000);
    return times;
  }
  std::vector<std::uint32_t> shots() const {
    std::vector<std::uint32_t> shots;
    for (const TimedSurface& f : frames_.frames()) shots.push_back(f.shot);
    return shots;
  }
  WindowFrames frames_;
};

TEST_F(WindowFramesTest, HoldsThePresentFrameTwoBeforeItAndFourAfterIt) {
  frames_.moveTo(ms(0));
  add({0, 40, 80, 120, 160, 200});
  EXPECT_THAT(times(), ElementsAre(0, 40, 80, 120, 160)) << "four after the present one";
  EXPECT_TRUE(frames_.full());
  EXPECT_TRUE(frames_.moveTo(ms(130))) << "the frame at 0 is left behind";
  EXPECT_FALSE(frames_.full());
  add({200, 240, 280, 320});
  EXPECT_THAT(times(), ElementsAre(40, 80, 120, 160, 200, 240, 280));
  EXPECT_FALSE(frames_.moveTo(ms(150))) << "the same frame is the present one";
}

TEST_F(WindowFramesTest, AFrameThatComesLateTakesItsPlaceAndTheFarthestOneGoes) {
  frames_.moveTo(ms(0));
  add({0, 40, 120, 160, 200});
  EXPECT_TRUE(frames_.add(frameAt(80)));
  EXPECT_THAT(times(), ElementsAre(0, 40, 80, 120, 160));
  EXPECT_FALSE(frames_.add(frameAt(80))) << "one frame for one time";
  EXPECT_FALSE(frames_.add(frameAt(240))) << "too far ahead";
  frames_.moveTo(ms(120));
  EXPECT_FALSE(frames_.add(frameAt(10))) << "three newer ones are over";
  EXPECT_THAT(times(), ElementsAre(40, 80, 120, 160));
}

TEST_F(WindowFramesTest, ThePresentFrameStaysHoweverLongItIsTheLast) {
  frames_.moveTo(ms(0));
  add({0, 40});
  frames_.moveTo(ms(9000));
  EXPECT_THAT(times(), ElementsAre(0, 40));
  ASSERT_NE(frames_.at(ms(9000)), nullptr);
  EXPECT_EQ(frames_.at(ms(9000))->time, ms(40));
  EXPECT_EQ(frames_.at(ms(-1))->time, ms(0)) << "before the first frame it is the first";
}

TEST_F(WindowFramesTest, ShotsKeepTheirNumbersWhileTheWindowGoesOn) {
  for (int i = 0; i < 20; ++i) {
    frames_.moveTo(ms(40 * i));
    for (int k = i; k <= i + 4; ++k) frames_.add(frameAt(40 * k, k < 10 ? 10 : 30));
    if (i == 9) {
      EXPECT_THAT(shots(), ElementsAre(0, 0, 0, 1, 1, 1, 1));
    }
  }
  EXPECT_THAT(shots(), Each(1U)) << "nothing of the first shot is held any more";
}

TEST_F(WindowFramesTest, FillingAWindowLetsGoOfWhatItHeld) {
  SurfaceWindow window;
  const auto samples = std::make_shared<int>();
  for (TimedSurface& f : window.frames) f.owner = samples;
  frames_.moveTo(ms(0));
  add({0, 40});
  frames_.fill(window);
  EXPECT_EQ(window.count, 2);
  EXPECT_EQ(samples.use_count(), 1);
}

TEST_F(WindowFramesTest, ClearedItForgetsTheShotsToo) {
  frames_.moveTo(ms(0));
  frames_.add(frameAt(0, 10));
  frames_.add(frameAt(40, 30));
  EXPECT_EQ(frames_.frames().back().shot, 1U);
  frames_.clear();
  EXPECT_EQ(frames_.at(ms(0)), nullptr);
  frames_.add(frameAt(0, 30));
  frames_.add(frameAt(40, 30));
  EXPECT_EQ(frames_.frames().back().shot, 0U) << "a verdict on other pictures of these times";
}

}  // namespace
}  // namespace relievo
