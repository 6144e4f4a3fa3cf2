// SPDX-License-Identifier: Apache-2.0
// The depth frames that the feeder puts into the window, and when it reports a change.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <vector>

#include "app/depth_window/surface_feeder.h"
#include "app/media/pair_reader.h"
#include "tests/support/film/material_frames.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr DisplayVolume kVolume{160, 108, 40};

Frame depthFrame(double pts_s, std::uint8_t code = 0, int width = 4, int height = 3) {
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(width * height), code);
  Frame frame;
  frame.pts = mediaTime(pts_s);
  frame.width = width;
  frame.height = height;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {samples->data(), width};
  frame.owner = samples;
  return frame;
}

FramePair pairAt(double color_s, double depth_s) {
  FramePair pair;
  pair.color.pts = mediaTime(color_s);
  pair.depth = depthFrame(depth_s);
  return pair;
}

FramePair flatPairAt(double color_s) {
  FramePair pair;
  pair.color.pts = mediaTime(color_s);
  return pair;
}

class SurfaceFeederTest : public testing::Test {
 protected:
  SurfaceFeederTest() { feeder_.setScene(DepthCalibration{}, kVolume); }
  // Shows pair `index` of `pairs` with the look-ahead; `last` is set when no pairs follow it.
  bool at(const std::vector<FramePair>& pairs, std::size_t index, double rate = 1) {
    std::vector<Frame> ahead;
    for (std::size_t i = index + 1; i < pairs.size() && ahead.size() < look_ahead_; ++i)
      ahead.push_back(pairs[i].depth);
    const bool last = index + 1 + ahead.size() == pairs.size();
    const auto changed = feeder_.update(pairs[index].depth, ahead, last, {mediaTime(0), MonotonicTime{}, rate});
    EXPECT_TRUE(changed);
    return changed && *changed;
  }
  const SurfaceWindow& window() {
    feeder_.fill(window_);
    return window_;
  }
  std::vector<double> times() {
    std::vector<double> found;
    for (int i = 0; i < window().count; ++i)
      found.push_back(toSeconds(window().frames[static_cast<std::size_t>(i)].time));
    return found;
  }

  std::size_t look_ahead_ = 4;
  SurfaceFeeder feeder_;
  SurfaceWindow window_;
};

std::vector<FramePair> film(int frames) {
  std::vector<FramePair> pairs;
  for (int i = 0; i < frames; ++i) pairs.push_back(pairAt(i, i));
  return pairs;
}

TEST_F(SurfaceFeederTest, HoldsTwoFramesBeforeThePresentAndFourAfterIt) {
  const auto pairs = film(10);
  at(pairs, 0);
  EXPECT_THAT(times(), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_FALSE(window().ended);  // the window holds everything buffered, but more will come
  at(pairs, 1);
  EXPECT_THAT(times(), ElementsAre(0, 1, 2, 3, 4, 5));
  look_ahead_ = 10;
  at(pairs, 2);
  EXPECT_THAT(times(), ElementsAre(0, 1, 2, 3, 4, 5, 6));
  at(pairs, 3);
  EXPECT_THAT(times(), ElementsAre(1, 2, 3, 4, 5, 6, 7));
}

// In a live film the screen shows the newest picture while an earlier moment is felt. A depth frame enters the window
// before its picture is shown.
TEST_F(SurfaceFeederTest, OfALiveFilmDepthIsHeardOfBeforeItsPicture) {
  EXPECT_FALSE(feeder_.hear(depthFrame(0))) << "nothing is shown yet";
  const auto show = [&](double picture, double felt) {
    ASSERT_TRUE(
        feeder_.update(depthFrame(picture), {}, false, {mediaTime(0), MonotonicTime{}, 1}, {}, mediaTime(felt)));
  };
  show(0, -1.2);
  for (int i = 1; i < 6; ++i) {
    EXPECT_TRUE(feeder_.hear(depthFrame(i))) << i;
    EXPECT_FALSE(feeder_.hear(depthFrame(i))) << "once";
    show(i, i - 1.2);
  }
  EXPECT_THAT(times(), ElementsAre(1, 2, 3, 4, 5)) << "two before 3.8 and its own";
  for (int i = 6; i < 10; ++i) static_cast<void>(feeder_.hear(depthFrame(i)));
  EXPECT_THAT(times(), ElementsAre(1, 2, 3, 4, 5, 6, 7)) << "four after it";
  feeder_.setCarried(std::chrono::milliseconds(7));
  EXPECT_EQ(window().carried, std::chrono::milliseconds(7));
}

TEST_F(SurfaceFeederTest, OfALiveFilmWhatIsHeardOfBringsItsMaterial) {
  ASSERT_TRUE(feeder_.update(depthFrame(0), {}, false, {}, {}, mediaTime(0)));
  const Frame material = test::makeMaterialFrame(16, 12, kVolume, mediaTime(1),
                                                 [](double, double) { return test::MaterialCodes{51, 0, 0}; });
  ASSERT_TRUE(feeder_.hear(depthFrame(1), material));
  const SurfaceWindow w = window();
  ASSERT_EQ(w.count, 2);
  ASSERT_NE(w.frames[1].material, nullptr);
  EXPECT_NEAR(w.frames[1].material->at(0, 0).stiffness, 0.2, 1e-9);
}

TEST_F(SurfaceFeederTest, HoldsADepthFrameOfALowerRateOnce) {
  // Depth at a third of the colour's rate: three pairs share a frame.
  std::vector<FramePair> pairs;
  for (int i = 0; i < 12; ++i) pairs.push_back(pairAt(i, i - i % 3));
  at(pairs, 0);
  EXPECT_THAT(times(), ElementsAre(0, 3));
  at(pairs, 4);
  EXPECT_THAT(times(), ElementsAre(0, 3, 6));
  at(pairs, 5);
  EXPECT_THAT(times(), ElementsAre(0, 3, 6, 9));
}

TEST_F(SurfaceFeederTest, KeepsTheTwoBeforeWhenPicturesWereLeftOut) {
  const auto pairs = film(10);
  at(pairs, 0);
  at(pairs, 3);
  EXPECT_THAT(times(), ElementsAre(1, 2, 3, 4, 5, 6, 7));
  at(pairs, 9);
  EXPECT_THAT(times(), ElementsAre(6, 7, 9));
}

TEST_F(SurfaceFeederTest, SaysWhenNothingChangedSoThatNothingIsPublished) {
  const auto pairs = film(10);
  EXPECT_TRUE(at(pairs, 0));
  EXPECT_FALSE(at(pairs, 0));
  EXPECT_TRUE(at(pairs, 0, 0.0));  // paused
  EXPECT_FALSE(at(pairs, 0, 0.0));
  EXPECT_TRUE(at(pairs, 1));
}

TEST_F(SurfaceFeederTest, EndsWithTheLastFrameInTheWindow) {
  look_ahead_ = 10;
  const auto pairs = film(7);
  at(pairs, 1);
  EXPECT_THAT(times(), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_FALSE(window().ended);  // the seventh frame is not in the window yet
  at(pairs, 2);
  EXPECT_THAT(times(), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_TRUE(window().ended);
}

TEST_F(SurfaceFeederTest, IsEmptyWhereThePresentPictureHasNoDepth) {
  std::vector<FramePair> pairs = film(3);
  pairs.push_back(flatPairAt(3));
  pairs.push_back(flatPairAt(4));
  at(pairs, 2);
  EXPECT_THAT(times(), ElementsAre(2));
  EXPECT_FALSE(window().ended);
  EXPECT_TRUE(at(pairs, 3));
  EXPECT_THAT(times(), IsEmpty());
  EXPECT_FALSE(at(pairs, 4));
}

TEST_F(SurfaceFeederTest, BeginsAnEpochWithoutTheFramesOfTheLastOne) {
  const auto pairs = film(10);
  at(pairs, 5);
  const auto before = window().epoch;
  feeder_.beginEpoch();
  at(pairs, 1);
  EXPECT_THAT(times(), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_NE(window().epoch, before);
}

TEST_F(SurfaceFeederTest, AFrameOfAnotherSizeBeginsAnEpochWhenItIsPresent) {
  auto pairs = film(4);
  pairs[2].depth = depthFrame(2, 0, 8, 6);
  pairs[3].depth = depthFrame(3, 0, 8, 6);
  at(pairs, 1);
  EXPECT_THAT(times(), ElementsAre(1));
  const auto before = window().epoch;
  at(pairs, 2);
  EXPECT_THAT(times(), ElementsAre(2, 3));
  EXPECT_NE(window().epoch, before);
  EXPECT_EQ(window().frames[0].field.cols(), 8);
}

TEST_F(SurfaceFeederTest, ReadsHeightsByTheCalibration) {
  FramePair pair;
  pair.depth = depthFrame(0, 51);  // 51/255 of 40 mm
  ASSERT_TRUE(feeder_.update(pair.depth, {}, true, {}));
  EXPECT_NEAR(window().frames[0].field.heightMm(1, 1), 8.0, 1e-12);
}

TEST_F(SurfaceFeederTest, ReleasesWhatTheWindowHeldBefore) {
  auto pairs = film(3);
  at(pairs, 0);
  EXPECT_EQ(window().count, 3);
  const std::weak_ptr<const void> newest = window_.frames[2].owner;
  pairs.clear();
  feeder_.beginEpoch();
  EXPECT_FALSE(newest.expired());
  feeder_.fill(window_);
  EXPECT_TRUE(newest.expired());
}

TEST_F(SurfaceFeederTest, RefusesDepthThatCannotBeFeltAndEmptiesTheWindow) {
  const auto pairs = film(2);
  at(pairs, 0);
  FramePair broken = pairAt(5, 5);
  broken.depth.width = 0;
  EXPECT_FALSE(feeder_.update(broken.depth, {}, false, {}));
  EXPECT_THAT(times(), IsEmpty());
}

TEST_F(SurfaceFeederTest, TellsWhichFrameTheSurfaceBeginsFrom) {
  EXPECT_FALSE(feeder_.frameAt(mediaTime(0)));
  const auto pairs = film(10);
  at(pairs, 1);
  at(pairs, 2);
  EXPECT_EQ(feeder_.frameAt(mediaTime(2.0)), mediaTime(2));
  EXPECT_EQ(feeder_.frameAt(mediaTime(2.9)), mediaTime(2));
  EXPECT_EQ(feeder_.frameAt(mediaTime(3.0)), mediaTime(3));
  EXPECT_EQ(feeder_.frameAt(mediaTime(0.5)), mediaTime(1));  // before the window: its first frame
}

TEST_F(SurfaceFeederTest, AMaterialPictureGoesWithTheDepthOfItsTimeWithoutACopy) {
  const auto pairs = film(3);
  std::vector<Frame> materials;
  for (int k = 0; k < 3; ++k) {
    materials.push_back(test::makeMaterialFrame(16, 12, kVolume, mediaTime(k), [k](double, double) {
      return test::MaterialCodes{static_cast<std::uint8_t>(51 * (k + 1)), 0, 0};
    }));
  }
  materials[1] = Frame{};
  const std::vector<Frame> ahead{pairs[1].depth, pairs[2].depth};
  ASSERT_TRUE(feeder_.update(pairs[0].depth, ahead, true, {mediaTime(0), MonotonicTime{}, 1},
                             {materials[0], std::span<const Frame>(materials).subspan(1)}));
  const SurfaceWindow& w = window();
  ASSERT_EQ(w.count, 3);
  ASSERT_NE(w.frames[0].material, nullptr);
  EXPECT_NEAR(w.frames[0].material->at(0, 0).stiffness, 0.2, 1e-9);
  EXPECT_EQ(w.frames[1].material, nullptr) << "none at this time";
  EXPECT_NEAR(w.frames[2].material->at(0, 0).stiffness, 0.6, 1e-9);
  EXPECT_GT(materials[2].owner.use_count(), 1) << "held, not copied";
}

}  // namespace
}  // namespace relievo
