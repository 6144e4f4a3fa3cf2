// SPDX-License-Identifier: Apache-2.0
// Depth from two views against the scene's exact disparity.
#include "app/stereo/stereo_depth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/stereo/exposure.h"
#include "app/stereo/stereo_survey.h"
#include "tests/support/film/two_views.h"

namespace relievo {
namespace {

using test::boards;
using test::RightEye;
using test::TwoViews;

struct Errors {
  double wrong = 0;   // share of the pixels off by more than 2 pixels of disparity
  double median = 0;  // pixels
};

// The codes are read as `calibration` says: linear over the plan's range.
Errors errorsOf(const Frame& depth, const TwoViews& scene, DisparityRange range) {
  std::vector<double> errors;
  for (int r = 0; r < depth.height; ++r) {
    for (int c = 0; c < depth.width; ++c) {
      const std::uint8_t* at = depth.planes[0].data + r * depth.planes[0].stride_bytes + std::ptrdiff_t{2} * c;
      const double s = codeAt(depth.components[0], at) / 65535.0;
      errors.push_back(std::abs(range.lowest + s * (range.highest - range.lowest) - scene.disparity(c, r)));
    }
  }
  const auto wrong = std::ranges::count_if(errors, [](double e) { return e > 2; });
  std::ranges::nth_element(errors, errors.begin() + std::ssize(errors) / 2);
  return {static_cast<double>(wrong) / static_cast<double>(errors.size()), errors[errors.size() / 2]};
}

Errors errorsWith(const RightEye& eye) {
  const TwoViews scene = boards();
  StereoSurvey survey;
  EXPECT_TRUE(survey.add(scene.left(), scene.right(eye)).has_value());
  StereoDepth stereo(survey.finish().value());
  const auto depth = stereo.depthOf(scene.left(), scene.right(eye));
  EXPECT_TRUE(depth.has_value());
  const Errors errors = errorsOf(*depth, scene, stereo.plan().shots[0].range);
  std::printf("wrong by over 2 pixels: %.2f %%, median %.3f pixels\n", 100 * errors.wrong, errors.median);
  return errors;
}

TEST(StereoDepth, FindsTheBoardsOnBothSidesOfTheScreen) {
  const Errors errors = errorsWith({});
  EXPECT_LT(errors.wrong, 0.02);
  EXPECT_LT(errors.median, 0.25);
}

TEST(StereoDepth, MatchesLargeViewsReducedSoThatMemoryHasALimit) {
  EXPECT_EQ(matchedSize({1920, 1080}, {-40, 55}), (ViewSize{1920, 1080}));
  for (const int levels : {240, 480, 960}) {
    const ViewSize size = matchedSize({3840, 2160}, {-levels / 2, levels / 2 - 1});
    EXPECT_NEAR(static_cast<double>(size.cols) / size.rows, 16.0 / 9, 0.01);
    const double bytes = 3.0 * size.cols * size.rows * levels * size.cols / 3840;
    EXPECT_LT(bytes, 0.605e9) << levels;
    EXPECT_GT(bytes, 0.595e9) << levels;
  }
}

TEST(StereoDepth, IsAsGoodInViewsThatAreMatchedReduced) {
  TwoViews scene = boards(1600, 1000);
  scene.boards[0].per_row = 0.004;  // nowhere before the boards
  const DisparityRange range{-160, 160};
  const ViewPicture left = readView(scene.left());
  ASSERT_LT(matchedSize({left.cols, left.rows}, range).cols, 1300);
  const DisparityMap map = disparityOf(left, readView(scene.right()), range);
  ASSERT_EQ(map.cols, 1600);
  ASSERT_EQ(map.rows, 1000);
  std::vector<double> errors;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c)
      errors.push_back(std::abs(static_cast<double>(map.pixels[map.at(c, r)]) - scene.disparity(c, r)));
  }
  const auto wrong = static_cast<double>(std::ranges::count_if(errors, [](double e) { return e > 2; }));
  std::ranges::nth_element(errors, errors.begin() + std::ssize(errors) / 2);
  const double share = wrong / static_cast<double>(errors.size()), median = errors[errors.size() / 2];
  std::printf("wrong by over 2 pixels: %.2f %%, median %.3f pixels\n", 100 * share, median);
  EXPECT_LT(share, 0.02);
  EXPECT_LT(median, 0.25);
}

TEST(StereoDepth, IsAsGoodWithAViewTooLow) {
  const Errors errors = errorsWith({.down = 12});
  EXPECT_LT(errors.wrong, 0.12);  // 12 of the 200 rows are in the left view alone
  EXPECT_LT(errors.median, 0.25);
}

TEST(StereoDepth, IsAsGoodWithATurnedView) {
  const Errors errors = errorsWith({.degrees = 1});
  EXPECT_LT(errors.wrong, 0.03);
  EXPECT_LT(errors.median, 0.25);
}

TEST(StereoDepth, IsAsGoodWithAnotherExposure) {
  const Errors errors = errorsWith({.gain = 0.7, .offset = 20});
  EXPECT_LT(errors.wrong, 0.03);
  EXPECT_LT(errors.median, 0.25);
}

// What stands still keeps its code while something else comes nearer: the range is the shot's.
TEST(StereoDepth, DoesNotBreatheWithinAShot) {
  TwoViews scene = boards();
  StereoSurvey survey;
  std::vector<Frame> lefts, rights;
  for (int k = 0; k < 4; ++k) {
    scene.boards[2].disparity = 12 + 3 * k;
    lefts.push_back(scene.left());
    rights.push_back(scene.right());
    lefts.back().pts = rights.back().pts = mediaTime(0.5 * k);
    ASSERT_TRUE(survey.add(lefts.back(), rights.back()).has_value());
  }
  StereoDepth stereo(survey.finish().value());
  ASSERT_EQ(stereo.plan().shots.size(), 1u);
  const DisparityRange range = stereo.plan().shots[0].range;
  std::vector<double> means;
  for (std::size_t k = 0; k < lefts.size(); ++k) {
    const Frame depth = stereo.depthOf(lefts[k], rights[k]).value();
    double sum = 0;
    for (int r = 0; r < 30; ++r) {
      for (int c = 100; c < 150; ++c) {
        sum += codeAt(depth.components[0],
                      depth.planes[0].data + r * depth.planes[0].stride_bytes + std::ptrdiff_t{2} * c);
      }
    }
    means.push_back(sum / (30 * 50) / 65535 * (range.highest - range.lowest));
  }
  const auto [least, most] = std::ranges::minmax(means);
  EXPECT_LT(most - least, 0.1) << "pixels of disparity";
}

TEST(StereoDepth, InTheBlackTheLastReliefStays) {
  const TwoViews scene = boards();
  Frame left = scene.left(), right = scene.right(), black = scene.right({.gain = 0});
  StereoSurvey survey;
  ASSERT_TRUE(survey.add(left, right).has_value());
  StereoPlan plan = survey.finish().value();
  plan.shots.push_back(plan.shots[0]);
  plan.shots[1].begin = mediaTime(2);
  StereoDepth stereo(plan);
  const auto codesAt = [&](double seconds, Frame a, Frame b) {
    a.pts = b.pts = mediaTime(seconds);
    const Frame depth = stereo.depthOf(a, b).value();
    EXPECT_EQ(depth.pts, mediaTime(seconds));
    const std::uint8_t* const begin = depth.planes[0].data;
    return std::vector<std::uint8_t>(begin, begin + depth.planes[0].stride_bytes * depth.height);
  };
  const std::vector<std::uint8_t> before = codesAt(0, left, right);
  EXPECT_EQ(codesAt(0.5, black, black), before);
  EXPECT_EQ(codesAt(1, black, black), before);
  EXPECT_EQ(codesAt(1.5, left, right), before);
  EXPECT_EQ(codesAt(2, black, black), before) << "after a cut";
}

TEST(StereoDepth, AFilmThatBeginsInTheBlackBeginsFlat) {
  const TwoViews scene = boards();
  StereoPlan plan{.cols = scene.cols, .rows = scene.rows, .shots = {{.has_depth = true}}};
  const Frame black = scene.right({.gain = 0});
  const Frame depth = StereoDepth(plan).depthOf(black, black).value();
  EXPECT_EQ(codeAt(depth.components[0], depth.planes[0].data), 32767u);
}

// Fog, sky or snow: the spread of the right view's codes is about 2 levels.
TEST(StereoDepth, AFaintBrightViewIsNotBlank) {
  const TwoViews scene = boards();
  const auto shown = [&](double gain, double offset) {
    return readView(scene.right({.gain = gain, .offset = offset}));
  };
  ViewTone fog;
  fog.add(shown(0.12, 180));
  EXPECT_GT(fog.spread(0), 1);
  EXPECT_LT(fog.spread(0), 3);
  EXPECT_FALSE(isBlank(shown(0.12, 180)));
  EXPECT_TRUE(isBlank(shown(0.12, 0)));
  EXPECT_TRUE(isBlank(shown(0, 255))) << "the white of a fade";
  EXPECT_TRUE(isBlank(shown(0, 16))) << "black of limited range, taken as full";
}

TEST(StereoDepth, AShotWithABlackViewIsFlat) {
  const TwoViews scene = boards();
  StereoPlan plan{.cols = scene.cols, .rows = scene.rows, .shots = {{}}};
  const Frame depth = StereoDepth(plan).depthOf(scene.left(), scene.right()).value();
  EXPECT_EQ(codeAt(depth.components[0], depth.planes[0].data), 32767u);
}

}  // namespace
}  // namespace relievo
