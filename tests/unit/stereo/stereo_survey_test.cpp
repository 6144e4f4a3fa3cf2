// SPDX-License-Identifier: Apache-2.0
// What is found out about a film of two views before its depth is made.
#include "app/stereo/stereo_survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "tests/support/film/two_views.h"

namespace relievo {
namespace {

using test::boards;
using test::RightEye;
using test::titleInTheBlack;
using test::TwoViews;
using test::withGrain;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Frame at(Frame frame, double seconds) {
  frame.pts = mediaTime(seconds);
  return frame;
}

// The plan of one still pair, shown for a second.
Result<StereoPlan> planOf(const Frame& left, const Frame& right) {
  StereoSurvey survey;
  for (int k = 0; k < 2; ++k) {
    EXPECT_TRUE(survey.add(at(left, 0.5 * k), at(right, 0.5 * k)).has_value());
  }
  return survey.finish();
}

TEST(StereoSurvey, ReachesFromBehindTheScreenToBeforeIt) {
  const TwoViews scene = boards();
  const auto plan = planOf(scene.left(), scene.right()).value();
  ASSERT_THAT(plan.shots, SizeIs(1));
  EXPECT_THAT(plan.notes, IsEmpty());
  EXPECT_FALSE(plan.views_swapped);
  const ShotPlan& shot = plan.shots[0];
  EXPECT_TRUE(shot.has_depth);
  EXPECT_FALSE(shot.is_aligned);
  EXPECT_FALSE(shot.is_balanced);
  EXPECT_LE(shot.range.lowest, -8);  // the wall's farthest
  EXPECT_GE(shot.range.lowest, -14);
  EXPECT_GE(shot.range.highest, 13);
  EXPECT_LE(shot.range.highest, 19);
}

TEST(StereoSurvey, TheBlackAroundATitleDoesNotWidenTheRange) {
  const TwoViews title = titleInTheBlack();
  const auto plan = planOf(withGrain(title.left(), 1), withGrain(title.right(), 2)).value();
  const ShotPlan& shot = plan.shots[0];
  EXPECT_TRUE(shot.has_depth);
  EXPECT_GE(shot.range.lowest, 0);
  EXPECT_LE(shot.range.lowest, 4);
  EXPECT_GE(shot.range.highest, 6);
  EXPECT_LE(shot.range.highest, 9);
}

// A bright wall without texture, and 5 specks of 10 x 4 pixels in it: what is found there is chance.
TEST(StereoSurvey, AFewSpecksInAnEvenShotTellNoRange) {
  TwoViews even = boards();
  even.boards = {{0, 0, 320, 200, 0, 0, {400, 400, 400}}};
  for (int k = 0; k < 5; ++k) {
    const double x = 60 + 45 * k, y = 40 + 25 * k;
    even.boards.push_back({x, y, x + 10, y + 4, k % 2 == 0 ? 12.0 + k : -12.0 - k, 0, {60, 60, 60}});
  }
  const auto plan = planOf(even.left(), even.right());
  ASSERT_FALSE(plan.has_value());
  EXPECT_THAT(plan.error().message, HasSubstr("nothing in common"));
}

TEST(StereoSurvey, SeesThatTheViewsAreSwapped) {
  const TwoViews scene = boards();
  EXPECT_TRUE(planOf(scene.right(), scene.left()).value().views_swapped);
}

TEST(StereoSurvey, SaysWhetherThePicturesTellTheOrder) {
  const TwoViews scene = boards();
  TwoViews wall = scene;
  wall.boards.resize(1);
  EXPECT_TRUE(planOf(scene.left(), scene.right()).value().order_known);
  EXPECT_FALSE(planOf(wall.left(), wall.right()).value().order_known);
}

TEST(StereoSurvey, MeasuresAViewThatLiesTooLow) {
  const TwoViews scene = boards();
  const auto plan = planOf(scene.left(), scene.right({.down = 12})).value();
  EXPECT_TRUE(plan.shots[0].is_aligned);
  EXPECT_NEAR(plan.shots[0].alignment.shift, -12, 0.2);
  EXPECT_NEAR(plan.shots[0].alignment.turn, 0, 0.002);
  EXPECT_NEAR(plan.shots[0].alignment.zoom, 1, 0.003);
  EXPECT_THAT(plan.notes, ElementsAre(HasSubstr("straightened in 1 of 1 shot: by up to 12")));
}

TEST(StereoSurvey, MeasuresAViewThatIsTurned) {
  const TwoViews scene = boards();
  const auto plan = planOf(scene.left(), scene.right({.degrees = 1})).value();
  EXPECT_TRUE(plan.shots[0].is_aligned);
  EXPECT_NEAR(plan.shots[0].alignment.turn, -0.01745, 0.002);
  EXPECT_THAT(plan.notes, ElementsAre(HasSubstr("straightened")));
}

TEST(StereoSurvey, MeasuresTheExposuresDifference) {
  const TwoViews scene = boards();
  const auto plan = planOf(scene.left(), scene.right({.gain = 0.7, .offset = 20})).value();
  const ShotPlan& shot = plan.shots[0];
  EXPECT_TRUE(shot.is_balanced);
  EXPECT_NEAR(shot.exposure.gain[0], 1 / 0.7, 0.08);  // the eyes see a little more or less of each board
  EXPECT_NEAR(shot.exposure.offset[0], -20 / 0.7, 8);
  EXPECT_THAT(plan.notes, ElementsAre(HasSubstr("exposure was balanced in 1 of 1 shot")));
}

TEST(StereoSurvey, RefusesABlackView) {
  const TwoViews scene = boards();
  const auto plan = planOf(scene.left(), scene.right({.gain = 0}));
  ASSERT_FALSE(plan.has_value());
  EXPECT_THAT(plan.error().message, HasSubstr("one of its two views is black"));
}

TEST(StereoSurvey, RefusesOnePictureTwice) {
  const TwoViews scene = boards();
  const auto plan = planOf(scene.left(), scene.left());
  ASSERT_FALSE(plan.has_value());
  EXPECT_THAT(plan.error().message, HasSubstr("the same picture"));
}

// A film of one view, coded twice: each view has errors of its own.
TEST(StereoSurvey, RefusesOnePictureWithOtherErrors) {
  const TwoViews scene = boards();
  const auto plan = planOf(scene.left(), scene.leftWithGrain(8));
  ASSERT_FALSE(plan.has_value());
  EXPECT_THAT(plan.error().message, HasSubstr("the same picture"));
}

// A trailer of one view before a film of two: its noise does not fill the whole depth.
TEST(StereoSurvey, AShotOfOnePictureTwiceIsFlatInAFilmWithDepth) {
  const TwoViews scene = boards();
  TwoViews trailer = boards();
  for (auto& board : trailer.boards) board.color = {255 - board.color[0], 255 - board.color[1], 60};
  StereoSurvey survey;
  ASSERT_TRUE(survey.add(trailer.left(), trailer.leftWithGrain(8)).has_value());
  ASSERT_TRUE(survey.add(at(scene.left(), 1), at(scene.right(), 1)).has_value());
  const auto plan = survey.finish().value();
  ASSERT_THAT(plan.shots, SizeIs(2));
  EXPECT_FALSE(plan.shots[0].has_depth);
  EXPECT_TRUE(plan.shots[1].has_depth);
  EXPECT_THAT(plan.notes, ElementsAre(HasSubstr("1 of 2 shots are flat: both views are the same picture")));
}

TEST(StereoSurvey, EachShotHasItsOwnRangeFromItsFirstPictureOn) {
  TwoViews first = boards(), second = boards();
  for (auto& board : second.boards) std::swap(board.color[0], board.color[2]), board.color[1] = 255 - board.color[1];
  second.boards[2].disparity = 5;
  StereoSurvey survey;
  for (int k = 0; k < 12; ++k) {
    TwoViews& scene = k < 6 ? first : second;
    if (k < 6) first.boards[2].disparity = 12.5 + k;  // comes nearer within the shot
    ASSERT_TRUE(survey.add(at(scene.left(), 0.5 * k), at(scene.right(), 0.5 * k)).has_value());
  }
  const auto plan = survey.finish().value();
  ASSERT_THAT(plan.shots, SizeIs(2));
  EXPECT_EQ(plan.shots[1].begin, mediaTime(3));
  EXPECT_GE(plan.shots[0].range.highest, 17);
  EXPECT_LE(plan.shots[1].range.highest, 11);
  EXPECT_EQ(&plan.at(mediaTime(2.9)), &plan.shots[0]);
  EXPECT_EQ(&plan.at(mediaTime(3)), &plan.shots[1]);
}

// Of a long shot every second look is dropped, and those that stay are still whole.
TEST(StereoSurvey, ALongShotHasTheRangeOfAShortOne) {
  const TwoViews scene = boards(160, 100);
  const Frame left = scene.left(), right = scene.right();
  StereoSurvey survey;
  for (int k = 0; k < 30; ++k) ASSERT_TRUE(survey.add(at(left, 0.5 * k), at(right, 0.5 * k)).has_value());
  const ShotPlan shot = survey.finish().value().shots.at(0), brief = planOf(left, right).value().shots.at(0);
  EXPECT_TRUE(shot.has_depth);
  EXPECT_EQ(shot.range.lowest, brief.range.lowest);
  EXPECT_EQ(shot.range.highest, brief.range.highest);
}

TEST(StereoSurvey, RefusesAPictureOfAnotherSize) {
  StereoSurvey survey;
  const TwoViews scene = boards(), smaller = boards(160, 100);
  ASSERT_TRUE(survey.add(scene.left(), scene.right()).has_value());
  EXPECT_FALSE(survey.add(at(smaller.left(), 1), at(smaller.right(), 1)).has_value());
}

}  // namespace
}  // namespace relievo
