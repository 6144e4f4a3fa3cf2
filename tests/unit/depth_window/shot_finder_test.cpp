// SPDX-License-Identifier: Apache-2.0
// Detection of cuts and of repeated frames.
#include "app/depth_window/shots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr int kCols = 90, kRows = 61;
constexpr double kPeriod = 1.0 / 30;

template <class Height>
std::vector<TimedSurface> film(int count, Height&& height) {
  std::vector<TimedSurface> surfaces;
  for (const Frame& f : test::makeReliefFilm(count, kPeriod, kCols, kRows, kVolume, height)) {
    surfaces.push_back(test::surfaceOf(f, kVolume));
  }
  return surfaces;
}

TEST(ShotFinder, FindsCutsAndNoRise) {
  const auto shots = [](auto&& height) {
    auto frames = film(8, height);
    ShotFinder().mark(frames);
    std::vector<std::uint32_t> numbers;
    for (const TimedSurface& f : frames) numbers.push_back(f.shot);
    return numbers;
  };
  const auto cut = [](double x, double y, double t) {
    return t < 3.5 * kPeriod ? 10 + 0.1 * x : 25 - 0.1 * y + 20 * t;
  };
  EXPECT_EQ(shots(cut), (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1}));
  const auto rise = [](double, double, double t) { return std::clamp(450 * (t - 5 * kPeriod), 0.0, 40.0); };
  EXPECT_EQ(shots(rise).back(), 0U) << "a fast rise";
  const auto passing = [](double x, double, double t) { return std::abs(x - 300 * t + 40) < 10 ? 30.0 : 10.0; };
  EXPECT_EQ(shots(passing).back(), 0U) << "something passes by";
}

TEST(ShotFinder, ARiseThatEndsIsNoCutWhenTheFrameThatShowedItIsLetGo) {
  ShotFinder finder;
  std::vector<TimedSurface> held;
  for (const TimedSurface& f :
       film(12, [](double, double, double t) { return 10 + 63 * std::clamp(t - 2 * kPeriod, 0.0, 4.2 * kPeriod); })) {
    held.push_back(f);
    if (held.size() > 6) held.erase(held.begin());
    finder.mark(held);
    // The newest pair may still be taken for a cut, because the frame after it is missing.
    for (std::size_t i = 0; i + 1 < held.size(); ++i) EXPECT_EQ(held[i].shot, 0U) << toSeconds(f.time) << ' ' << i;
  }
}

// Four or five frames of 8 bits; code 0 is a hole.
template <class Code>
std::vector<std::uint32_t> shotsWithHoles(int count, Code&& code) {
  std::vector<TimedSurface> frames;
  for (int k = 0; k < count; ++k) {
    const Frame f = test::makeGrayFrame(kCols, kRows, 8, mediaTime(k * kPeriod),
                                        [&](int c, int) { return static_cast<std::uint32_t>(code(k, c)); });
    frames.push_back(test::surfaceOf(f, kVolume, {.bits = 8, .invalid = 0}));
  }
  ShotFinder().mark(frames);
  std::vector<std::uint32_t> numbers;
  for (const TimedSurface& f : frames) numbers.push_back(f.shot);
  return numbers;
}

using Shots = std::vector<std::uint32_t>;

TEST(ShotFinder, APictureOfNothingButHolesIsNoCut) {
  EXPECT_EQ(shotsWithHoles(4, [](int k, int) { return k == 2 ? 0 : 100; }), (Shots{0, 0, 0, 0}));
}

// Four fifths of the picture are holes. What can be read jumps by 14 mm.
TEST(ShotFinder, WhatCanBeReadDecidesHoweverLittleItIs) {
  EXPECT_EQ(shotsWithHoles(4, [](int k, int c) { return c > kCols / 5 ? 0 : k < 2 ? 100 : 190; }), (Shots{0, 0, 1, 1}));
}

// The picture rises by 6 mm in each frame, so that a rise is no cut. Holes in the frame after it are no sign of a cut
// either.
TEST(ShotFinder, ARiseIsNoCutWhereTheFrameAfterItIsAllHoles) {
  EXPECT_EQ(shotsWithHoles(4, [](int k, int) { return k == 3 ? 0 : 20 + 40 * k; }), (Shots{0, 0, 0, 0}));
}

std::vector<bool> repetitions(const std::vector<TimedSurface>& frames) {
  std::vector<bool> found;
  for (const TimedSurface& f : frames) found.push_back(f.repeats);
  return found;
}

TEST(ShotFinder, AFrameRepeatsTheOneBeforeItOnlyWhenAllItsSamplesAreTheSame) {
  // Identical except for one sample: next to a sampled place, in the first row, at the last sample.
  for (const auto& [c, r] : {std::pair(45, 30), std::pair(0, 0), std::pair(kCols - 1, kRows - 1)}) {
    std::vector<TimedSurface> frames;
    for (int k = 0; k < 5; ++k) {
      const Frame f = test::makeGrayFrame(kCols, kRows, 16, mediaTime(k * kPeriod), [&, c = c, r = r](int i, int j) {
        return 20000 + 30 * i + (k == 2 && i == c && j == r ? 1 : 0);
      });
      frames.push_back(test::surfaceOf(f, kVolume));
    }
    ShotFinder().mark(frames);
    EXPECT_EQ(repetitions(frames), (std::vector<bool>{false, true, false, false, true})) << c << ' ' << r;
  }
}

TEST(ShotFinder, HolesThatStayAreRepeatedToo) {
  std::vector<TimedSurface> frames;
  for (int k = 0; k < 2; ++k) {
    const Frame f =
        test::makeGrayFrame(kCols, kRows, 8, mediaTime(k * kPeriod), [](int c, int) { return c < 30 ? 0 : c; });
    frames.push_back(test::surfaceOf(f, kVolume, {.bits = 8, .invalid = 0}));
  }
  ShotFinder().mark(frames);
  EXPECT_TRUE(frames[1].repeats);
}

TEST(ShotFinder, ComparesWithTheFrameThatIsBeforeItNow) {
  // A, B, A: the last frame repeats nothing; without B it repeats the first.
  auto frames = film(3, [](double, double, double t) { return std::abs(t - kPeriod) < 0.01 ? 20.0 : 20.1; });
  ShotFinder finder;
  finder.mark(frames);
  EXPECT_FALSE(frames[2].repeats);
  frames.erase(frames.begin() + 1);
  finder.mark(frames);
  EXPECT_TRUE(frames[1].repeats);
}

}  // namespace
}  // namespace relievo
