// SPDX-License-Identifier: Apache-2.0
// Which colour map a coded picture shows, and that photos, gray and noise show none; and the depth read from it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "app/media/pair_reader.h"
#include "app/media/reading/color_map_fit.h"
#include "app/scene/height_field.h"
#include "platform/print.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;
using Rgb = std::array<double, 3>;

constexpr int kCols = 160, kRows = 112;
constexpr DisplayVolume kUnit{160, 112, 1};

// A slope behind a disc.
double depthAt(int c, int r) {
  const double x = c - 70.0, y = r - 50.0;
  return x * x + y * y < 900 ? 0.8 - 0.0002 * x * x : 0.15 + 0.3 * c / kCols;
}

Rgb hue(double s) {
  const auto part = [&](double n) { return std::clamp(std::abs(std::fmod(6 * s + n, 6) - 3) - 1, 0.0, 1.0); };
  return {part(0), part(4), part(2)};
}
Rgb jet(double s) {
  const auto part = [&](double middle) { return std::clamp(1.5 - std::abs(4 * s - middle), 0.0, 1.0); };
  return {part(3), part(2), part(1)};
}
Rgb rainbow(double s) {
  return {std::min(1.0, std::abs(2 * s - 0.5)), std::sin(std::numbers::pi * s), std::cos(std::numbers::pi * s / 2)};
}

struct Weights {
  double red, blue;
};
constexpr Weights kBt601{0.299, 0.114}, kBt709{0.2126, 0.0722};

// Limited YUV that states no matrix; chroma is that of the sample at the left and above.
ClipTrack coded(const std::function<Rgb(int, int)>& color, const char* crf, const Weights& by = kBt601) {
  ClipTrack track{.codec = "libx264", .pix_fmt = "yuv420p", .width = kCols, .height = kRows, .frames = 2};
  track.options = {{"crf", crf}};
  track.sample = [color, by](int k, int c, int r, int) {
    const Rgb at = k == 0 ? color(c, r) : color(2 * c, 2 * r);
    const double y = by.red * at[0] + (1 - by.red - by.blue) * at[1] + by.blue * at[2];
    const double codes[] = {16 + 219 * y, 128 + 112 * (at[2] - y) / (1 - by.blue),
                            128 + 112 * (at[0] - y) / (1 - by.red)};
    return static_cast<std::uint32_t>(std::lround(codes[k]));
  };
  return track;
}

// The first depth picture of a clip of this depth.
Frame firstPicture(const ClipTrack& track, DepthCode code) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {{.pix_fmt = "yuv420p", .frames = 2}});
  makeClip(folder / "depth.mkv", {track});
  PairReader reader(kFfmpeg);
  if (!reader.open({.url = folder / "color.mkv", .depth_url = folder / "depth.mkv", .depth_code = code})) return {};
  auto pair = reader.next();
  return pair && *pair ? (*pair)->depth : Frame{};
}

TEST(ColorMapFit, FindsTheMapOfACodedPictureAndReadsItsDepth) {
  const struct {
    DepthCode code;
    Rgb (*color)(double);
  } maps[] = {{DepthCode::Hue, hue}, {DepthCode::Jet, jet}, {DepthCode::Rainbow, rainbow}};
  for (const auto& map : maps) {
    for (const char* crf : {"18", "23"}) {
      const Frame picture = firstPicture(coded([&](int c, int r) { return map.color(depthAt(c, r)); }, crf), map.code);
      ASSERT_FALSE(picture.empty());
      const auto fit = bestColorMap(picture);
      ASSERT_TRUE(fit) << name(map.code) << " crf " << crf;
      EXPECT_EQ(fit->code, map.code) << name(fit->code) << ", not " << name(map.code);
      EXPECT_LT(fit->residual, 0.02);
      EXPECT_GT(fit->share, 0.9);

      const auto field = HeightField::make(picture, {.code = map.code}, kUnit).value();
      int off = 0, far_off = 0;
      for (int r = 0; r < kRows; ++r) {
        for (int c = 0; c < kCols; ++c) {
          const double error = std::abs(field.heightMm(c, r) - depthAt(c, r));
          off += error < 0.03 ? 0 : 1;
          far_off += error < 0.4 ? 0 : 1;  // a wall, a hole
        }
      }
      EXPECT_LT(off, kCols * kRows / 50) << name(map.code) << " crf " << crf;
      EXPECT_LT(far_off, kCols * kRows / 300) << name(map.code) << " crf " << crf;
    }
  }
}

constexpr int kLarge = 7;  // 784 rows: players take such a film that states no matrix to be by BT.709

// A film of depth in a map's colours by either matrix, without or with a photo left of it.
ClipTrack largeFilm(Rgb (*map)(double), const Weights& by, bool beside_photo) {
  const auto color = [=](int c, int r) {
    const int x = c / kLarge - (beside_photo ? kCols : 0), y = r / kLarge;
    return x < 0 ? Rgb{0.5 + 0.2 * std::sin(0.3 * x), 0.45 + 0.001 * y, 0.4 + 0.1 * std::cos(0.2 * y)}
                 : map(depthAt(x, y));
  };
  ClipTrack track = coded(color, "18", by);
  track.width = kLarge * kCols * (beside_photo ? 2 : 1);
  track.height = kLarge * kRows;
  return track;
}

// The share of the samples of two pictures whose depth is off; all, if the film is not read as this code.
double offIn(const SourceOptions& options, DepthCode code) {
  PairReader reader(kFfmpeg);
  if (!reader.open(options) || reader.info().calibration.calibration.code != code) return 1;
  int off = 0;
  for (int picture = 0; picture < 2; ++picture) {
    const auto pair = reader.next();
    if (!pair || !*pair || (*pair)->depth.height != kLarge * kRows) return 1;
    const auto field = HeightField::make((*pair)->depth, {.code = code}, kUnit).value();
    for (int i = 0; i < kCols * kRows; ++i) {
      const int c = i % kCols, r = i / kCols;
      const double height = field.heightMm(kLarge * c + kLarge / 2, kLarge * r + kLarge / 2);
      off += std::abs(height - depthAt(c, r)) < 0.03 ? 0 : 1;
    }
  }
  return 0.5 * off / (kCols * kRows);
}

// OpenCV and FFmpeg convert RGB by BT.601 however large the picture is; other programs as their size has it.
TEST(ColorMapFit, AFilmThatStatesNoMatrixIsReadByTheOneThatItsColoursFit) {
  const struct {
    DepthCode code;
    Rgb (*color)(double);
  } maps[] = {{DepthCode::Hue, hue}, {DepthCode::Jet, jet}, {DepthCode::Rainbow, rainbow}};
  const TemporaryFolder folder;
  const std::string alone = folder / "depth.mkv", half = folder / "half.mkv", color = folder / "color.mkv";
  makeClip(color, {{.pix_fmt = "yuv420p", .frames = 2}});
  for (const auto& [code, map] : maps) {
    for (const Weights& by : {kBt601, kBt709}) {
      const std::string what = print("%s, red %g", name(code), by.red);
      makeClip(alone, {largeFilm(map, by, false)});
      makeClip(half, {largeFilm(map, by, true)});
      EXPECT_LT(offIn({.url = alone}, code), 0.02) << what;
      EXPECT_LT(offIn({.url = color, .depth_url = alone}, code), 0.02) << what;
      EXPECT_LT(offIn({.url = color, .depth_url = alone, .depth_code = code}, code), 0.02) << what;
      EXPECT_LT(offIn({.url = half}, code), 0.02) << what;
    }
  }
}

TEST(ColorMapFit, RefusesPhotosGrayNoiseBlackAndOneColour) {
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> any(0, 1);
  const std::pair<const char*, std::function<Rgb(int, int)>> pictures[] = {
      {"photo",
       [](int c, int r) { return Rgb{0.5 + 0.4 * std::sin(0.3 * c), 0.3 + 0.002 * r, 0.4 + 0.3 * std::cos(0.2 * r)}; }},
      {"gray slope", [](int c, int r) { return Rgb{depthAt(c, r), depthAt(c, r), depthAt(c, r)}; }},
      {"noise", [&](int, int) { return Rgb{any(random), any(random), any(random)}; }},
      {"black", [](int, int) { return Rgb{}; }},
      {"green", [](int, int) { return Rgb{0, 1, 0}; }}};
  for (const auto& [what, color] : pictures) {
    const Frame picture = firstPicture(coded(color, "18"), DepthCode::Luma);
    ASSERT_FALSE(picture.empty()) << what;
    EXPECT_FALSE(bestColorMap(picture)) << what;
  }
}

// Either end of a colour map may be near: that it is a guess is told until it is said.
TEST(ColorMapFit, AGuessedNearEndIsTold) {
  const TemporaryFolder folder;
  makeClip(folder / "color.mkv", {{.pix_fmt = "yuv420p", .frames = 2}});
  makeClip(folder / "depth.mkv", {coded([](int c, int r) { return jet(depthAt(c, r)); }, "18")});
  const auto doubtsFor = [&](const CalibrationSettings& said) {
    PairReader reader(kFfmpeg);
    EXPECT_TRUE(reader.open({.url = folder / "color.mkv", .depth_url = folder / "depth.mkv", .command_line = said}));
    return reader.info().reading.doubts;
  };
  EXPECT_THAT(doubtsFor({}), testing::Contains(testing::HasSubstr("--calibration polarity=near-low")));
  EXPECT_THAT(doubtsFor({{"polarity", "near-low"}}), testing::Not(testing::Contains(testing::HasSubstr("polarity="))));
}

// Jet over distances with 0 for "no depth", as many write a sensor's: dark blue is a hole, not the nearest wall.
TEST(ColorMapFit, AnEndApartFromTheOtherColoursIsAHole) {
  const TemporaryFolder folder;
  makeClip(folder / "color.mkv", {{.pix_fmt = "yuv420p", .width = kCols, .height = kRows, .frames = 2}});
  const auto infoOf = [&](const std::string& depth, const CalibrationSettings& said = {}) {
    PairReader reader(kFfmpeg);
    EXPECT_TRUE(reader.open({.url = folder / "color.mkv", .depth_url = depth, .command_line = said}));
    return reader.info();
  };
  const auto invalidOf = [&](const std::string& depth) { return infoOf(depth).calibration.calibration.invalid.text(); };
  for (const bool reversed : {false, true}) {
    const auto with_holes = [=](int c, int r) {
      const double s = c < 16 ? 0 : depthAt(c, r);
      return jet(reversed ? 1 - s : s);
    };
    makeClip(folder / "film.mkv", {coded(with_holes, "23")});
    // The same in a film may be a network's sky.
    EXPECT_EQ(invalidOf(folder / "film.mkv"), "none");
    const auto option = testing::HasSubstr(reversed ? "invalid=252-255" : "invalid=0-3");
    EXPECT_THAT(infoOf(folder / "film.mkv").reading.offers, testing::Contains(option));
    EXPECT_THAT(infoOf(folder / "film.mkv", {{"invalid", "none"}}).reading.offers, testing::IsEmpty());
    ClipTrack picture{.codec = "png", .pix_fmt = "rgb24", .width = kCols, .height = kRows, .frames = 1};
    picture.sample = [=](int k, int c, int r, int) {
      return static_cast<std::uint32_t>(std::lround(255 * with_holes(c, r)[static_cast<std::size_t>(k)]));
    };
    makeClip(folder / "depth.png", {picture});
    EXPECT_EQ(invalidOf(folder / "depth.png"), reversed ? "254-255" : "0-1");
  }
  EXPECT_EQ(infoOf(folder / "depth.png", {{"invalid", "none"}}).calibration.calibration.invalid.text(), "none");
  makeClip(folder / "whole.mkv", {coded([](int c, int r) { return jet(0.2 + depthAt(c, r)); }, "23")});
  EXPECT_EQ(invalidOf(folder / "whole.mkv"), "none");
  // A Kinect's ramp, from black over blue and cyan to white, has black for holes.
  const auto kinect = [](double s) {
    return Rgb{std::max(0.0, 3 * s - 2), std::clamp(3 * s - 1, 0.0, 1.0), std::min(1.0, 3 * s)};
  };
  makeClip(folder / "kinect.mkv", {coded([&](int c, int r) { return kinect(c < 16 ? 1 : depthAt(c, r)); }, "23")});
  EXPECT_EQ(invalidOf(folder / "kinect.mkv"), "0-8");
  makeClip(folder / "slope.mkv", {coded([](int c, int) { return jet(std::max(0.0, (c - 8.0) / kCols)); }, "23")});
  EXPECT_EQ(invalidOf(folder / "slope.mkv"), "none") << "the slope runs into the end";
}

// Distances through a map have the floor at its beginning, disparities at its end.
TEST(ColorMapFit, TheEndThatMakesTheFloorNearIsTaken) {
  const TemporaryFolder folder;
  for (const bool distances : {false, true}) {
    ClipTrack picture{.codec = "png", .pix_fmt = "rgb24", .width = kCols, .height = kRows, .frames = 1};
    picture.sample = [=](int k, int, int r, int) {
      const double s = 0.1 + 0.8 * r / kRows;
      return static_cast<std::uint32_t>(std::lround(255 * jet(distances ? 1 - s : s)[static_cast<std::size_t>(k)]));
    };
    makeClip(folder / "depth.png", {picture});
    PairReader reader(kFfmpeg);
    ASSERT_TRUE(reader.open({.url = folder / "depth.png"}));
    EXPECT_EQ(reader.info().calibration.calibration.polarity,
              distances ? DepthPolarity::NearIsLow : DepthPolarity::NearIsHigh);
    EXPECT_THAT(reader.info().reading.doubts,
                testing::Contains(testing::HasSubstr(distances ? "polarity=near-high" : "polarity=near-low")));
  }
}

}  // namespace
}  // namespace relievo
