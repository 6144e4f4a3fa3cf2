// SPDX-License-Identifier: Apache-2.0
// Depth registered to the colour camera's view, against numbers worked out on paper.
#include "app/media/registration/registration.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <utility>
#include <vector>

namespace relievo {
namespace {

using Row = std::vector<int>;

Frame depthOf(int cols, int rows, const std::function<int(int, int)>& mm) {
  const auto codes = std::make_shared<std::vector<std::uint16_t>>();
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) codes->push_back(static_cast<std::uint16_t>(mm(c, r)));
  }
  Frame frame{.width = cols, .height = rows, .plane_count = 1};
  frame.components[0] = {.step_bytes = 2, .bits = 16};
  frame.planes[0] = {reinterpret_cast<const std::uint8_t*>(codes->data()), 2 * cols};
  frame.owner = codes;
  return frame;
}

int codeOf(const Frame& frame, int c, int r) {
  const std::uint8_t* const at = frame.planes[0].data + r * frame.planes[0].stride_bytes + 2 * c;
  return at[0] | at[1] << 8;
}
Row rowOf(const Frame& frame, int r) {
  Row row;
  for (int c = 0; c < frame.width; ++c) row.push_back(codeOf(frame, c, r));
  return row;
}

// 16 x 8 pixels, focal length 100 pixels, principal point in the middle.
RigCamera camera() {
  return {.cols = 16, .rows = 8, .focal_x = 100, .focal_y = 100, .center_x = 7.5, .center_y = 3.5};
}

Result<Frame> registered(const Frame& depth, const Registration& registration) {
  return Registrar(registration).registered(depth);
}

TEST(Registration, OfTheSameCameraIsTheSamePicture) {
  const Frame depth = depthOf(16, 8, [](int c, int r) { return 500 + 37 * c + 11 * r; });
  const Frame there = registered(depth, {.depth = camera(), .color = camera()}).value();
  for (int r = 0; r < 8; ++r) EXPECT_EQ(rowOf(there, r), rowOf(depth, r)) << r;
  EXPECT_EQ(there.components[0].bits, 16);
}

// A camera 20 mm to the right sees a wall 1000 mm away shifted left by 100 * 20 / 1000 = 2 pixels, and a post in front
// of it, 500 mm away, by 4 pixels: over the wall, with a shadow of two pixels on the other side.
TEST(Registration, ACameraToTheRightSeesNearThingsFurtherLeftAndAShadowBehindThem) {
  const Frame depth = depthOf(16, 8, [](int c, int) { return c >= 8 && c < 11 ? 500 : 1000; });
  const Frame there = registered(depth, {.depth = camera(), .color = camera(), .translation_mm = {-20, 0, 0}}).value();
  const Row expected{1000, 1000, 1000, 1000, 500, 500, 500, 0, 0, 1000, 1000, 1000, 1000, 1000, 0, 0};
  for (int r = 0; r < 8; ++r) EXPECT_EQ(rowOf(there, r), expected) << r;
}

TEST(Registration, TheNearerOfTwoWinsWhicheverComesFirst) {
  for (const double to_left : {20.0, -20.0}) {
    const Frame depth = depthOf(16, 8, [](int c, int) { return c == 8 ? 500 : 1000; });
    const Frame there =
        registered(depth, {.depth = camera(), .color = camera(), .translation_mm = {to_left, 0, 0}}).value();
    EXPECT_EQ(codeOf(there, to_left > 0 ? 12 : 4, 3), 500);
  }
}

// Holes have no position.
TEST(Registration, HolesStayHoles) {
  const Frame depth = depthOf(16, 8, [](int c, int r) { return c == 5 && r == 2 ? 0 : 800; });
  const Frame there = registered(depth, {.depth = camera(), .color = camera()}).value();
  EXPECT_EQ(codeOf(there, 5, 2), 0);
  EXPECT_EQ(codeOf(there, 6, 2), 800);
}

// From 1000 mm further back everything is half as large, and distances are those from the colour camera.
TEST(Registration, FromFurtherBackThePictureShrinksAndDistancesGrow) {
  const Frame depth = depthOf(16, 8, [](int, int) { return 1000; });
  const Frame there = registered(depth, {.depth = camera(), .color = camera(), .translation_mm = {0, 0, 1000}}).value();
  for (int r = 0; r < 8; ++r) {
    for (int c = 0; c < 16; ++c) {
      const bool inside = c >= 4 && c < 12 && r >= 2 && r < 6;
      EXPECT_EQ(codeOf(there, c, r), inside ? 2000 : 0) << c << ' ' << r;
    }
  }
}

TEST(Registration, FromNearerThePictureGrowsWithoutGaps) {
  const Frame depth = depthOf(16, 8, [](int, int) { return 1000; });
  const Frame there = registered(depth, {.depth = camera(), .color = camera(), .translation_mm = {0, 0, -500}}).value();
  for (int r = 0; r < 8; ++r) EXPECT_EQ(rowOf(there, r), Row(16, 500)) << r;
}

// In units of 0.25 mm: the registered depth, seen from the other camera, has the same unit.
TEST(Registration, DistancesKeepTheirUnitAndThePictureItsTime) {
  Frame depth = depthOf(16, 8, [](int, int) { return 4000; });
  depth.pts = mediaTime(1.5);
  depth.duration = std::chrono::milliseconds(40);
  const Registration further{.depth = camera(), .color = camera(), .translation_mm = {0, 0, 1000}, .unit_mm = 0.25};
  const Frame there = registered(depth, further).value();
  EXPECT_EQ(codeOf(there, 8, 4), 8000);
  EXPECT_EQ(there.pts, mediaTime(1.5));
  EXPECT_EQ(there.duration, std::chrono::milliseconds(40));
}

// What lies behind the colour camera, or in its plane, is not in its picture. Nor are distances that the codes cannot
// hold, nor holes, wherever the camera is.
TEST(Registration, WhatTheOtherCameraCannotSeeOrTellIsAHole) {
  const auto seen = [](int code, double forward_mm) {
    const Frame depth = depthOf(16, 8, [code](int, int) { return code; });
    return registered(depth, {.depth = camera(), .color = camera(), .translation_mm = {0, 0, forward_mm}}).value();
  };
  for (const auto& [code, forward_mm] : {std::pair{1000, -1500.0}, {1000, -1000.0}, {60'000, 10'000.0}, {0, 1000.0}}) {
    const Frame there = seen(code, forward_mm);
    for (int r = 0; r < 8; ++r) EXPECT_EQ(rowOf(there, r), Row(16, 0)) << code << ' ' << forward_mm;
  }
  EXPECT_EQ(codeOf(seen(60'000, 5000), 8, 4), 65'000);
}

// Its axis is (8.3 + 0.5)/2 - 0.5 = 3.9 rows from the top, the depth's 3.5: not half a row.
TEST(Registration, ThePrincipalPointOfAnotherSizeIsThatOfPixelCentres) {
  const RigCamera tall{.cols = 32, .rows = 24, .focal_x = 200, .focal_y = 200, .center_x = 15.5, .center_y = 8.3};
  const Frame there =
      registered(depthOf(16, 8, [](int, int) { return 900; }), {.depth = camera(), .color = tall}).value();
  for (int r = 0; r < 12; ++r) EXPECT_EQ(codeOf(there, 8, r), r < 8 ? 900 : 0) << r;
}

// A colour camera with twice the pixels and a wider aspect ratio: the result is as wide as the depth, in the colour's
// aspect ratio, without gaps.
TEST(Registration, IsAsWideAsTheDepthAndOfTheColoursShape) {
  const RigCamera wide{.cols = 32, .rows = 24, .focal_x = 200, .focal_y = 200, .center_x = 8.3, .center_y = 11.5};
  const Frame depth = depthOf(16, 8, [](int, int) { return 900; });
  const Frame there = registered(depth, {.depth = camera(), .color = wide}).value();
  ASSERT_EQ(there.width, 16);
  ASSERT_EQ(there.height, 12);
  for (int r = 0; r < 12; ++r) EXPECT_EQ(codeOf(there, 9, r), r >= 2 && r < 10 ? 900 : 0) << r;
  // Its axis is (8.3 + 0.5)/2 - 0.5 = 3.9 columns from the left, the depth's 7.5: everything moves 3.6 columns left.
  for (int c = 0; c < 16; ++c) EXPECT_EQ(codeOf(there, c, 5), c < 12 ? 900 : 0) << c;
}

// Rotated by 90 degrees about its axis: columns become rows.
TEST(Registration, ATurnedCameraSeesTheSameTurned) {
  const RigCamera square{.cols = 8, .rows = 8, .focal_x = 100, .focal_y = 100, .center_x = 3.5, .center_y = 3.5};
  const Frame depth = depthOf(8, 8, [](int c, int r) { return 600 + 20 * c + r; });
  // x' = -y, y' = x: (c, r) goes to (7 - r, c).
  const Frame there =
      registered(depth, {.depth = square, .color = square, .rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1}}).value();
  for (int r = 0; r < 8; ++r) {
    for (int c = 0; c < 8; ++c) EXPECT_EQ(codeOf(there, 7 - r, c), codeOf(depth, c, r)) << c << ' ' << r;
  }
}

TEST(Registration, ItsFileSaysTheSame) {
  const auto read = parseRegistration(
      "[depth]\nsize = [640, 480]\nfocal = [600.5, 601]\ncenter = [319.5, 240]\nunit_mm = 0.25\n"
      "[color]\nsize = [1280, 720]\nfocal = [920, 920]\ncenter = [639.5, 359.5]\n"
      "[depth_to_color]\nrotation = [0, -1, 0, 1, 0, 0, 0, 0, 1]\ntranslation_mm = [-15, 0.5, 0]\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->depth.cols, 640);
  EXPECT_EQ(read->depth.focal_x, 600.5);
  EXPECT_EQ(read->depth.center_y, 240);
  EXPECT_EQ(read->color.rows, 720);
  EXPECT_EQ(read->unit_mm, 0.25);
  EXPECT_EQ(read->rotation[1], -1);
  EXPECT_EQ(read->translation_mm[0], -15);
}

TEST(Registration, RefusesWhatIsNone) {
  const std::string cameras =
      "[depth]\nsize = [640, 480]\nfocal = [600, 600]\ncenter = [320, 240]\n"
      "[color]\nsize = [640, 480]\nfocal = [600, 600]\ncenter = [320, 240]\n";
  ASSERT_TRUE(parseRegistration(cameras)) << "both cameras at one place";
  for (const std::string& text :
       {std::string("[depth"), std::string(), cameras + "[depth_to_color]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0]\n",
        cameras + "[depth_to_color]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0, -1]\n",
        cameras + "[depth_to_color]\nrotation = [2, 0, 0, 0, 2, 0, 0, 0, 2]\n",
        cameras + "[depth_to_color]\ntranslation_mm = [1, nan, 3]\n",
        std::string("[depth]\nsize = [640, 480]\nfocal = [0, 600]\ncenter = [320, 240]\n") + cameras.substr(58)}) {
    EXPECT_EQ(parseRegistration(text).error().code, ErrorCode::InvalidArgument) << text;
  }
  EXPECT_EQ(registered(Frame{}, {}).error().code, ErrorCode::Unsupported);
}

TEST(RegistrationFile, NamesThatNestTooDeepAreNoToml) {
  std::string deep = "[depth";
  for (int i = 0; i < 60'000; ++i) deep += ".a";
  const auto parsed = parseRegistration(deep + "]\n");
  ASSERT_FALSE(parsed);
  EXPECT_STREQ(parsed.error().message, "the registration is not valid TOML");
}

}  // namespace
}  // namespace relievo
