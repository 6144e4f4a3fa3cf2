// SPDX-License-Identifier: Apache-2.0
// Depth through H.264 and back: nothing is lost at crf 0, little at 23, and no code is scaled on the way.
#include "app/lab/film/coded_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include "app/lab/film/color_errors.h"
#include "app/lab/film/colored_depth.h"
#include "app/lab/film/depth_rendering.h"
#include "app/lab/film/requantised.h"
#include "app/lab/truth/true_surface.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

std::uint8_t codeAt(const Frame& frame, int c, int r) {
  return frame.planes[0].data[r * frame.planes[0].stride_bytes + c];
}

struct Errors {
  double mean = 0, rms = 0;
  int worst = 0;
};
Errors errorsOf(const std::vector<Frame>& truth, const std::vector<Frame>& coded) {
  Errors e;
  double count = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (int r = 0; r < truth[i].height; ++r) {
      for (int c = 0; c < truth[i].width; ++c) {
        const int error = codeAt(coded[i], c, r) - codeAt(truth[i], c, r);
        sum += error;
        squares += error * error;
        e.worst = std::max(e.worst, std::abs(error));
        ++count;
      }
    }
  }
  e.mean = sum / count;
  e.rms = std::sqrt(squares / count);
  return e;
}

std::vector<Frame> faceFilm(int cols, int rows) {
  return renderDepthFilm(*makeTrueSurface("face-nodding"), {.cols = cols, .rows = rows, .frames_per_s = 29.97}, 20);
}

TEST(CodedDepth, LosesNothingAtCrfZero) {
  for (const auto& [cols, rows] : {std::pair{240, 162}, {101, 67}}) {
    const std::vector<Frame> film = faceFilm(cols, rows);
    const auto coded = codeDepth(film, 0);
    ASSERT_TRUE(coded) << coded.error().message;
    ASSERT_EQ(coded->frames.size(), film.size());
    EXPECT_EQ(errorsOf(film, coded->frames).worst, 0);
  }
}

TEST(CodedDepth, FramesComeBackInOrderWithTheirTimesAndOwnTheirSamples) {
  std::vector<Frame> film = faceFilm(160, 108);
  auto coded = codeDepth(film, 23);
  ASSERT_TRUE(coded) << coded.error().message;
  ASSERT_EQ(coded->frames.size(), film.size());
  for (std::size_t i = 0; i < film.size(); ++i) {
    EXPECT_EQ(coded->frames[i].pts, film[i].pts);
    EXPECT_EQ(coded->frames[i].duration, film[i].duration);
    EXPECT_EQ(coded->frames[i].width, 160);
    EXPECT_EQ(coded->frames[i].height, 108);
    EXPECT_EQ(coded->frames[i].range, ColorRange::Full);
  }
  const Frame last = coded->frames.back();
  coded->frames.clear();
  EXPECT_LT(errorsOf({film.back()}, {last}).rms, 1.5);
}

TEST(CodedDepth, CoarserCodingCostsAccuracyAndSavesBytes) {
  const std::vector<Frame> film = faceFilm(360, 243);
  double rms = 0;
  std::uint64_t bytes = codeDepth(film, 0)->bytes;
  for (const int crf : {18, 23, 28, 40}) {
    const auto coded = codeDepth(film, crf);
    ASSERT_TRUE(coded) << coded.error().message;
    const Errors e = errorsOf(film, coded->frames);
    EXPECT_GT(e.rms, rms) << crf;
    EXPECT_LT(coded->bytes, bytes) << crf;
    if (crf == 23) {
      EXPECT_GT(e.rms, 0.1);
      EXPECT_LT(e.rms, 1.5);  // a scaling to limited range would be 10 codes and more
      EXPECT_LT(std::abs(e.mean), 0.3);
    }
    rms = e.rms;
    bytes = coded->bytes;
  }
}

TEST(CodedDepth, RefusesWhatItCannotCode) {
  const auto s = makeTrueSurface("plane");
  EXPECT_FALSE(codeDepth({}, 23));
  EXPECT_FALSE(codeDepth(renderDepthFilm(*s, {.cols = 32, .rows = 32, .bits = 16}, 2), 23));
  std::vector<Frame> film = renderDepthFilm(*s, {.cols = 32, .rows = 32}, 3);
  std::swap(film[0], film[1]);
  EXPECT_FALSE(codeDepth(film, 23));
  std::vector<Frame> sizes{renderDepth(*s, {.cols = 32, .rows = 32}, 0), renderDepth(*s, {.cols = 64, .rows = 32}, 1)};
  EXPECT_FALSE(codeDepth(sizes, 23));
}

TEST(HeightErrorSum, ASampleWithoutAReadingCountsForNothing) {
  const DisplayVolume volume{100, 100, 40};
  const Frame exact = test::makeGrayFrame(4, 1, 8, MediaTime{}, [](int, int) { return 128; });
  const Frame coded = test::makeGrayFrame(4, 1, 8, MediaTime{}, [](int c, int) { return c < 3 ? 0 : 138; });
  HeightErrorSum heights;
  heights.add(*HeightField::make(coded, {.invalid = *CodeSet::parse("0")}, volume),
              *HeightField::make(exact, {}, volume));
  EXPECT_NEAR(heights.rms(), 40 * 10 / 255.0, 1e-9);
  EXPECT_NEAR(heights.largest(), 40 * 10 / 255.0, 1e-9);
}

// Two levels in the colours of turbo. A chroma sample that lies across their step has a colour of neither, which is
// naively read as another level.
TEST(ColorErrors, TellColoursThatAStepMixes) {
  constexpr int kSide = 64;
  const DepthCalibration meaning = meaningOf(8, DepthSteps::Turbo);
  const auto errorsOf = [&](int step) {
    auto codes = std::make_shared<std::vector<std::uint16_t>>();
    for (int i = 0; i < kSide * kSide; ++i) codes->push_back(i % kSide < step ? 15000 : 50000);
    const Frame depth = grayFrame(std::move(codes), kSide, kSide), painted = colored(depth, meaning);
    ColorErrors errors;
    errors.add(painted, meaning, HeightField::make(painted, meaning, TrueSurface::kVolume).value(),
               HeightField::make(depth, {.bits = 16}, TrueSurface::kVolume).value());
    return errors;
  };
  using enum ColorErrors::Reading;
  EXPECT_LT(errorsOf(32).p99(Naive, true), 0.01);
  EXPECT_LT(errorsOf(32).p99(Own, true), 0.01);
  EXPECT_GT(errorsOf(33).p99(Naive, true), 0.05);
  EXPECT_GT(errorsOf(33).p99(Naive, false), 0.05) << "two of 64 columns";
  EXPECT_LT(errorsOf(33).p99(Own, true), 0.05);
}

}  // namespace
}  // namespace relievo
