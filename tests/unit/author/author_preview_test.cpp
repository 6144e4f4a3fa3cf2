// SPDX-License-Identifier: Apache-2.0
// The preview picture: which film picture it shows, and its layout.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/author/preview/preview.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr RgbPixel kBefore{224, 142, 11}, kAfter{30, 136, 229}, kHole{94, 53, 177};
constexpr int kCols = 64, kRows = 48, kGap = 12, kPaneCols = 576, kPaneRows = 432;

ColorPicture420 grayColor(std::uint8_t luma) {
  ColorPicture420 color{.width = kCols, .height = kRows, .range = ColorRange::Full, .y = {}, .u = {}, .v = {}};
  color.y.assign(kCols * kRows, luma);
  color.u.assign(kCols * kRows / 4, 128);
  color.v = color.u;
  return color;
}

// A slope of 64 levels, raised by `high` levels, with a hole before the enhancement and none after it.
void show(Preview& preview, int index, int high, std::optional<std::uint64_t> expected) {
  const auto slope = [high](int c, int r) { return (c < 8 && r < 8) ? 0 : 50 + high + c; };
  const MediaTime time = mediaTime(0.04 * index);
  const auto color = grayColor(static_cast<std::uint8_t>(50 + high));
  const DepthCalibration calibration{.invalid = 0};
  preview.before(color, {.height_mm = 120}, test::makeGrayFrame(kCols, kRows, 8, time, slope), calibration, expected);
  preview.after(test::makeGrayFrame(kCols, kRows, 8, time, [high](int c, int) { return 51 + high + c; }), calibration);
}

long countOf(const RgbPicture& picture, const RgbPixel& color) {
  return std::count(picture.pixels.begin(), picture.pixels.end(), color);
}

TEST(AuthorPreview, HasThreePanesAndTheProfilesOfBothDepths) {
  Preview preview;
  show(preview, 0, 0, {});
  auto picture = preview.draw();
  ASSERT_TRUE(picture.has_value());
  ASSERT_EQ(picture->width, 3 * kPaneCols + 4 * kGap);
  ASSERT_EQ(picture->height, kPaneRows + 300 + 3 * kGap);
  EXPECT_EQ(picture->at(kGap + 100, kGap + 50), (RgbPixel{50, 50, 50})) << "the colour";
  // The hole is 8 of 64 samples wide and high in the first depth pane, and absent in the second.
  EXPECT_EQ(countOf(*picture, kHole), (kPaneCols / 8) * (kPaneRows / 6 - 1)) << "the line goes through it";
  EXPECT_EQ(picture->at(2 * kGap + kPaneCols + 5, kGap + 5), kHole);
  // The slope rises over the whole width, one level higher after than before.
  const auto top = [&](int x, const RgbPixel& color) {
    int y = kPaneRows + 2 * kGap;
    while (y < picture->height && picture->at(x, y) != color) ++y;
    return y;
  };
  for (const RgbPixel& color : {kBefore, kAfter}) EXPECT_GT(top(300, color), top(1400, color) + 100);
  EXPECT_LT(top(900, kAfter), top(900, kBefore));
  const RgbPixel& gray = picture->at(2 * (kGap + kPaneCols) + kGap + 300, kGap + 20);
  EXPECT_TRUE(gray[0] == gray[1] && gray[1] == gray[2] && gray[0] > 60) << "a lit relief";
}

TEST(AuthorPreview, IsOfTheMiddleWhereThatIsKnownElseOfTheFirst) {
  for (const bool known : {true, false}) {
    Preview preview;
    for (int k = 0; k < 6; ++k) show(preview, k, 20 * k, known ? std::optional<std::uint64_t>(6) : std::nullopt);
    const int level = known ? 50 + 20 * 3 : 50;
    EXPECT_EQ(preview.draw()->at(kGap + 100, kGap + 50)[0], level);
  }
}

// As in the player, whatever shape the depth has.
TEST(AuthorPreview, PanesHaveTheShapeOfTheBox) {
  Preview preview;
  const Frame depth = test::makeGrayFrame(kRows, kRows, 8, mediaTime(0), [](int c, int) { return 50 + c; });
  preview.before(grayColor(9), {.height_mm = 80}, depth, {}, {});
  preview.after(depth, {});
  EXPECT_EQ(preview.draw()->width, 3 * kPaneRows * 2 + 4 * kGap);
}

TEST(AuthorPreview, SaysWhenThereIsNothingToShow) {
  EXPECT_EQ(Preview().draw().error().code, ErrorCode::NotFound);
  Preview preview;  // a film of holes alone has a picture but no profiles
  const DepthCalibration calibration{.invalid = 0};
  const Frame holes = test::makeGrayFrame(kCols, kRows, 8, mediaTime(0), [](int, int) { return 0; });
  preview.before(grayColor(9), {.height_mm = 120}, holes, calibration, {});
  EXPECT_EQ(preview.draw().error().code, ErrorCode::NotFound) << "the enhanced picture has not arrived yet";
  preview.after(holes, calibration);
  const auto picture = preview.draw();
  ASSERT_TRUE(picture.has_value());
  EXPECT_GE(countOf(*picture, kHole), 2 * kPaneCols * (kPaneRows - 1));
}

TEST(AuthorPreview, IsAPng) {
  const auto png = encodePng(RgbPicture(300, 200, {1, 2, 3}));
  ASSERT_TRUE(png.has_value());
  ASSERT_GT(png->size(), 60u);
  EXPECT_EQ(png->substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png->substr(12, 12), std::string("IHDR\0\0\x01\x2c\0\0\0\xc8", 12)) << "300 by 200";
  EXPECT_EQ(png->substr(png->size() - 8, 4), "IEND");
}

}  // namespace
}  // namespace relievo
