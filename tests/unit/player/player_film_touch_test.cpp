// SPDX-License-Identifier: Apache-2.0
// The film under the finger alone: depth by hand, ticks in simulated time, no film and no screen.
#include "app/player/touch/film_touch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/mock/mock.h"
#include "platform/allocation_counter.h"
#include "platform/log.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/material_frames.h"

namespace relievo {
namespace {

using testing::IsEmpty;

// A plane at half of the volume's depth, 20 mm up.
DepthAround planeAt(double time_s) {
  DepthAround around{.present = test::makeGrayFrame(32, 24, 8, mediaTime(time_s), [](int, int) { return 128U; }),
                     .last = true,
                     .expected = true};
  return around;
}

class FilmTouchTest : public testing::Test {
 protected:
  FilmTouchTest() {
    setLogLevel(LogLevel::Error);
    profile_.position_mm = [](double) { return glm::dvec3(0, 0, 15); };  // 5 mm under the plane, once it is touched
  }
  void make() {
    touch_.reset();  // it uses the device until its end
    device_ = makeMockHaptic(profile_, clock_, bench_);
    touch_.emplace(FingerParts{device_.get()}, FingerParts{}, clock_, Ticking::ByHand, journal_);
    touch_->begin();
  }
  void startOn(const DepthAround& depth, const Material& material = {}, const Material& scale = {}) {
    touch_->setScene({}, DisplayVolume{}, material, scale);
    touch_->feed(depth, standing(depth));
    ASSERT_TRUE(touch_->followDevice());
    touch_->start();
  }
  [[nodiscard]] ClockSample standing(const DepthAround& depth) const { return {depth.present.pts, clock_.now(), 0}; }
  void goOn(int ms) {
    touch_->sleepUntil(clock_.now() + std::chrono::milliseconds(ms));
    touch_->drain(seeks_, nullptr);
  }
  [[nodiscard]] std::uint64_t noted(const std::string& part) const {
    std::uint64_t count = 0;
    for (const FaultEntry& fault : journal_.written().faults) {
      count += fault.what.find(part) == std::string::npos ? 0 : fault.count;
    }
    return count;
  }

  ManualClock clock_;
  Journal journal_{clock_};
  SeekTimes seeks_;
  MockHapticProfile profile_;
  std::shared_ptr<MockHapticBench> bench_ = std::make_shared<MockHapticBench>();
  std::unique_ptr<HapticDevice> device_;
  std::optional<FilmTouch> touch_;
};

// A closed film's decoder gets its memory back.
TEST_F(FilmTouchTest, NoFrameIsHeldAtRest) {
  make();
  DepthAround depth = planeAt(1);
  const std::weak_ptr<const void> held = depth.present.owner;
  startOn(depth);
  goOn(10);
  depth = {};
  EXPECT_FALSE(held.expired());
  touch_->rest();
  EXPECT_TRUE(held.expired());
}

TEST_F(FilmTouchTest, TheDeviceTicksFromStartToRest) {
  make();
  EXPECT_EQ(touch_->fingers()[0].device(), "");
  startOn(planeAt(1));
  EXPECT_EQ(touch_->fingers()[0].device(), "mock");
  goOn(100);
  EXPECT_NEAR(static_cast<double>(touch_->fingers()[0].session().summary().ticks), 100, 1);
  EXPECT_TRUE(touch_->fingers()[0].firstTick());
  EXPECT_TRUE(touch_->marks()[0]);
  touch_->rest();
  const auto ticks = touch_->fingers()[0].session().summary().ticks;
  goOn(100);
  EXPECT_EQ(touch_->fingers()[0].session().summary().ticks, ticks);
  EXPECT_EQ(bench_->force(), glm::dvec3(0));
  EXPECT_TRUE(touch_->waiting()) << "homed, for the next film";
  EXPECT_THAT(journal_.written().faults, IsEmpty());
}

// The finger comes from outside and goes to 15 mm; the plane's code is 128 of 255, which are 40 mm.
class TouchedMaterial : public FilmTouchTest {
 protected:
  static constexpr double kDeep = 40 * 128 / 255.0 - 15;
  double forceOn(const std::string& words) {
    profile_.position_mm = [](double t) { return glm::dvec3(0, 0, t < 0.05 ? 25 : 15); };
    make();
    startOn(planeAt(1), words.empty() ? Material{} : *parseMaterial(words));
    goOn(400);
    return bench_->force().z;
  }
};

TEST_F(TouchedMaterial, HasTheStiffnessOfTheFilm) {
  EXPECT_NEAR(forceOn("stiffness=.2"), 0.2 * kDeep, 0.005);
  EXPECT_THAT(journal_.written().faults, IsEmpty());
}

TEST_F(TouchedMaterial, HasThePlayersOwnStiffnessWithoutOne) {
  EXPECT_NEAR(forceOn(""), 0.5 * kDeep, 0.005);
}

TEST_F(TouchedMaterial, IsNoStifferThanTheDeviceHoldsAndALineSaysSo) {
  profile_.capabilities.max_stiffness_n_per_mm = 0.8;
  EXPECT_NEAR(forceOn("stiffness=3"), 0.8 * kDeep, 0.005);
  EXPECT_EQ(noted("stiffness 3 N/mm is felt as 0.8"), 1U);
}

// The left half is soft, the right one hard; the finger comes in at `x`.
class TouchedPlace : public FilmTouchTest {
 protected:
  static constexpr double kDeep = 40 * 128 / 255.0 - 15;
  double forceAt(double x, const std::string& scale) {
    profile_.position_mm = [x](double t) { return glm::dvec3(x, 0, t < 0.05 ? 25 : 15); };
    make();
    DepthAround depth = planeAt(1);
    depth.material = test::makeMaterialFrame(64, 48, DisplayVolume{}, depth.present.pts, [](double place, double) {
      return test::MaterialCodes{static_cast<std::uint8_t>(place < 0 ? 51 : 204), 0, 0};
    });
    startOn(depth, {}, *parseMaterial(scale));
    goOn(400);
    return bench_->force().z;
  }
};

TEST_F(TouchedPlace, HasTheStiffnessOfTheTrack) {
  EXPECT_NEAR(forceAt(-20, "stiffness=1"), 0.2 * kDeep, 0.005);
  EXPECT_NEAR(forceAt(20, "stiffness=1"), 0.8 * kDeep, 0.01);
  EXPECT_THAT(journal_.written().faults, IsEmpty());
}

TEST_F(TouchedPlace, IsNoStifferThanTheDeviceHoldsAndALineSaysSo) {
  profile_.capabilities.max_stiffness_n_per_mm = 0.6;
  EXPECT_NEAR(forceAt(-20, "stiffness=1"), 0.2 * kDeep, 0.005);
  EXPECT_NEAR(forceAt(20, "stiffness=1"), 0.6 * kDeep, 0.005);
  EXPECT_EQ(noted("places stiffer than 0.6 N/mm"), 2U);
}

TEST_F(FilmTouchTest, TheFirstTickAfterASeekTellsWhichFrameIsFelt) {
  make();
  startOn(planeAt(1));
  goOn(10);
  seeks_.asked(mediaTime(5), true, clock_.now());
  touch_->beginEpoch();
  const DepthAround sought = planeAt(5);
  touch_->feed(sought, standing(sought));
  seeks_.shown(mediaTime(5), clock_.now(), clock_.now());
  goOn(10);
  ASSERT_EQ(seeks_.entries().size(), 1U);
  EXPECT_EQ(seeks_.entries()[0].surface_s, 5);
}

TEST_F(FilmTouchTest, DepthThatIsMissingIsNotedOnceUntilItIsBack) {
  make();
  touch_->setScene({}, DisplayVolume{}, {});
  const DepthAround there = planeAt(1);
  DepthAround missing = there;
  missing.present = {};
  for (int round = 0; round < 2; ++round) {
    touch_->feed(there, standing(there));
    touch_->feed(missing, standing(there));
    touch_->feed(missing, standing(there));
  }
  EXPECT_EQ(noted("no depth at this time"), 2U);
  missing.expected = false;  // as in fast forward
  touch_->feed(there, standing(there));
  touch_->feed(missing, standing(there));
  EXPECT_EQ(noted("no depth at this time"), 2U);
}

TEST_F(FilmTouchTest, ADeviceThatGoesAwayIsLookedForAndComesBack) {
  make();
  startOn(planeAt(1));
  goOn(10);
  bench_->unplugged = true;
  goOn(10);
  EXPECT_EQ(noted("haptic device lost"), 1U);
  EXPECT_FALSE(touch_->marks()[0]);
  EXPECT_FALSE(touch_->followDevice());
  bench_->unplugged = false;
  goOn(2000);
  EXPECT_TRUE(touch_->followDevice());
  EXPECT_EQ(noted("haptic device back"), 1U);
}

// One ticks at 1 kHz, the other at 4.
TEST_F(FilmTouchTest, TwoFingersTickEachAtItsRateAndAllocateNothing) {
  const auto first = makeMockHaptic(profile_, clock_, bench_);
  const auto second = makeMockHaptic(profile_, clock_);
  ASSERT_EQ(second->setRate(4000).value(), 4000);
  touch_.emplace(FingerParts{first.get()}, FingerParts{second.get()}, clock_, Ticking::ByHand, journal_);
  touch_->begin();
  startOn(planeAt(1));
  goOn(10);
  const std::uint64_t before = threadAllocations();
  touch_->sleepUntil(clock_.now() + std::chrono::milliseconds(500));
  EXPECT_EQ(threadAllocations(), before);
  touch_->drain(seeks_, nullptr);
  ASSERT_EQ(touch_->fingers().size(), 2U);
  EXPECT_NEAR(static_cast<double>(touch_->fingers()[0].session().summary().ticks), 511, 1);
  EXPECT_NEAR(static_cast<double>(touch_->fingers()[1].session().summary().ticks), 4 * 510 + 1, 4);
  EXPECT_TRUE(touch_->marks()[0] && touch_->marks()[1]);
  touch_->stop();
  touch_.reset();
}

TEST_F(FilmTouchTest, WithoutADeviceTheFilmIsFollowedAndNothingIsFelt) {
  touch_.emplace(FingerParts{}, FingerParts{}, clock_, Ticking::ByHand, journal_);
  touch_->begin();
  touch_->setScene({}, DisplayVolume{}, {});
  touch_->feed(planeAt(1), standing(planeAt(1)));
  EXPECT_FALSE(touch_->followDevice());
  goOn(10);
  EXPECT_FALSE(touch_->marks()[0]);
  EXPECT_EQ(touch_->fingers()[0].device(), "");
  EXPECT_THAT(journal_.written().faults, IsEmpty());
}

}  // namespace
}  // namespace relievo
