// SPDX-License-Identifier: Apache-2.0
// What the surface of the default method keeps from tick to tick, and what it must forget.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <random>
#include <span>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/haptics/method/felt_surface.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/haptics/felt_films.h"

namespace relievo {
namespace {

using test::makeGrayFrame;
using test::makeWindow;

TEST(FeltSurface, WhatWasPreparedIsWhatWouldHaveBeenComputed) {
  const auto frames = film(8, rough);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  FeltSurface ahead({}), plain({});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(6, 14), y(-10, 10), jitter(-0.0002, 0.0002);
  double t = 0.07;
  readAll(ahead, w, t);
  readAll(plain, w, t);
  for (int i = 0; i < 100; ++i) {
    const double px = x(random), py = y(random), next = t + 0.001;
    ASSERT_TRUE(ahead.moveTo(w, mediaTime(t)));
    ahead.prepare(w, mediaTime(next), px, py);
    t = next + jitter(random);
    ASSERT_TRUE(ahead.moveTo(w, mediaTime(t)));
    ASSERT_TRUE(plain.moveTo(w, mediaTime(t)));
    ASSERT_NEAR(ahead.at(px, py).z, plain.at(px, py).z, 1e-4) << i;
    ASSERT_NEAR(ahead.at(px, py).zx, plain.at(px, py).zx, 1e-3) << i;
  }
}

TEST(FeltSurface, FramesThatComeAndGoAreNotMixedUp) {
  // A plane that rises 1 mm per frame for 40 frames; the window moves along, and some frames are left out.
  const auto frames = film(40, [](double, double, double t) { return 1 + t / kPeriod * 0.9; }, 90, 61);
  FeltSurface s({});
  std::mt19937 random(4);
  for (int k = 2; k + 5 < 40; k += 1 + static_cast<int>(random() % 3)) {
    const SurfaceWindow w = makeWindow(std::span(frames).subspan(static_cast<std::size_t>(k) - 2, 8), kVolume);
    for (const double share : {0.0, 0.3, 0.9}) {
      const double t = (k + share) * kPeriod;
      ASSERT_TRUE(s.moveTo(w, mediaTime(t)));
      ASSERT_NEAR(s.at(1.5 * k, 3).z, 1 + (k + share) * 0.9, 2e-3) << k << ' ' << share;
      s.prepare(w, mediaTime(t + 0.001), 1.5 * k + 1, 3);
    }
  }
}

TEST(FeltSurface, AnotherEpochOrSizeAtTheSameTimesIsAnotherPicture) {
  const auto flat = [](double z, int cols, int rows) {
    return film(3, [z](double, double, double) { return z; }, cols, rows);
  };
  FeltSurface s({});
  const auto heightOn = [&](const std::vector<Frame>& frames, std::uint32_t epoch) {
    SurfaceWindow w = makeWindow(frames, kVolume);
    w.epoch = epoch;
    EXPECT_TRUE(s.moveTo(w, mediaTime(0.04)));
    return s.height(1, 2);
  };
  EXPECT_NEAR(heightOn(flat(10, kCols, kRows), 0), 10, 1e-3);
  EXPECT_NEAR(heightOn(flat(30, kCols, kRows), 1), 30, 1e-3);
  EXPECT_NEAR(heightOn(flat(20, kCols, 2 * kRows), 1), 20, 1e-3);
  EXPECT_NEAR(heightOn(flat(15, kCols / 2, 2 * kRows), 1), 15, 1e-3);
}

// Sought back to the same moment of another film: the times are alike, the pictures are not.
TEST(FeltSurface, WhatWasPreparedDoesNotOutliveItsEpoch) {
  const auto flat = [](double z) { return film(3, [z](double, double, double) { return z; }); };
  const auto low = flat(10), high = flat(30);
  const SurfaceWindow before = makeWindow(low, kVolume);
  SurfaceWindow after = makeWindow(high, kVolume);
  after.epoch = 1;
  FeltSurface s({});
  ASSERT_TRUE(s.moveTo(before, mediaTime(0.039)));
  s.prepare(before, mediaTime(0.04), 1, 2);
  ASSERT_TRUE(s.moveTo(after, mediaTime(0.04)));
  EXPECT_NEAR(s.height(1, 2), 30, 1e-3);
}

TEST(FeltSurface, WhatWasPreparedDoesNotOutliveItsFrames) {
  const auto frames = film(6, [](double, double, double t) { return 5 + 40 * t * t / kPeriod; });
  const SurfaceWindow whole = makeWindow(frames, kVolume);
  const SurfaceWindow early = makeWindow(std::span(frames).first(5), kVolume);
  FeltSurface ahead({}), plain({});
  const double t = 2.5 * kPeriod;
  readAll(ahead, early, t - 0.001);
  readAll(plain, whole, t);
  ahead.prepare(early, mediaTime(t), 0, 0);
  ASSERT_TRUE(ahead.moveTo(whole, mediaTime(t)));
  ASSERT_TRUE(plain.moveTo(whole, mediaTime(t)));
  EXPECT_NEAR(ahead.height(0, 0), plain.height(0, 0), 1e-5) << "the sixth has come";
}

// A prepared surface continues in a straight line, 1 um off the curve, which makes it detectable.
TEST(FeltSurface, WhatWasPreparedHoldsThoughTheWindowGoesOn) {
  const auto frames = film(9, [](double, double, double t) { return 20 + 15 * std::cos(30 * t); });
  const SurfaceWindow early = makeWindow(std::span(frames).first(8), kVolume);
  const SurfaceWindow moved = makeWindow(std::span(frames).subspan(1), kVolume);
  FeltSurface ahead({}), plain({});
  const double next = 3 * kPeriod + 0.0005, late = next + 0.00025;
  readAll(ahead, early, next - 0.001);
  readAll(plain, moved, late);
  ahead.prepare(early, mediaTime(next), 0, 0);
  ASSERT_TRUE(ahead.moveTo(moved, mediaTime(late)));
  ASSERT_TRUE(plain.moveTo(moved, mediaTime(late)));
  const double beside = std::abs(ahead.height(0, 0) - plain.height(0, 0));
  EXPECT_GT(beside, 1e-4) << "worked out anew";
  EXPECT_LT(beside, 2e-3);
}

TEST(FeltSurface, WhatWasPreparedHoldsBetweenTwoFramesOnly) {
  // Every frame is 10 mm higher, with hold: between 1 and 2 periods the height is 20 mm, after that 30.
  const auto frames = film(4, [](double, double, double t) { return 10 + 10 * std::round(t / kPeriod); });
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const double second = 2 * kPeriod;
  const auto height = [&](double prepared_for, double now) {
    FeltSurface s({.narrow_time = TimeLaw::Hold, .wide_time = TimeLaw::Hold});
    EXPECT_TRUE(s.moveTo(w, mediaTime(prepared_for - 0.001)));
    s.prepare(w, mediaTime(prepared_for), 0, 0);
    EXPECT_TRUE(s.moveTo(w, mediaTime(now)));
    return s.height(0, 0);
  };
  EXPECT_NEAR(height(second - 0.0001, second + 0.0001), 30, 1e-3) << "the next frame's time has come";
  EXPECT_NEAR(height(second + 0.0001, second - 0.0001), 20, 1e-3) << "the clock was set back";
  EXPECT_NEAR(height(second - 0.0003, second - 0.0001), 20, 1e-3) << "the next frame says nothing about this one";
}

TEST(FeltSurface, ATickThatComesLateDoesNotGoByWhatWasPrepared) {
  const auto frames = film(8, [](double, double, double t) { return 20 + 8 * std::sin(60 * t); });
  const SurfaceWindow w = makeWindow(frames, kVolume);
  FeltSurface late({}), plain({});
  readAll(late, w, 0.101);
  readAll(plain, w, 0.125);
  late.prepare(w, mediaTime(0.102), 0, 0);
  ASSERT_TRUE(late.moveTo(w, mediaTime(0.125)));
  ASSERT_TRUE(plain.moveTo(w, mediaTime(0.125)));
  EXPECT_NEAR(late.height(0, 0), plain.height(0, 0), 1e-5);
}

// Flat ground beside a hole that opens and closes with each frame; ticks come 0.4 ms after the prepared moment. A point
// that is a hole at one end of the preparation and ground at the other has no rate of change.
TEST(FeltSurface, AHoleThatOpensOrClosesIsNotCarriedOn) {
  const DepthCalibration holes{.bits = 8, .invalid = 0};
  std::vector<Frame> frames;
  for (int k = 0; k < 8; ++k) {
    frames.push_back(makeGrayFrame(kCols, kRows, 8, mediaTime(k * kPeriod), [&](int c, int r) {
      return k % 2 == 1 && c > 200 && c < 240 && r > 100 && r < 140 ? 0 : 128;
    }));
  }
  const SurfaceWindow w = makeWindow(frames, kVolume, holes);
  const GridMapping grid(kVolume, kCols, kRows);
  const double ground = 128.0 / 255 * 40;
  for (double t = 2 * kPeriod; t < 4 * kPeriod; t += 0.0005) {
    for (double c = 194; c < 206; c += 1.5) {
      for (const double beside : {-0.0004, 0.0004}) {
        FeltSurface s({});
        ASSERT_TRUE(s.moveTo(w, mediaTime(t)));
        s.prepare(w, mediaTime(t + 0.001), grid.x(c), grid.y(120));
        ASSERT_TRUE(s.moveTo(w, mediaTime(t + 0.001 + beside)));
        const double z = s.height(grid.x(c), grid.y(120));
        ASSERT_TRUE(z >= -40.01 && z <= ground + 0.3) << z << " mm at " << t << " s, sample " << c;
      }
    }
  }
}

// A window as the player makes it: from two frames before the present one to five after it.
SurfaceWindow windowAt(std::span<const TimedSurface> film, double t) {
  const auto now = static_cast<std::size_t>(t / kPeriod + 1e-6);
  SurfaceWindow w;
  for (std::size_t f = now - std::min<std::size_t>(now, 2); f < film.size() && f < now + 6; ++f) {
    w.frames[static_cast<std::size_t>(w.count++)] = film[f];
  }
  return w;
}
std::vector<TimedSurface> marked(const std::vector<Frame>& frames) {
  std::vector<TimedSurface> surfaces;
  for (const Frame& f : frames) surfaces.push_back(test::surfaceOf(f, kVolume));
  ShotFinder().mark(surfaces);
  return surfaces;
}
// A stroke over the step at x = 10, and then a rest.
glm::dvec2 strokeAt(double t) {
  return {6 + 20 * std::min(t, 0.4), 3 * std::sin(5 * std::min(t, 0.4))};
}

TEST(FeltSurface, AFilmThatStandsStillCostsWhatAPictureDoes) {
  auto still = marked(film(24, [](double x, double y, double) { return rough(x, y, 0); }));
  const auto blocksOn = [](std::span<const TimedSurface> frames) {
    std::vector<std::uint64_t> read;
    FeltSurface s({});
    for (double t = 0; t < 0.6; t += 0.001) {
      const SurfaceWindow w = windowAt(frames, frames.size() == 1 ? 0 : t);
      const glm::dvec2 here = strokeAt(t), next = strokeAt(t + 0.001);
      EXPECT_TRUE(s.moveTo(w, mediaTime(t)));
      static_cast<void>(s.at(here.x, here.y));
      s.prepare(w, mediaTime(t + 0.001), next.x, next.y);
      read.push_back(s.blocksRead());
    }
    return read;
  };
  const auto of_film = blocksOn(still), of_picture = blocksOn(std::span(still).first(1));
  EXPECT_EQ(of_film, of_picture) << "tick by tick";
  for (TimedSurface& f : still) f.repeats = false;
  EXPECT_GT(blocksOn(still).back(), 5 * of_film.back()) << "otherwise this test would prove nothing";
}

// A decoder that comes late hands over all frames of the window at once.
TEST(FeltSurface, FramesThatComeTogetherAreReadInSeveralTicks) {
  const auto moving = marked(film(12, rough));
  const double here = -5, there = 4;
  const auto tick = [&](FeltSurface& s, double t) {
    const SurfaceWindow w = windowAt(moving, t);
    const std::uint64_t before = s.blocksRead();
    EXPECT_TRUE(s.moveTo(w, mediaTime(t)));
    const double z = s.at(here, there).z;
    if (!s.hasReadAFrame()) s.prepare(w, mediaTime(t + 0.001), here, there);
    return std::pair(z, s.blocksRead() - before);
  };
  for (const TimeLaw law : {TimeLaw::BSpline, TimeLaw::Adapted, TimeLaw::Mean}) {
    FeltSurface in_time({.narrow_time = law, .wide_time = law}), late({.narrow_time = law, .wide_time = law});
    std::uint64_t one_frame = 0;
    for (double t = 0; t < 0.135; t += 0.001) {
      const auto [z, blocks] = tick(in_time, t);
      if (t > 0.02) one_frame = std::max(one_frame, blocks);
    }
    std::vector<std::uint64_t> of_tick;
    for (int i = 0; i <= kTicksToRead; ++i) {
      const double t = 0.135 + 0.001 * i;
      const auto [z, blocks] = tick(late, t);
      of_tick.push_back(blocks);
      const auto [as_ever, none] = tick(in_time, t);
      if (i == kTicksToRead) {
        EXPECT_EQ(z, as_ever) << "all of them count by now";
      }
    }
    EXPECT_LE(*std::ranges::max_element(of_tick), 16U + 32 + 8) << "one frame, and an edge that is near";
    EXPECT_GT(of_tick[0], one_frame) << "otherwise this test would prove nothing";
  }
}

TEST(FeltSurface, AFrameThatIsSaidToRepeatIsNotCompared) {
  // The second frame's edge is 1 mm further on, but it is marked as a repetition of the first: nothing moves.
  const auto frames = film(2, [](double x, double, double t) { return x > 3 + t / kPeriod ? 25.0 : 10.0; }, 720, 486);
  SurfaceWindow w = makeWindow(frames, kVolume);
  w.frames[1].repeats = true;
  FeltSurface s({});
  double first = 0;
  for (double t = 0.001; t < kPeriod; t += 0.004) {
    ASSERT_TRUE(s.moveTo(w, mediaTime(t)));
    const double here = s.height(3.8, 0);
    if (t < 0.002) first = here;
    EXPECT_NEAR(here, first, 1e-4) << t;
    s.prepare(w, mediaTime(t + 0.004), 3.8, 0);
  }
}

TEST(FeltSurface, MotionAfterStillnessIsTheMotionThatItWas) {
  const auto move = [](double t) { return std::clamp(t - 0.3, 0.0, 0.25); };
  auto frames =
      marked(film(24, [&](double x, double y, double t) { return rough(x - 30 * move(t), y, 20 * move(t)); }));
  ASSERT_TRUE(frames[5].repeats && !frames[12].repeats && frames[20].repeats);
  auto unmarked = frames;
  for (TimedSurface& f : unmarked) f.repeats = false;
  for (const TimeLaw law : {TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted, TimeLaw::Adapted, TimeLaw::Mean}) {
    const FeltScale scale{.narrow_steady_mm = 0.05, .wide_steady_mm = 0.05, .narrow_time = law, .wide_time = law};
    FeltSurface merged(scale), plain(scale);
    for (double t = 0; t < 0.75; t += 0.001) {
      const glm::dvec2 here = strokeAt(t), next = strokeAt(t + 0.001);
      const SurfaceWindow w = windowAt(frames, t), u = windowAt(unmarked, t);
      ASSERT_TRUE(merged.moveTo(w, mediaTime(t)));
      ASSERT_TRUE(plain.moveTo(u, mediaTime(t)));
      ASSERT_NEAR(merged.height(here.x, here.y), plain.height(here.x, here.y), 2e-4) << name(law) << ' ' << t;
      merged.prepare(w, mediaTime(t + 0.001), next.x, next.y);
      plain.prepare(u, mediaTime(t + 0.001), next.x, next.y);
    }
  }
}

}  // namespace
}  // namespace relievo
