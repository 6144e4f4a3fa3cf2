// SPDX-License-Identifier: Apache-2.0
// A still scene whose inverse depth is known, seen by a moving camera, and an estimator that drifts and flickers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "app/estimate/relief_fit.h"
#include "app/estimate/steady_relief.h"
#include "tests/support/film/still_scene.h"

namespace relievo {
namespace {

using test::endsOf;
using test::ReliefEnds;
using test::StillCamera;
using test::StillScene;
using test::StillView;

constexpr int kCols = 192, kRows = 108, kPictures = 40;
constexpr double kReach = StillScene::kNear - StillScene::kFar;

StillView viewOf(const StillScene& scene, const StillCamera& camera) {
  return {scene, camera, kCols, kRows};
}
RawPicture pictureOf(const StillView& view) {
  RawPicture picture(view.cols, view.rows);
  for (std::size_t i = 0; i < picture.size(); ++i) std::fill_n(picture.pixel(i), 3, view.light[i]);
  return picture;
}

// Over a film of `kPictures` it drifts by 20 % in scale and offset; each picture flickers by 5 % (standard deviation)
// in both, each sample by half a percent.
class MockEstimator {
 public:
  [[nodiscard]] DepthEstimate of(const StillView& view) {
    const double gone = static_cast<double>(number_++) / kPictures;
    const double scale = 20000 * (1 + 0.2 * gone) * (1 + 0.05 * normal_(random_));
    const double offset = 9000 + 20000 * kReach * (0.2 * gone + 0.05 * normal_(random_));
    DepthEstimate estimate{kCols, kRows, {}};
    for (const double depth : view.depth) {
      estimate.values.push_back(static_cast<float>(scale * (depth + 0.005 * kReach * normal_(random_)) + offset));
    }
    return estimate;
  }

 private:
  std::mt19937 random_{17};
  std::normal_distribution<double> normal_;
  int number_ = 0;
};

std::vector<std::uint32_t> codesOf(const Frame& relief) {
  std::vector<std::uint32_t> codes(static_cast<std::size_t>(relief.width) * static_cast<std::size_t>(relief.height));
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = codeAt(relief.components[0], relief.planes[0].data + 2 * i);
  return codes;
}

class SteadyShot : public testing::TestWithParam<StillCamera (*)(int)> {};
INSTANTIATE_TEST_SUITE_P(Cameras, SteadyShot, testing::Values(test::pan, test::zoom, test::stand));

TEST_P(SteadyShot, NeitherDriftsNorFlickers) {
  const StillScene scene;
  MockEstimator mock;
  SteadyRelief relief;
  std::vector<ReliefEnds> raw, steady;
  for (int k = 0; k < kPictures; ++k) {
    const StillView view = viewOf(scene, GetParam()(k));
    const DepthEstimate estimate = mock.of(view);
    raw.push_back(endsOf(view, [&](std::size_t i) { return static_cast<double>(estimate.values[i]); }, -1e9, 1e9));
    steady.push_back(endsOf(view, relief.add(pictureOf(view), estimate)));
  }
  const auto before = test::unrestOf(raw), after = test::unrestOf(steady);
  const double quieter_db = 20 * std::log10(before.flicker / after.flicker);
  std::printf("drift %.2f %% -> %.3f %%, flicker %.2f %% -> %.3f %%: %.1f dB down\n", 100 * before.drift,
              100 * after.drift, 100 * before.flicker, 100 * after.flicker, quieter_db);
  EXPECT_GT(before.drift, 0.1);
  EXPECT_GT(before.flicker, 0.05);
  EXPECT_LT(after.drift, 0.01);
  EXPECT_GT(quieter_db, 20);
  EXPECT_EQ(relief.shots(), 1u);
  EXPECT_GT(relief.wandered(), 0.2);
  EXPECT_LT(steady.back().rest, 0.02);
}

TEST(SteadyRelief, BeginsAnewAtACut) {
  MockEstimator mock;
  SteadyRelief whole, second;
  for (int k = 0; k < 6; ++k) {
    const StillView view = viewOf({.seed = 1}, test::pan(k));
    static_cast<void>(whole.add(pictureOf(view), mock.of(view)));
  }
  for (int k = 0; k < 4; ++k) {
    const StillView view = viewOf({.seed = 77}, {.u = 900.0 + k, .v = 200});
    const DepthEstimate estimate = mock.of(view);
    ASSERT_EQ(codesOf(whole.add(pictureOf(view), estimate)), codesOf(second.add(pictureOf(view), estimate))) << k;
  }
  EXPECT_EQ(whole.shots(), 2u);
}

TEST(SteadyRelief, AShotsFirstPictureFillsMostOfTheRelief) {
  MockEstimator mock;
  const StillView view = viewOf({}, {});
  std::vector<std::uint32_t> codes = codesOf(SteadyRelief{}.add(pictureOf(view), mock.of(view)));
  std::ranges::sort(codes);
  EXPECT_NEAR(codes[codes.size() / 20] / 65535.0, 0.15, 0.002);
  EXPECT_NEAR(codes[codes.size() - 1 - codes.size() / 20] / 65535.0, 0.85, 0.002);
  EXPECT_GT(codes.front(), 0u) << "beyond that it is squeezed, not cut off";
  EXPECT_LT(codes.back(), 65535u);
}

// The steady relief is not held where the scene changes: a part of the floor rises by a quarter of the depth.
TEST(SteadyRelief, FollowsAThingThatComesNearer) {
  constexpr int kMoves = 24;
  MockEstimator mock;
  SteadyRelief relief;
  std::vector<std::uint32_t> last;
  StillView view = viewOf({}, {});
  const StillView still = view;
  const auto isMoving = [](std::size_t i) {
    return i % kCols > 20 && i % kCols < 50 && i / kCols > 30 && i / kCols < 60;
  };
  for (int k = 0; k < kMoves; ++k) {
    for (std::size_t i = 0; i < view.depth.size(); ++i) {
      if (isMoving(i)) view.depth[i] = still.depth[i] + 0.2 * k / kMoves;
    }
    last = codesOf(relief.add(pictureOf(view), mock.of(view)));
  }
  const ReliefEnds ends = endsOf(view, [&](std::size_t i) { return last[i] / 65535.0; }, 0.16, 0.84);
  double off = 0;
  int count = 0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    const double truth = ends.far + (ends.near - ends.far) * (view.depth[i] - StillScene::kFar) / kReach;
    if (!isMoving(i) || truth > 0.84) continue;
    off += last[i] / 65535.0 - truth;
    ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_NEAR(off / count, 0, 0.03);
}

TEST(ReliefFit, IsExactAmongAThirdOfOthers) {
  std::vector<FitSample> samples;
  for (int i = 0; i < 90; ++i) {
    const double height = std::fmod(0.377 * i, 1);
    samples.push_back({.estimate = i % 3 == 0 ? 700 : 200 * height + 50, .height = height, .of = 4});
  }
  const auto fit = fitRelief(samples, {});
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->scale, 1 / 200.0, 1e-7);
  EXPECT_NEAR(fit->offset, -0.25, 1e-5);
}

// Least squares on estimates of a spread of .29 with noise of .06 would shrink the relief by 4 %.
TEST(ReliefFit, NoiseDoesNotShrinkTheRelief) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.06);
  for (const int of : {1, 9}) {
    std::vector<FitSample> samples;
    for (int i = 0; i < 20000; ++i) {
      const double truth = std::fmod(0.377 * i, 1);
      samples.push_back(
          {.estimate = 3 * (truth + noise(random)) + 1, .height = truth + noise(random) / std::sqrt(of), .of = of});
    }
    const auto fit = fitRelief(samples, {});
    ASSERT_TRUE(fit.has_value());
    EXPECT_NEAR(3 * fit->scale, 1, 0.008) << of;
  }
}

TEST(ReliefFit, AFlatSceneKeepsTheScaleOfThePictureBefore) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<FitSample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({.estimate = 5 + noise(random), .height = 0.4 + noise(random)});
  const auto fit = fitRelief(samples, {.scale = 0.5});
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->scale, 0.5);
  EXPECT_NEAR(fit->at(5), 0.4, 0.005);
}

TEST(ReliefFit, RefusesWhatDoesNotFit) {
  EXPECT_FALSE(fitRelief(std::vector<FitSample>(kLeastSamples - 1), {}).has_value());
  std::vector<FitSample> exchanged;
  for (int i = 0; i < 50; ++i) exchanged.push_back({.estimate = -0.1 * i, .height = 0.1 * i});
  EXPECT_FALSE(fitRelief(exchanged, {}).has_value());
}

// The blocks' motion alone, in quarters of a sample, would be off by 4.8 samples after 40 pictures, all of it one way.
TEST(PointTracks, StayOnTheirThings) {
  constexpr int kMany = 40;
  const StillScene scene;
  const auto grayAt = [&](int k) {
    const StillView view(scene, test::pan(k), 128, 72);
    GrayPicture gray(view.cols, view.rows);
    gray.bytes = view.light;
    return gray;
  };
  PointTracks tracks;
  GrayPicture before = grayAt(0);
  tracks.seed(before);
  const std::vector<TrackedPoint> at_first = tracks.points();
  for (std::size_t i = 0; i < at_first.size(); ++i) tracks.points()[i].age = static_cast<int>(i);
  for (int k = 1; k <= kMany; ++k) {
    GrayPicture now = grayAt(k);
    tracks.follow(before, now, motionBetween(before, now));
    before = std::move(now);
  }
  const std::size_t left = tracks.points().size();
  ASSERT_GT(left, at_first.size() / 5);
  double off_x = 0, off_y = 0;
  for (const TrackedPoint& point : tracks.points()) {
    const TrackedPoint& first = at_first[static_cast<std::size_t>(point.age)];
    off_x += (point.x - (first.x - 1.37 * kMany)) / static_cast<double>(left);
    off_y += (point.y - (first.y + 0.43 * kMany)) / static_cast<double>(left);
  }
  EXPECT_NEAR(off_x, 0, 0.25);
  EXPECT_NEAR(off_y, 0, 0.25);
}

}  // namespace
}  // namespace relievo
