// SPDX-License-Identifier: Apache-2.0
// Disparities from picture to picture: noise goes, what moves is followed, edges stay where they are.
#include "app/stereo/quick/steady_disparity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/support/film/two_views.h"

namespace relievo {
namespace {

using test::TwoViews;

constexpr int kCols = 192, kRows = 96;

TwoViews wall() {
  return {.cols = kCols, .rows = kRows, .boards = {{0, 0, kCols, kRows, -4, 0, {110, 120, 90}}}};
}

// What a matcher finds: the exact disparity, and what `error` adds.
DisparityMap found(const TwoViews& scene, const std::function<double(int c, int r)>& error = {}) {
  DisparityMap map(kCols, kRows);
  std::ranges::fill(map.seen, std::uint8_t{1});
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      map.pixels[map.at(c, r)] = static_cast<float>(scene.disparity(c, r) + (error ? error(c, r) : 0));
    }
  }
  return map;
}

class Steady {
 public:
  DisparityMap of(const TwoViews& scene, DisparityMap map) {
    steady_.steady(map, readView(scene.left()), readView(scene.right()));
    return map;
  }
  void begin() { steady_.begin(); }

 private:
  SteadyDisparity steady_;
};

struct Off {
  double rms = 0, mean = 0;
};
Off offOf(const DisparityMap& map, const TwoViews& scene) {
  double squares = 0, sum = 0;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      const double away = static_cast<double>(map.pixels[map.at(c, r)]) - scene.disparity(c, r);
      squares += away * away;
      sum += away;
    }
  }
  const double count = static_cast<double>(map.size());
  return {std::sqrt(squares / count), sum / count};
}

// The mean of n pictures has 1 / sqrt(n) of the noise: after 16, a quarter, where nothing else is averaged.
TEST(SteadyDisparity, NoiseOfAStillPictureGoes) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.15);
  Steady steady;
  const TwoViews scene = wall();
  Off off;
  for (int i = 0; i < 16; ++i)
    off = offOf(steady.of(scene, found(scene, [&](int, int) { return noise(random); })), scene);
  EXPECT_LT(off.rms, 0.15 / 4 * 1.3);
  EXPECT_NEAR(off.mean, 0, 0.01);
}

// A mean of pictures would lag by some of them.
TEST(SteadyDisparity, WhatComesNearerIsNotHeldBack) {
  for (const double speed : {0.2, 0.05}) {  // pixels a picture
    std::mt19937 random(2);
    std::normal_distribution<double> noise(0, 0.1);
    Steady steady;
    TwoViews scene = wall();
    for (int i = 0; i < 22; ++i) {
      if (i >= 10) scene.boards[0].disparity += speed;  // from a standstill
      const Off off = offOf(steady.of(scene, found(scene, [&](int, int) { return noise(random); })), scene);
      EXPECT_NEAR(off.mean, 0, 0.06) << speed << ": " << i;
    }
  }
}

// Its change is known from all around: a mean of five along it has a third of the noise, however fast it comes.
TEST(SteadyDisparity, NoiseOfWhatComesNearerGoesAsWell) {
  for (const double speed : {0.2, 0.1}) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0, 0.15);
    Steady steady;
    TwoViews scene = wall();
    Off off;
    for (int i = 0; i < 16; ++i) {
      scene.boards[0].disparity += speed;
      off = offOf(steady.of(scene, found(scene, [&](int, int) { return noise(random); })), scene);
    }
    EXPECT_LT(std::sqrt(off.rms * off.rms - off.mean * off.mean), 0.15 / 3 * 1.3) << speed;
  }
}

// A board passes before a wall: no pixel of one takes anything from the other.
TEST(SteadyDisparity, AMovingEdgeIsNotSmeared) {
  Steady steady;
  TwoViews scene = wall();
  scene.boards.push_back({20, 30, 60, 70, 6, 0, {190, 90, 80}});
  for (int i = 0; i < 12; ++i) {
    scene.boards[1].left += 5;
    scene.boards[1].right += 5;
    const DisparityMap map = steady.of(scene, found(scene));
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c) {
        ASSERT_NEAR(map.pixels[map.at(c, r)], scene.disparity(c, r), 0.05) << i << ": " << c << ", " << r;
      }
    }
  }
}

// A part of the picture for which the matcher finds another surface in some pictures, although the views contradict it.
TEST(SteadyDisparity, AFlickerBetweenTwoSurfacesIsHeld) {
  Steady steady;
  const TwoViews scene = wall();
  const auto wrong = [](int c, int r) { return c >= 80 && c < 110 && r >= 40 && r < 60 ? 7.0 : 0.0; };
  for (int i = 0; i < 20; ++i) {
    const DisparityMap map = steady.of(scene, i > 0 && i % 3 == 0 ? found(scene, wrong) : found(scene));
    ASSERT_LT(offOf(map, scene).rms, 0.02) << i;
  }
}

// The surface really moves: the left view stays as it is, and the right view agrees with the new disparity. Found once,
// it may be an outline's flicker.
TEST(SteadyDisparity, AnotherSurfaceThatBothViewsShowIsTakenWhenItIsFoundTwice) {
  Steady steady;
  TwoViews scene = wall();
  for (int i = 0; i < 10; ++i) static_cast<void>(steady.of(scene, found(scene)));
  const TwoViews before = scene;
  scene.boards[0].disparity += 7;
  for (int i = 0; i < 4; ++i) {  // in turns
    const TwoViews& now = i % 2 == 0 ? scene : before;
    EXPECT_LT(offOf(steady.of(now, found(now)), before).rms, 0.5) << i;
  }
  static_cast<void>(steady.of(scene, found(scene)));
  EXPECT_LT(offOf(steady.of(scene, found(scene)), scene).rms, 0.5);
}

TEST(SteadyDisparity, ACutBeginsAnew) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.2);
  Steady steady;
  const TwoViews scene = wall();
  for (int i = 0; i < 5; ++i) static_cast<void>(steady.of(scene, found(scene)));
  steady.begin();
  const DisparityMap other = found(scene, [&](int, int) { return noise(random); });
  EXPECT_EQ(steady.of(scene, other).pixels, other.pixels);
}

}  // namespace
}  // namespace relievo
