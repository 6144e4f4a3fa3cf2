// SPDX-License-Identifier: Apache-2.0
// The uniform grid that the player's network is compared with: it uses true samples and gives the same surface.
#include "app/lab/detail/uniform_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/lab/detail/drawing_stage.h"
#include "drivers/egl/egl.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kHalf = kWidth / 2;
constexpr double kScreenZ = 20, kEyes = 63, kDistance = 600;

class UniformGridDrawing : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = DrawingStage::open(*display_, kWidth, kHeight);
    if (!opened && opened.error().error.code == ErrorCode::Unsupported) {
      GTEST_SKIP() << "this machine has no EGL with GLES 3";
    }
    ASSERT_TRUE(opened) << opened.error().error.message;
    stage_ = std::move(*opened);
  }
  Image show(const Frame& color, const Frame& depth, const DrawnLevel& level) {
    const auto shown = stage_->show(color, depth, level);
    EXPECT_TRUE(shown) << shown.error().error.message;
    return {kWidth, kHeight, stage_->picture().rgba};
  }

  ManualClock clock_;
  std::unique_ptr<Display> display_ = makeOffscreenDisplay({}, clock_);
  std::unique_ptr<DrawingStage> stage_;
};

// Every fourth sample of 720 x 486, and the last one, are at a fifth of the height, all others at zero. A white square
// at height h above the screen plane is shifted between the eyes by e h / (d - h).
TEST_F(UniformGridDrawing, StandsOnEveryFourthSampleAndTheLast) {
  const auto sieve = makeGrayFrame(720, 486, 8, MediaTime{}, [](int c, int r) {
    const bool column = c % 4 == 0 || c == 719;
    const bool row = r % 4 == 0 || r == 485;
    return column && row ? 51u : 0u;
  });
  const auto square = makeRgbFrame(640, 432, [](int x, int y) {
    return std::abs(x - 320) <= 4 && std::abs(y - 216) <= 4 ? Rgb{255, 255, 255} : Rgb{0, 0, 0};
  });
  const Image image = show(square, sieve, {.grid_step = 4});
  const double pixels_per_mm = eyeViews({}, DisplayVolume::forPicture(720, 486), kWidth, kHeight).pixels_per_mm;
  const double h = 8 - kScreenZ;
  const double shift = image.centroid(0, 0, kHalf).x - (image.centroid(0, kHalf, kWidth).x - kHalf);
  EXPECT_NEAR(shift, pixels_per_mm * kEyes * h / (kDistance - h), 0.25);
  EXPECT_EQ(stage_->triangles(), 2U * 180 * 122);
}

TEST_F(UniformGridDrawing, OfAllSamplesIsTheSurfaceThatThePlayerDraws) {
  const auto hills = makeGrayFrame(160, 108, 8, MediaTime{}, [](int c, int r) {
    return static_cast<std::uint32_t>(128 + 90 * std::sin(c * 0.07) * std::cos(r * 0.09));
  });
  const auto color = makeRgbFrame(160, 108, [](int x, int y) { return Rgb{x, 255 - x, (x / 8 + y / 8) % 2 * 255}; });
  const Image grid = show(color, hills, {.grid_step = 1});
  EXPECT_LT(grid.meanDifference(show(color, hills, {.error_px = 0.02})), 0.3);
  EXPECT_GT(grid.meanDifference(show(color, hills, {.grid_step = 40})), 1.0);  // a coarse grid must differ
}

TEST_F(UniformGridDrawing, RefusesWhatItDoesNotRead) {
  const auto color = makeRgbFrame(8, 8, [](int, int) { return Rgb{255, 255, 255}; });
  const auto shown = stage_->show(color, makePlane(8, 8, 16, 30000), {.grid_step = 1});
  ASSERT_FALSE(shown);
  EXPECT_EQ(shown.error().error.code, ErrorCode::Unsupported);
}

}  // namespace
}  // namespace relievo::test
