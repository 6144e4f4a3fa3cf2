// SPDX-License-Identifier: Apache-2.0
// Depth from two views, quickly: against the scene's exact disparity.
#include "app/stereo/quick/quick_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "app/stereo/eye_order.h"
#include "app/stereo/quick/row_shift.h"
#include "app/stereo/quick/small_view.h"
#include "tests/support/film/two_views.h"

namespace relievo {
namespace {

using test::boards;
using test::RightEye;
using test::TwoViews;

constexpr int kCols = 640, kRows = 360;

double codeOf(const Frame& depth, int c, int r) {
  return codeAt(depth.components[0], depth.planes[0].data + r * depth.planes[0].stride_bytes + std::ptrdiff_t{2} * c);
}

// Codes are linear in disparity over a range that the film does not state. The line that fits all of them best converts
// them to pixels of disparity.
struct Fit {
  double scale = 0, offset = 0;
  std::vector<double> errors;  // pixels

  Fit(const Frame& depth, const TwoViews& scene) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int r = 0; r < depth.height; ++r) {
      for (int c = 0; c < depth.width; ++c) {
        const double code = codeOf(depth, c, r), d = scene.disparity(c, r);
        n += 1, x += code, y += d, xx += code * code, xy += code * d;
      }
    }
    scale = (n * xy - x * y) / (n * xx - x * x);
    offset = (y - scale * x) / n;
    for (int r = 0; r < depth.height; ++r) {
      for (int c = 0; c < depth.width; ++c)
        errors.push_back(std::abs(offset + scale * codeOf(depth, c, r) - scene.disparity(c, r)));
    }
  }
  [[nodiscard]] double median() {
    std::ranges::nth_element(errors, errors.begin() + std::ssize(errors) / 2);
    return errors[errors.size() / 2];
  }
  [[nodiscard]] double wrong() const {
    const auto count = std::ranges::count_if(errors, [](double e) { return e > 2; });
    return static_cast<double>(count) / static_cast<double>(errors.size());
  }
};

Fit fitOf(int matched_cols, const RightEye& eye = {}) {
  const TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  quick.setMatchedCols(matched_cols);
  Fit fit(quick.depthOf(scene.left(), scene.right(eye)), scene);
  std::printf("matched at %d: median %.3f pixels, wrong by over 2 pixels %.2f %%\n", matched_cols, fit.median(),
              100 * fit.wrong());
  return fit;
}

TEST(QuickDepth, ARightViewThatLiesTooLowOrTooHighIsBroughtToTheHeightOfTheLeftOne) {
  for (const double down : {12.0, -7.5, 3.0}) {
    Fit fit = fitOf(320, {.down = down});
    EXPECT_LT(fit.median(), 0.25) << down;
    EXPECT_LT(fit.wrong(), 0.07) << down << ": what only one view shows, at the bottom, is more";
  }
}

TEST(QuickDepth, ARightViewThatIsTurnedIsTurnedBack) {
  for (const RightEye& eye : {RightEye{.degrees = 1}, RightEye{.down = 8, .degrees = -1}, RightEye{.degrees = 0.3}}) {
    Fit fit = fitOf(160, eye);
    EXPECT_LT(fit.median(), 0.25) << eye.degrees;
    EXPECT_LT(fit.wrong(), 0.07) << eye.degrees << ": what only one view shows, at the border, is more";
  }
}

TEST(QuickDepth, ViewsOfOneHeightStayAsTheyAre) {
  const TwoViews scene = boards(kCols, kRows);
  const auto view = [](const Frame& frame) {
    ViewPicture small;
    readSmall(frame, {kCols, kRows}, small);
    return small;
  };
  EXPECT_EQ(rowShift(view(scene.left()), view(scene.right())), 0);
  EXPECT_EQ(rowShift(view(scene.left()), view(scene.right({.down = 0.3}))), 0);
  EXPECT_NEAR(rowShift(view(scene.left()), view(scene.right({.down = 5.5}))), 5.5, 0.3);
  EXPECT_EQ(turnBetween(view(scene.left()), view(scene.right())), 0);
  EXPECT_EQ(turnBetween(view(scene.left()), view(scene.right({.down = 5.5}))), 0);
}

// A hand that comes before everything else: all of it lies at the near end, and nothing around it changes.
TEST(QuickDepth, WhatComesNearerLaterIsFoundAndLiesAtTheEnd) {
  TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  const Frame before = quick.depthOf(scene.left(), scene.right());
  scene.boards.push_back({100, 60, 300, 260, 60, 0, {150, 150, 90}});
  Frame after;
  for (int i = 0; i < 5; ++i) after = quick.depthOf(scene.left(), scene.right());
  int at_end = 0, all = 0;
  double moved = 0;
  for (int r = 80; r < 240; ++r) {
    for (int c = 120; c < 280; ++c, ++all) at_end += codeOf(after, c, r) > 65000 ? 1 : 0;
    for (int c = 520; c < 620; ++c) moved = std::max(moved, std::abs(codeOf(after, c, r) - codeOf(before, c, r)));
  }
  EXPECT_GT(at_end, 0.98 * all);
  EXPECT_LT(moved, 2000);
}

// A finger feels slopes: where a matcher finds whole pixels, a slope has terraces, level with walls between them.
TEST(QuickDepth, ASlopeHasNoTerraces) {
  constexpr double kPerRow = 0.1;
  constexpr int kStep = 4, kMargin = 24;
  const TwoViews scene{.cols = kCols, .rows = kRows, .boards = {{0, 0, kCols, kRows, -18, kPerRow, {120, 120, 120}}}};
  for (const int cols : {160, 320, 640}) {
    QuickDepth quick;
    quick.setMatchedCols(cols);
    const Frame depth = quick.depthOf(scene.left(), scene.right());
    const double scale = Fit(depth, scene).scale;
    double squares = 0, count = 0;
    for (int r = kMargin; r + kStep < kRows - kMargin; ++r) {
      for (int c = 60; c < kCols - 60; ++c, ++count) {
        const double slope = scale * (codeOf(depth, c, r + kStep) - codeOf(depth, c, r)) / kStep;
        squares += std::pow((slope - kPerRow) / kPerRow, 2);
      }
    }
    EXPECT_LT(std::sqrt(squares / count), cols < 320 ? 0.35 : 0.15) << cols;
    std::printf("matched at %d: slope off by %.1f %% rms\n", cols, 100 * std::sqrt(squares / count));
  }
}

TEST(QuickDepth, FindsTheBoardsAtEverySize) {
  for (const int cols : QuickDepth::kMatchedCols) {
    Fit fit = fitOf(cols);
    EXPECT_GT(fit.scale, 0) << "near is high";
    EXPECT_LT(fit.median(), 0.25) << cols;
    EXPECT_LT(fit.wrong(), cols < 320 ? 0.06 : 0.04) << cols;
  }
}

// The first view is the right eye's. The depth is that of the first view all the same: the board with a disparity of
// 12.5 pixels is near, at its place in that view.
TEST(QuickDepth, ViewsInTheWrongOrderAreMatchedInTheRightOne) {
  const TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  quick.setMatchedCols(320);
  const Frame depth = quick.depthOf(scene.right(), scene.left());
  const auto& board = scene.boards[2];
  const int middle = static_cast<int>(0.5 * (board.left + board.right) - board.disparity);
  const double near = codeOf(depth, middle, 170);
  EXPECT_GT(near, codeOf(depth, static_cast<int>(board.left - board.disparity) - 8, 170) + 10000);
  EXPECT_GT(near, codeOf(depth, static_cast<int>(board.right - board.disparity) + 8, 170) + 10000);
  static_cast<void>(quick.depthOf(scene.right(), scene.left()));
  EXPECT_TRUE(quick.range()) << "it is one shot";
  QuickDepth in_order;
  static_cast<void>(in_order.depthOf(scene.left(), scene.right()));
  EXPECT_FALSE(in_order.areSwapped());
}

// A shot that begins with nothing in front of its wall shows the order of its views only when something comes.
TEST(QuickDepth, ViewsInTheWrongOrderAreToldByALaterPictureOfTheShot) {
  const TwoViews scene = boards(kCols, kRows);
  TwoViews wall = scene;
  wall.boards.resize(1);
  const Frame wall_left = wall.left(), wall_right = wall.right(), left = scene.left(), right = scene.right();
  QuickDepth quick, in_order;
  Frame depth;
  for (int i = 0; i < 6; ++i) {
    depth = i < 3 ? quick.depthOf(wall_right, wall_left) : quick.depthOf(right, left);
    static_cast<void>(i < 3 ? in_order.depthOf(wall_left, wall_right) : in_order.depthOf(left, right));
    EXPECT_EQ(quick.areSwapped(), i >= 4) << i;
  }
  EXPECT_FALSE(in_order.areSwapped());
  const auto& board = scene.boards[2];
  const int begin = static_cast<int>(board.left - board.disparity),
            end = static_cast<int>(board.right - board.disparity);
  const double near = codeOf(depth, (begin + end) / 2, 170);
  EXPECT_GT(near, codeOf(depth, begin - 8, 170) + 10000);
  EXPECT_GT(near, codeOf(depth, end + 8, 170) + 10000);
}

// Nothing in it lies before anything else.
TEST(QuickDepth, SaysThatAShotDoesNotTellTheOrder) {
  TwoViews wall = boards(kCols, kRows), scene = wall;
  wall.boards.resize(1);
  const Frame left = wall.left(), right = wall.right();
  QuickDepth quick;
  quick.setMatchedCols(160);
  for (int i = 0; i <= 20; ++i) {
    EXPECT_FALSE(quick.isOrderUnknown()) << "not asked to the end, picture " << i;
    static_cast<void>(quick.depthOf(left, right));
  }
  EXPECT_TRUE(quick.isOrderUnknown());
  quick.beginShot();
  static_cast<void>(quick.depthOf(scene.left(), scene.right()));
  EXPECT_FALSE(quick.isOrderUnknown());
}

// A film of one view in both halves, as another encoder leaves them; a shot with depth after it has depth.
TEST(QuickDepth, OnePictureTwiceIsFlat) {
  const TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  const Frame flat = quick.depthOf(scene.left(), scene.leftWithGrain(4));
  EXPECT_TRUE(quick.isOnePicture());
  EXPECT_FALSE(quick.range());
  EXPECT_EQ(codeOf(flat, 10, 10), codeOf(flat, 430, 170));
  quick.beginShot();
  static_cast<void>(quick.depthOf(scene.left(), scene.right()));
  EXPECT_FALSE(quick.isOnePicture());
  EXPECT_TRUE(quick.range());
}

TEST(QuickDepth, IsAsGoodWithAnotherExposure) {
  Fit fit = fitOf(320, {.gain = 0.7, .offset = 20});
  EXPECT_LT(fit.median(), 0.25);
  EXPECT_LT(fit.wrong(), 0.04);
}

// An outline is where the colours change, not where the small map has it: within a pixel of the picture.
TEST(QuickDepth, StepsLieAtTheOutlines) {
  const TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  quick.setMatchedCols(320);
  const Frame depth = quick.depthOf(scene.left(), scene.right());
  const auto& board = scene.boards[2];
  std::vector<double> away;
  for (int r = static_cast<int>(board.top) + 20; r < static_cast<int>(board.bottom) - 20; ++r) {
    const double middle = 0.5 * (codeOf(depth, static_cast<int>(board.left) - 30, r) +
                                 codeOf(depth, static_cast<int>(board.left) + 30, r));
    int c = static_cast<int>(board.left) - 30;
    while (codeOf(depth, c, r) < middle) ++c;
    away.push_back(std::abs(c - board.left));
  }
  std::ranges::nth_element(away, away.begin() + std::ssize(away) / 2);
  EXPECT_LE(away[away.size() / 2], 1.5);
}

// What stands still keeps its code while something else comes nearer; a cut begins anew.
TEST(QuickDepth, DoesNotBreatheWithinAShot) {
  TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  quick.setMatchedCols(320);
  std::vector<double> means;
  for (int k = 0; k < 4; ++k) {
    scene.boards[2].disparity = 12 + 1.5 * k;
    const Frame depth = quick.depthOf(scene.left(), scene.right());
    double sum = 0;
    for (int r = 10; r < 50; ++r) {
      for (int c = 200; c < 300; ++c) sum += codeOf(depth, c, r) / (40 * 100);
    }
    means.push_back(sum);
  }
  const auto [least, most] = std::ranges::minmax(means);
  EXPECT_LT(most - least, 65535 * 0.1 / 30) << "a tenth of a pixel over a range of some 30";
}

TEST(QuickDepth, ACutBeginsAnew) {
  TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  const Frame first = quick.depthOf(scene.left(), scene.right());
  for (auto& board : scene.boards) board.disparity *= 2;
  for (auto& board : scene.boards) board.color = {220, 220, 220};
  scene.boards[0].color = {30, 30, 30};
  const Frame second = quick.depthOf(scene.left(), scene.right());
  Fit before(first, boards(kCols, kRows)), after(second, scene);
  EXPECT_GT(after.scale, 1.5 * before.scale) << "twice the disparity fills the same depth";
}

TEST(QuickDepth, WithoutCommonThingsAShotIsFlatUntilTheyCome) {
  const TwoViews scene = boards(kCols, kRows);
  QuickDepth quick;
  const Frame black = quick.depthOf(scene.left(), scene.right({.gain = 0}));
  EXPECT_FALSE(quick.range());
  EXPECT_EQ(codeOf(black, 10, 10), codeOf(black, 400, 200));
  const Frame both = quick.depthOf(scene.left(), scene.right());
  EXPECT_TRUE(quick.range());
  EXPECT_GT(codeOf(both, 430, 170), codeOf(both, 10, 10) + 10000);
}

TEST(QuickDepth, TheBlackAroundATitleDoesNotWidenTheRange) {
  const TwoViews title = test::titleInTheBlack();
  QuickDepth quick;
  static_cast<void>(quick.depthOf(test::withGrain(title.left(), 1), test::withGrain(title.right(), 2)));
  const auto range = quick.range();
  ASSERT_TRUE(range);
  EXPECT_GT(320 * range->low, -1);
  EXPECT_LT(320 * range->high, 11);
}

// A view that was squeezed to half of its width has depth in its own shape.
TEST(QuickDepth, HasTheShapeInWhichTheViewIsShown) {
  const TwoViews scene = boards(kCols, kRows);
  Frame left = scene.left(), right = scene.right();
  left.sample_aspect = right.sample_aspect = 2;
  left.pts = mediaTime(1.5);
  QuickDepth quick;
  const Frame depth = quick.depthOf(left, right);
  EXPECT_EQ(depth.width, 640);
  EXPECT_EQ(depth.height, 180);
  EXPECT_NEAR(depth.sample_aspect * depth.width / depth.height, 2.0 * kCols / kRows, 1e-9);
  EXPECT_EQ(depth.pts, mediaTime(1.5));
}

// In steps that are no cuts.
TEST(QuickDepth, InTheBlackOfAFadeTheLastReliefStays) {
  const TwoViews scene = boards(320, 200);
  const auto dimmed = [](Frame frame, double gain) {
    auto bytes = std::make_shared<std::vector<std::uint8_t>>(
        frame.planes[0].data, frame.planes[0].data + frame.planes[0].stride_bytes * frame.height);
    for (std::uint8_t& byte : *bytes) byte = static_cast<std::uint8_t>(gain * byte);
    frame.planes[0].data = bytes->data();
    frame.owner = bytes;
    return frame;
  };
  QuickDepth quick;
  std::vector<Frame> depths;
  for (const double gain : {1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0, 0.0})
    depths.push_back(quick.depthOf(dimmed(scene.left(), gain), dimmed(scene.right(), gain)));
  const Frame &last = depths[9], &black = depths[11];
  for (const auto& [c, r] : {std::pair(280, 20), {215, 95}, {80, 140}, {20, 180}})
    EXPECT_EQ(codeOf(black, c, r), codeOf(last, c, r)) << c << " " << r;
  EXPECT_GT(codeOf(black, 215, 95), codeOf(black, 280, 20) + 10000);
}

}  // namespace
}  // namespace relievo
