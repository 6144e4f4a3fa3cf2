// SPDX-License-Identifier: Apache-2.0
// A film through the enhancer: complete, in order, with the calibration it announces, and closer to the truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/core/utility.hpp>
#include <random>
#include <string>

#include "app/enhance/enhancer.h"
#include "app/scene/height_field.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr Enhancement kAll[] = {Enhancement::Median, Enhancement::Dibm, Enhancement::SpaceTime};

struct Passage {
  std::vector<Frame> frames;
  EnhancementSummary summary;
  std::size_t most_inside = 0;
};

Passage enhance(Enhancement how, const DepthCalibration& calibration, const std::vector<Frame>& film) {
  DepthEnhancer enhancer(how, calibration);
  Passage run;
  const auto collect = [&](std::size_t in) {
    while (auto frame = enhancer.next()) run.frames.push_back(std::move(*frame));
    run.most_inside = std::max(run.most_inside, in - run.frames.size());
  };
  for (std::size_t i = 0; i < film.size(); ++i) {
    EXPECT_TRUE(enhancer.add(film[i]).has_value());
    collect(i + 1);
  }
  enhancer.finish();
  collect(film.size());
  run.summary = enhancer.summary();
  return run;
}

int codeAt(const Frame& frame, int c, int r) {
  return reinterpret_cast<const std::uint16_t*>(frame.planes[0].data + r * frame.planes[0].stride_bytes)[c];
}

std::vector<Frame> filmOf(int count, int cols, int rows, int bits, const std::function<double(int c, int r)>& code) {
  std::vector<Frame> film;
  for (int k = 0; k < count; ++k) {
    film.push_back(test::makeGrayFrame(cols, rows, bits, mediaTime(0.04 * k), [&](int c, int r) {
      return std::lround(std::clamp(code(c, r), 0.0, std::exp2(bits) - 1));
    }));
  }
  return film;
}

TEST(EnhanceEnhancer, GivesEveryPictureBackInOrderAndHoldsFew) {
  const auto film = filmOf(40, 48, 32, 8, [](int c, int r) { return 40 + c + r; });
  for (const Enhancement how : kAll) {
    const Passage run = enhance(how, {}, film);
    ASSERT_EQ(run.frames.size(), film.size()) << name(how);
    for (std::size_t i = 0; i < film.size(); ++i) {
      EXPECT_EQ(run.frames[i].pts, film[i].pts);
      EXPECT_EQ(run.frames[i].width, 48);
      EXPECT_EQ(run.frames[i].height, 32);
    }
    EXPECT_EQ(run.most_inside, how == Enhancement::SpaceTime ? 2u : 0u) << name(how);  // whatever the machine
    EXPECT_EQ(run.summary.pictures, film.size());
    EXPECT_EQ(run.summary.samples, film.size() * 48 * 32);
  }
}

// 8 bits c are 257 c of 16; 10 bits are 65535 c/1023; limited range 16 .. 235 is stretched; near low is turned round.
TEST(EnhanceEnhancer, LeavesLevelDepthAsItIsInSixteenBitsOfOneMeaning) {
  struct Case {
    DepthCalibration calibration;
    int code, expected;
  };
  const Case cases[] = {{{}, 100, 25700},
                        {{.bits = 10}, 511, 32735},
                        {{.bits = 16}, 54321, 54321},
                        {{.range = ColorRange::Limited}, 89, 21845},
                        {{.polarity = DepthPolarity::NearIsLow}, 55, 51400}};
  for (const Case& one : cases) {
    for (const Enhancement how : kAll) {
      const auto film = filmOf(3, 20, 16, one.calibration.bits, [&](int, int) { return one.code; });
      for (const Frame& frame : enhance(how, one.calibration, film).frames) {
        for (int r = 0; r < 16; ++r) {
          for (int c = 0; c < 20; ++c) ASSERT_EQ(codeAt(frame, c, r), one.expected) << name(how);
        }
      }
    }
    const DepthCalibration outcome = DepthEnhancer(Enhancement::Dibm, one.calibration).outcome();
    EXPECT_EQ(outcome.bits, 16);
    EXPECT_EQ(outcome.range, ColorRange::Full);
    EXPECT_EQ(outcome.polarity, DepthPolarity::NearIsHigh);
    EXPECT_TRUE(outcome.invalid.empty());
  }
}

// Distances in mm, with holes: the output's codes and calibration give the relief of the source.
TEST(EnhanceEnhancer, TheCalibrationBesideTheCodesGivesTheReliefOfTheSource) {
  const DepthCalibration distances{
      .polarity = DepthPolarity::NearIsLow, .bits = 16, .invalid = 0, .unit_mm = 1, .near_mm = 500, .far_mm = 4000};
  const auto film = filmOf(3, 48, 32, 16, [](int c, int r) { return 1000 + 20 * c + 10 * r; });
  const DisplayVolume box{.width_mm = 48, .height_mm = 32, .depth_mm = 40};
  const auto before = HeightField::make(film[1], distances, box);
  ASSERT_TRUE(before.has_value());
  for (const Enhancement how : kAll) {
    const auto frames = enhance(how, distances, film).frames;
    const DepthCalibration outcome = DepthEnhancer(how, distances).outcome();
    EXPECT_FALSE(outcome.unit_mm.has_value()) << name(how);
    const auto after = HeightField::make(frames[1], outcome, box);
    ASSERT_TRUE(after.has_value());
    for (int r = 4; r < 28;
         ++r) {  // smoothing may round off the margin, and move a sample by its neighbour's slope, .23 mm
      for (int c = 4; c < 44; ++c) ASSERT_NEAR(after->heightMm(c, r), before->heightMm(c, r), 0.3) << name(how);
    }
  }
}

TEST(EnhanceEnhancer, IsCloserToTheTruthThanWhatItWasGiven) {
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0, 2);
  const auto truth = [](int c, int r) { return 60 + 0.35 * c + 0.2 * r + 12 * std::sin(c * 0.03); };
  const auto film = filmOf(9, 160, 110, 8, [&](int c, int r) { return truth(c, r) + noise(random); });
  const auto rms = [&](const Frame& frame) {
    double sum = 0;
    for (int r = 0; r < 110; ++r) {
      for (int c = 0; c < 160; ++c) sum += std::pow(codeAt(frame, c, r) / 257.0 - truth(c, r), 2);
    }
    return std::sqrt(sum / (160 * 110));
  };
  std::map<Enhancement, double> error;
  for (const Enhancement how : kAll) {
    const Passage run = enhance(how, {}, film);
    error[how] = rms(run.frames[4]);
    EXPECT_NEAR(run.summary.noise_before, 2, 0.2);
    EXPECT_LT(run.summary.noise_after, 0.5);
  }
  EXPECT_LT(error[Enhancement::Median], 2 / 2.5);
  EXPECT_LT(error[Enhancement::Dibm], error[Enhancement::Median]);
  EXPECT_LT(error[Enhancement::SpaceTime], 0.5 * error[Enhancement::Median]);
}

// For this bump, rounding off is most of the error of dibm; the rest is the noise that the median leaves.
TEST(EnhanceEnhancer, EstimatesTheErrorThatIsLeft) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 3);
  constexpr int kWidth = 400, kHeight = 300;
  const auto truth = [](int c, int r) { return 100 + 30 * std::sin(c * 0.1) * std::cos(r * 0.08); };
  const auto film = filmOf(3, kWidth, kHeight, 8, [&](int c, int r) { return truth(c, r) + noise(random); });
  for (const Enhancement how : {Enhancement::Median, Enhancement::Dibm}) {
    const Passage run = enhance(how, {}, film);
    double sum = 0;
    for (int r = 0; r < kHeight; ++r) {
      for (int c = 0; c < kWidth; ++c) sum += std::pow(codeAt(run.frames[1], c, r) / 257.0 - truth(c, r), 2);
    }
    const double error = std::sqrt(sum / (kWidth * kHeight));
    EXPECT_GT(run.summary.error_after, 0.5 * error) << name(how);
    EXPECT_LT(run.summary.error_after, 1.5 * error) << name(how);
    EXPECT_NEAR(run.summary.error_before, 3, 0.3);
  }
}

// The steps of 8 bits are rounding, not shape: a picture needs about as many points as in 16 bits.
TEST(EnhanceEnhancer, StepsOfCodesAreNoFeaturePoints) {
  const auto waves = [](int c, int r) {
    return 120 + 40 * std::sin(c * 0.01) + 4 * std::sin(c * 0.1) * std::sin(r * 0.08);
  };
  const auto points = [&](int bits) {
    const auto film = filmOf(1, 720, 160, bits, [&](int c, int r) { return waves(c, r) * (bits == 16 ? 257 : 1); });
    return enhance(Enhancement::Dibm, {.bits = bits}, film).summary.points;
  };
  EXPECT_LT(points(8), 1.5 * points(16)) << points(8) << " " << points(16);
}

// 720 samples wide, the reference size. Noise moves the corners, which costs a few points.
TEST(EnhanceEnhancer, APlaneTakesFourPointsAndWithNoiseAFewMore) {
  std::mt19937 random(9);
  for (const double sigma : {0.0, 1.0, 4.0}) {
    std::normal_distribution<double> noise(0, sigma > 0 ? sigma : 1e-9);
    const auto film = filmOf(2, 720, 100, 8, [&](int c, int r) { return 40 + 0.2 * c + 0.1 * r + noise(random); });
    const EnhancementSummary summary = enhance(Enhancement::Dibm, {}, film).summary;
    EXPECT_LE(summary.most_points, sigma > 0 ? 72u : 4u) << sigma << ": a thousandth of the samples";
    EXPECT_GE(summary.bound, DepthEnhancer::kBoundLevels + 0.5);
    EXPECT_LT(summary.bound, 2);
  }
}

// When an edge alternates between two positions, no picture blends in the other.
TEST(EnhanceEnhancer, AMovingEdgeStaysSharp) {
  std::vector<Frame> film;
  for (int k = 0; k < 9; ++k) {
    film.push_back(
        test::makeGrayFrame(80, 40, 8, mediaTime(0.04 * k), [&](int c, int) { return c < 20 + 4 * k ? 200 : 50; }));
  }
  for (const Enhancement how : kAll) {
    const Passage run = enhance(how, {}, film);
    for (int k = 0; k < 9; ++k) {
      for (int c = 0; c < 80; ++c)
        EXPECT_EQ(codeAt(run.frames[k], c, 20), 257 * (c < 20 + 4 * k ? 200 : 50)) << name(how);
    }
  }
}

TEST(EnhanceEnhancer, HolesComeOutAsCodeZeroAndNothingElseDoes) {
  const DepthCalibration calibration{.bits = 8, .invalid = 255};
  const auto film = filmOf(3, 100, 60, 8, [](int c, int) { return c < 50 ? 255 : 0; });
  for (const Enhancement how : kAll) {
    const Passage run = enhance(how, calibration, film);
    EXPECT_EQ(codeAt(run.frames[1], 20, 30), 0);
    EXPECT_EQ(codeAt(run.frames[1], 70, 30), 1) << "the far end is not a hole";
    EXPECT_EQ(run.summary.holes, 3u * 50 * 60);
    EXPECT_EQ(DepthEnhancer(how, calibration).outcome().invalid, CodeSet(0));
  }
}

TEST(EnhanceEnhancer, TakesTheSmallestPicturesAndSuchWithoutDepth) {
  const DepthCalibration calibration{.bits = 8, .invalid = 0};
  for (const auto& [cols, rows] : {std::pair{1, 1}, {2, 2}, {1, 9}, {9, 1}, {40, 30}}) {
    for (const int code : {0, 77}) {
      const auto film = filmOf(4, cols, rows, 8, [&](int, int) { return code; });
      for (const Enhancement how : kAll) {
        const Passage run = enhance(how, calibration, film);
        ASSERT_EQ(run.frames.size(), 4u);
        for (const Frame& frame : run.frames) EXPECT_EQ(codeAt(frame, cols - 1, rows - 1), 257 * code);
      }
    }
  }
  for (const Enhancement how : kAll) {  // no pictures at all
    DepthEnhancer enhancer(how, {});
    enhancer.finish();
    EXPECT_FALSE(enhancer.next().has_value());
    EXPECT_EQ(enhancer.summary().noise_before, 0);
  }
}

// Noise, a step, narrow and wide holes, over several bands of rows.
TEST(EnhanceEnhancer, GivesTheSameWithAnyNumberOfThreads) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 2);
  const auto film = filmOf(6, 170, 131, 8, [&](int c, int r) {
    const bool hole = (c % 41 == 3 && r > 20) || std::hypot(c - 60, r - 50) < 15;
    return hole ? 0.0 : std::max(1.0, (c + r > 150 ? 160.0 : 60.0) + 0.2 * c + noise(random));
  });
  for (const Enhancement how : kAll) {
    std::vector<Passage> runs;
    for (const int threads : {1, 2, 5}) {
      cv::setNumThreads(threads);
      runs.push_back(enhance(how, {.invalid = 0}, film));
    }
    cv::setNumThreads(-1);
    EXPECT_GT(runs[0].summary.filled, 0u);
    EXPECT_GT(runs[0].summary.holes, runs[0].summary.filled);
    for (const Passage& run : {runs[1], runs[2]}) {
      EXPECT_EQ(run.summary.filled, runs[0].summary.filled) << name(how);
      EXPECT_EQ(run.summary.error_after, runs[0].summary.error_after) << name(how);
      for (std::size_t i = 0; i < film.size(); ++i) {
        const auto bytes = [&](const Passage& of) {
          const Frame& frame = of.frames.at(i);
          return std::string(reinterpret_cast<const char*>(frame.planes[0].data), std::size_t{170} * 131 * 2);
        };
        ASSERT_TRUE(bytes(run) == bytes(runs[0])) << name(how) << " " << i;
      }
    }
  }
}

TEST(EnhanceEnhancer, RefusesAnotherSizeAndWhatHasNoDepth) {
  DepthEnhancer enhancer(Enhancement::SpaceTime, {});
  ASSERT_TRUE(enhancer.add(filmOf(1, 8, 8, 8, [](int, int) { return 1; })[0]).has_value());
  EXPECT_EQ(enhancer.add(filmOf(1, 8, 9, 8, [](int, int) { return 1; })[0]).error().code, ErrorCode::Unsupported);

  DepthEnhancer hue(Enhancement::SpaceTime, {.code = DepthCode::Hue});
  auto added = hue.add(filmOf(1, 8, 8, 8, [](int, int) { return 1; })[0]);
  EXPECT_FALSE(added.has_value());
}

}  // namespace
}  // namespace relievo
