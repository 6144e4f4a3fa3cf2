// SPDX-License-Identifier: Apache-2.0
// Distances far behind all else: a renderer's sky or far plane as one code, or a few of a sensor's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/known_kind.h"
#include "app/scene/height_field.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::distanceMm;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kCols = test::kSceneCols, kRows = test::kSceneRows;

// The scene, with `background` mm where its camera sees nothing.
Frame rendered(double codes_per_mm, double background_mm, double value_per_code = 0, int bits = 16) {
  Frame frame = test::makeGrayFrame(kCols, kRows, bits, {}, [&](int c, int r) {
    const double mm = distanceMm(c, r);
    return std::lround(codes_per_mm * (mm == 0 ? background_mm : mm));
  });
  frame.value_per_code = value_per_code;
  return frame;
}

DepthMeaning meaningOf(const Frame& frame, DepthClues clues = {}) {
  const KnownKind* const kind = kindOf(clues, frame);
  return readMeaning(clues, kind, frame).value();
}

// Every distance of the shape is true, and uses most of the box; the background is a hole, which is said.
void expectInFront(const Frame& frame, const DepthClues& clues = {}) {
  const DepthMeaning meaning = meaningOf(frame, clues);
  const DepthCalibration& c = meaning.calibration.calibration;
  const auto field = HeightField::make(frame, c, {.width_mm = 1, .height_mm = 1, .depth_mm = 1}).value();
  for (int r = 0; r < kRows; r += 3) {
    for (int x = 0; x < kCols; x += 3) {
      const double mm = distanceMm(x, r), height = field.heightMm(x, r);
      ASSERT_EQ(std::isnan(height), mm == 0) << x << ", " << r;
      if (mm == 0) continue;
      ASSERT_NEAR(c.far_mm - height * (c.far_mm - c.near_mm), mm, 3) << x << ", " << r;
    }
  }
  EXPECT_LT(c.far_mm, 2300);
  EXPECT_THAT(meaning.reading.doubts, Contains(HasSubstr("--calibration invalid=0")));
}

TEST(FarBackground, IsAHoleInDistancesOfAnyUnit) {
  expectInFront(rendered(1, 20'000));
  expectInFront(rendered(1, 60'000));  // where brightness stretched to 16 bits would end
  expectInFront(rendered(5, 12'000), {.as = findKind("tum")});
  expectInFront(rendered(5, 12'000), {.tags = {{"DEPTH_UNIT", "0.2"}, {"DEPTH_INVALID", "0"}}});
  expectInFront(rendered(1, 20'000, 0.001), {.codec = "exr", .path = "depth.exr"});
  expectInFront(rendered(1, 20'000, 0.001), {.codec = "pfm", .path = "depth/1.pfm"});
}

TEST(FarBackground, DoesNotMakeMillimetresFineCodes) {
  EXPECT_EQ(meaningOf(rendered(1, 20'000)).calibration.calibration.unit_mm, 1);
}

TEST(FarBackground, IsTakenAsADistanceIfTheUserSaysSoOrItIsAsNearAsAWall) {
  const DepthMeaning said = meaningOf(rendered(1, 20'000), {.command_line = {{"invalid", "0"}}});
  EXPECT_GT(said.calibration.calibration.far_mm, 20'000);
  EXPECT_THAT(said.reading.doubts, IsEmpty());
  EXPECT_NEAR(meaningOf(rendered(1, 2'700)).calibration.calibration.far_mm, 1.1 * 2'700, 1);
}

TEST(FarBackground, IsLeftInWhatIsNoDistance) {
  // A near thing that stands clear of all others, in disparities and in brightness.
  const DepthMeaning disparities = meaningOf(rendered(1, 20'000, 0.01), {.codec = "pfm", .path = "disp.pfm"});
  EXPECT_EQ(disparities.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  EXPECT_GE(disparities.calibration.calibration.highCode(), 20'000);
  const DepthMeaning shades = meaningOf(rendered(0.05, 5'000, 0, 8));
  EXPECT_TRUE(shades.calibration.calibration.invalid.empty());
}

// A few distances that a sensor returns through a window, at rims, or wrong: each `one_in` of the scene's.
DepthMeaning withFarOnes(int one_in, double codes_per_mm, double value_per_code, CalibrationSettings said = {}) {
  Frame frame = test::makeGrayFrame(kCols, kRows, 16, {}, [&, i = 0](int c, int r) mutable {
    const double mm = distanceMm(c, r);
    const double far = ++i % one_in == 0 ? 9'000 + i % 3'000 : 0;
    return std::lround(codes_per_mm * (mm == 0 ? 0 : std::max(mm, far)));
  });
  frame.value_per_code = value_per_code;
  DepthClues clues{.command_line = std::move(said)};
  if (value_per_code != 0) clues.codec = "npy", clues.path = "depth.npy";
  return meaningOf(frame, clues);
}

TEST(FewFarDistances, DoNotFlattenTheSceneBeforeThem) {
  for (const double value_per_code : {0.0, 0.001}) {
    SCOPED_TRACE(value_per_code);
    const DepthMeaning few = withFarOnes(150, 1, value_per_code);
    EXPECT_NEAR(few.calibration.calibration.far_mm, 1.1 * 1'990, 20);
    EXPECT_THAT(few.reading.doubts,
                Contains(AllOf(HasSubstr("0.7 % of the depth lies beyond 1.9"), HasSubstr("near="))));
    const DepthMeaning said = withFarOnes(150, 1, value_per_code, {{"near", "900"}, {"far", "12000"}});
    EXPECT_EQ(said.calibration.calibration.far_mm, 12'000);
    EXPECT_THAT(said.reading.doubts, IsEmpty());
    const DepthMeaning part = withFarOnes(50, 1, value_per_code);  // a part of the scene
    EXPECT_GT(part.calibration.calibration.far_mm, 10'000);
    EXPECT_THAT(part.reading.doubts, IsEmpty());
  }
}

}  // namespace
}  // namespace relievo
