// SPDX-License-Identifier: Apache-2.0
// What is measured on a clip's first frames: noise, a codec's ripples, waves, motion.
#include "app/depth_window/clip_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "app/depth_window/touch_plan.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kPeriod = 1.0 / 30;

using test::makeGrayFrame;

// Half of the picture is painted far and a quarter near, without noise; the rest has noise of 0.4 mm.
TEST(ClipMeasure, WhatIsPaintedAtTheEndsOfTheRangeHasNoSay) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.4);
  const Frame frame = makeGrayFrame(400, 300, 16, {}, [&](int c, int) {
    return c < 200 ? 0.0 : c < 300 ? 65535.0 : (20 + noise(random)) / 40 * 65535;
  });
  const TimedSurface alone{HeightField::make(frame, {.bits = 16}, kVolume).value(), {}, frame.owner};
  EXPECT_NEAR(measureClip(std::span(&alone, 1)).noise_mm, 0.4, 0.06);
}

// The same noise everywhere; on the floor, three quarters of the picture, half of it is clipped.
TEST(ClipMeasure, NoiseThatIsClippedHasNoSay) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.4);
  const Frame frame = makeGrayFrame(
      400, 270, 16, {}, [&](int c, int) { return std::max((c < 300 ? 0 : 20) + noise(random), 0.0) / 40 * 65535; });
  const TimedSurface alone{HeightField::make(frame, {.bits = 16}, kVolume).value(), {}, frame.owner};
  EXPECT_NEAR(measureClip(std::span(&alone, 1)).noise_mm, 0.4, 0.06);
}

// A slope of 5 codes in 32 samples with hills 64 samples long, and the same with every third column a code higher.
TEST(ClipMeasure, TellsRipplesFromHills) {
  const auto ripples = [](bool coded) {
    const Frame frame = makeGrayFrame(640, 64, 8, {}, [&](int c, int) {
      return 30 + 5.0 * c / 32 + 20 * std::sin(0.098 * c) + (coded && c % 3 == 0 ? 1 : 0);
    });
    const TimedSurface alone{HeightField::make(frame, {.bits = 8}, kVolume).value(), {}, frame.owner};
    return measureClip(std::span(&alone, 1)).ripples;
  };
  EXPECT_EQ(ripples(false), 0);
  EXPECT_GT(ripples(true), 0.1);
}

// A slope in hues, full range of BT.709, 4:4:4.
Frame hueFrame(int cols, int rows) {
  const auto samples = std::make_shared<std::vector<std::uint8_t>>();
  const auto part = [&](int c, double n) {
    return std::clamp(std::abs(std::fmod(0.1 + 0.5 * c / cols + n, 1.0) * 6 - 3) - 1, 0.0, 1.0);
  };
  for (int plane = 0; plane < 3; ++plane) {
    for (int k = 0; k < cols * rows; ++k) {
      const double red = part(k % cols, 0), green = part(k % cols, 2 / 3.0), blue = part(k % cols, 1 / 3.0);
      const double y = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
      const double code = plane == 0 ? y : plane == 1 ? (blue - y) / 1.8556 : (red - y) / 1.5748;
      samples->push_back(static_cast<std::uint8_t>(std::lround(255 * code) + (plane == 0 ? 0 : 128)));
    }
  }
  Frame frame;
  frame.width = cols;
  frame.height = rows;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Full;
  frame.matrix = ColorMatrix::Bt709;
  for (std::uint8_t i = 0; i < 3; ++i) {
    frame.components[i] = {.plane = i};
    frame.planes[i] = {samples->data() + i * cols * rows, cols};
  }
  frame.owner = samples;
  return frame;
}

// Three components mix to heights at any distance from each other. One code of the colour moves it along a sixth of the
// circle by 1/255 of that sixth's length in luma and chroma: .93, .56, .51, .93, .56 and .51.
TEST(ClipMeasure, TheStepsOfColoursAreThoseOfTheirCodes) {
  const Frame frame = hueFrame(720, 64);
  const DepthCalibration hue{.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue};
  const TimedSurface alone{HeightField::make(frame, hue, kVolume).value(), {}, frame.owner};
  const double step = 40 / 6.0 / 255 * (2 / 0.934 + 2 / 0.556 + 2 / 0.508) / 6;
  EXPECT_NEAR(measureClip(std::span(&alone, 1)).quantum_mm, step, 0.02 * step);
}

// A film at rest in four frames, each with its own noise.
std::vector<TimedSurface> filmOf(const std::function<double(double x_mm, double y_mm)>& relief, int bits,
                                 double noise_mm = 0) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, noise_mm > 0 ? noise_mm : 1e-9);
  const GridMapping grid(kVolume, 720, 486);
  const double top = (1 << bits) - 1;
  std::vector<TimedSurface> film;
  for (int k = 0; k < 4; ++k) {
    const Frame frame = makeGrayFrame(720, 486, bits, mediaTime(k * kPeriod), [&](int c, int r) {
      return std::clamp((relief(grid.x(c), grid.y(r)) + noise(random)) / 40, 0.0, 1.0) * top + 0.5;
    });
    film.push_back({HeightField::make(frame, {.bits = bits}, kVolume).value(), frame.pts, frame.owner});
  }
  return film;
}

// The fourth difference of a sine of amplitude A and length l over points h apart is A (2 sin(pi h/l))^4 at its top;
// means over h take sin(pi h/l)/(pi h/l) of it, and .6 of a sine are below sin(.6 x 90 degrees). Blocks are 7, 10 and
// 14 samples wide.
TEST(ClipMeasure, FindsWavesThatAWideSmoothingFlattens) {
  constexpr double kTurn = 2 * std::numbers::pi, kLength = 9, kHeight = 0.3;
  const auto film = filmOf([](double x, double) { return 19 + kHeight * std::sin(kTurn * x / kLength); }, 16);
  const Waves waves = wavesOf(film, 0, 0, true);
  for (std::size_t k = 0; k < waves.size(); ++k) {
    const double half_turn = kTurn / 2 * std::array{7, 10, 14}[k] * 160 / 720 / kLength;
    const double half_chord = 2 * std::sin(half_turn);
    const double top = kHeight * std::pow(half_chord, 4) * half_chord / 2 / half_turn;
    EXPECT_NEAR(waves[k], std::sin(0.6 * kTurn / 4) * top, 0.03 * top);
  }
  EXPECT_EQ(wavesOf(film, 1, 0, true), Waves{}) << "no three blocks bend by 1 mm";
  EXPECT_EQ(wavesOf(film, 0, 5, true), Waves{}) << "no more than noise of 5 mm a sample makes";
  const auto hill = filmOf([](double x, double y) { return 20 + x * y / 90 - x * x / 500; }, 16);
  EXPECT_LT(wavesOf(hill, 0, 0, true).back(), 0.01);
  EXPECT_EQ(wavesOf({}, 0, 0, true), Waves{});
}

TEST(ClipMeasure, APlanIsNarrowOnWavesAndWideOnWhatIsSmooth) {
  const auto width = [](const auto& relief, double noise_mm) {
    return planFilm(filmOf(relief, 8, noise_mm)).scale.wide_mm;
  };
  const auto sine = [](double x, double y) {
    return 19 + 0.3 * std::sin((0.8 * x + 0.6 * y) * 2 * std::numbers::pi / 10);
  };
  const auto bumps = [](double x, double y) { return 20 + 0.15 * (std::sin(0.63 * x) + std::sin(0.63 * y)); };
  const auto rippled = [&](double x, double y) { return sine(x, y) + (std::abs(x) < 0.2 ? 0.16 : 0); };
  const auto shallow = [](double x, double y) { return 20 + 0.031 * x + 0.011 * y; };
  const auto hill = [](double x, double y) { return 34 - (x * x + y * y) / 180; };
  EXPECT_NEAR(width(shallow, 0), width(hill, 0), 1e-9) << "steps are no waves";
  EXPECT_LT(width(sine, 0), 0.7 * width(hill, 0));
  EXPECT_LT(width(rippled, 0), 0.7 * width(hill, 0)) << "a few of a codec's ripples";
  EXPECT_LT(width(bumps, 0), 0.75 * width(hill, 0)) << "the narrow tops are no codec's ripples";
  EXPECT_NEAR(width(shallow, 0.4), width(hill, 0.4), 1e-9) << "noise is no wave";
  EXPECT_LT(width(sine, 0.4), 0.8 * width(hill, 0.4));
}

TEST(ClipMeasure, WhatACodecLeavesDoesNotGrowWithTheBlocks) {
  const auto coded = [](const Waves& waves) {
    return isCoded({.frames = 4, .quantum_mm = 0.16, .ripples = 0.01, .waves_mm = waves});
  };
  EXPECT_TRUE(coded({}));
  EXPECT_TRUE(coded({0.5, 0.4, 0.5}));
  EXPECT_TRUE(coded({0, 0, 0.2})) << "hardly more than a step";
  EXPECT_FALSE(coded({0.1, 0.3, 0.8}));
}

// A sensor that smooths its own noise: bumps some 2 mm wide, other ones in each frame.
TEST(ClipMeasure, WhatDiffersFromFrameToFrameIsNoWave) {
  int k = 0;
  const auto bumps = [&](double x, double y) {
    if (x < -79.8 && y > 53.8) ++k;  // the first sample of a frame
    return 20 + 0.2 * x + 0.3 * std::sin(1.6 * x + 2.0 * k * k) + 0.3 * std::sin(1.4 * y + 3.0 * k * k);
  };
  const auto film = filmOf(bumps, 8);
  EXPECT_EQ(measureClip(film).waves_mm, Waves{});
  EXPECT_GT(measureClip(std::span(film).first(1)).waves_mm.front(), 0.2);
}

// Two still pictures with a cut of 20 mm between them: nothing has moved.
TEST(ClipMeasure, ACutIsNoMotion) {
  std::vector<Frame> frames;
  std::vector<TimedSurface> surfaces;
  for (int k = 0; k < 4; ++k) {
    frames.push_back(
        makeGrayFrame(90, 61, 8, mediaTime(k * kPeriod), [&](int c, int) { return c + (k < 2 ? 0 : 127); }));
    surfaces.push_back({HeightField::make(frames.back(), {.bits = 8}, kVolume).value(), frames.back().pts,
                        frames.back().owner, k < 2 ? 0U : 1U});
  }
  EXPECT_EQ(measureClip(surfaces).speed_mm_per_s, 0);
  EXPECT_TRUE(measureClip(surfaces).still);
  for (TimedSurface& s : surfaces) s.shot = 0;
  EXPECT_GT(measureClip(surfaces).speed_mm_per_s, 100) << "without the cut it counts as motion";
}

}  // namespace
}  // namespace relievo
