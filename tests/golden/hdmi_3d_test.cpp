// SPDX-License-Identifier: Apache-2.0
// HDMI 3D on cards of three kinds of kernel: which mode is set, what is printed about it, and what a television shows,
// compared with rays into a relief.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/egl/egl.h"
#include "tests/golden/ray_pictures.h"
#include "tests/support/device/card/fake_card.h"
#include "tests/support/device/card/real_televisions.h"
#include "tests/support/device/card/television_modes.h"

namespace relievo::test {
namespace {

using enum StereoSignal;

// A television at a card, with the display open on it; null without GLES 3.
class Television {
 public:
  Television(const char* driver, std::vector<drmModeModeInfo> modes) : card_(driver, std::move(modes)) {}
  Result<void> open(const DisplayConfig& config) { return display_->open(config); }
  void show(const Scene& scene) {
    auto renderer = SceneRenderer::create(std::chrono::hours(1)).value();
    renderer->setStereo(scene.stereo);
    renderer->setError(scene.error_px);
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    ASSERT_TRUE(renderer->setFrame(scene.color, scene.depth, scene.calibration, scene.volume));
    ASSERT_TRUE(renderer->draw(*surface, {}));
    const auto presented = display_->present();
    ASSERT_TRUE(presented) << presented.error().message;
  }
  [[nodiscard]] Image seen() const {
    CardPicture picture = card_.seen();
    return {picture.width, picture.height, std::move(picture.rgba)};
  }
  [[nodiscard]] DisplaySurface surface() { return display_->beginFrame().value(); }
  [[nodiscard]] Display& display() { return *display_; }
  [[nodiscard]] FakeCard& card() { return card_; }

 private:
  FakeCard card_;
  std::unique_ptr<Display> display_ = makeKmsDisplay(card_.path());
};

#define OPEN_OR_SKIP(television, ...)                                                          \
  if (const auto opened = (television).open({__VA_ARGS__}); !opened) {                         \
    if (opened.error().code == ErrorCode::Unsupported) GTEST_SKIP() << opened.error().message; \
    FAIL() << opened.error().message;                                                          \
  }

bool isBlack(const Image& image, int row) {
  for (int x = 0; x < image.width; ++x) {
    if (image.at(x, row) != Rgb{0, 0, 0}) return false;
  }
  return true;
}

struct Size {
  int width, height, gap;
};
constexpr Size kHd{1280, 720, 30}, kFullHd{1920, 1080, 45};

TEST(Hdmi3d, ATelevisionSeesTheLeftEyeOverTheRightOneInBothWaysOfFramePacking) {
  DrawnPicture golden = black(kHd.width, 2 * kHd.height + kHd.gap);
  paste(view(-kEyes / 2, kHd.width, kHd.height), 0, 0, golden);
  paste(view(kEyes / 2, kHd.width, kHd.height), 0, kHd.height + kHd.gap, golden);
  for (const char* driver : {"amdgpu", "vc4"}) {
    SCOPED_TRACE(driver);
    Television television(driver, mandatoryTelevision());
    OPEN_OR_SKIP(television, .width = kHd.width, .height = kHd.height, .stereo = FramePacking);
    television.show(sceneIn({.layout = StereoLayout::FramePacking}));
    EXPECT_GT(similarity(television.seen(), golden, 6), 0.97);
    television.show(sceneIn({.layout = StereoLayout::FramePacking, .swap_eyes = true}));
    EXPECT_LT(similarity(television.seen(), golden, 6), 0.96) << "with swapped eyes the picture must differ";
  }
}

TEST(Hdmi3d, BothWaysOfFramePackingSendTheSamePictures) {
  for (const Size& size : {kHd, kFullHd}) {
    SCOPED_TRACE(size.height);
    std::vector<Image> seen;
    for (const char* driver : {"amdgpu", "vc4"}) {
      Television television(driver, mandatoryTelevision());
      OPEN_OR_SKIP(television, .width = size.width, .height = size.height, .stereo = FramePacking);
      const bool halves = driver == std::string("vc4");
      const DisplaySurface surface = television.surface();
      EXPECT_EQ(surface.width, halves ? 2 * size.width : size.width);
      EXPECT_EQ(surface.height, halves ? size.height : 2 * size.height + size.gap);
      EXPECT_EQ(surface.eye_gap_rows, halves ? 0 : size.gap);
      EXPECT_EQ(surface.stereo, FramePacking);
      ASSERT_TRUE(television.display().present());
      television.show(sceneIn({.layout = StereoLayout::FramePacking}));
      television.show(sceneIn({.layout = StereoLayout::FramePacking}));
      EXPECT_EQ(television.card().bufferWidth(), surface.width);
      EXPECT_EQ(television.card().bufferHeight(), surface.height);
      EXPECT_EQ(television.card().rejected(), 0);
      seen.push_back(television.seen());
      ASSERT_EQ(seen.back().width, size.width);
      ASSERT_EQ(seen.back().height, 2 * size.height + size.gap);
      for (int row = size.height; row < size.height + size.gap; ++row) EXPECT_TRUE(isBlack(seen.back(), row)) << row;
      EXPECT_FALSE(isBlack(seen.back(), size.height - 1));
      EXPECT_FALSE(isBlack(seen.back(), size.height + size.gap));
    }
    EXPECT_LT(seen[0].meanDifference(seen[1]), 0.05) << "but for rounding at the triangles' edges";
  }
}

struct Choice {
  const char* driver;
  std::vector<drmModeModeInfo> modes;
  DisplayConfig config;
  StereoSignal sent;
  const char* words;
};

TEST(Hdmi3d, TheModeIsSaidInWordsAndSet) {
  const auto wish = [](StereoSignal signal, const Size& size = kHd, bool other = true) {
    return DisplayConfig{.width = size.width, .height = size.height, .stereo = signal, .other_stereo = other};
  };
  const Choice choices[] = {
      {"amdgpu", mandatoryTelevision(), wish(FramePacking), FramePacking,
       "HDMI-A-1, 1280x720 at 60.00 Hz, frame packing in one picture of 1280x1470"},
      {"i915", mandatoryTelevision(), wish(FramePacking, kFullHd), FramePacking,
       "HDMI-A-1, 1920x1080 at 24.00 Hz, frame packing in one picture of 1920x2205"},
      {"vc4", mandatoryTelevision(), wish(FramePacking, kFullHd), FramePacking,
       "HDMI-A-1, 1920x1080 at 24.00 Hz, frame packing as two halves of 3840x1080"},
      {"vc4", mandatoryTelevision(), wish(TopAndBottom), TopAndBottom,
       "HDMI-A-1, 1280x720 at 60.00 Hz, top and bottom"},
      {"i915", mandatoryTelevision(), wish(SideBySideHalf), FramePacking,
       "HDMI-A-1, 1280x720 at 60.00 Hz, frame packing in one picture of 1280x1470"},
      {"i915", mandatoryTelevision(), wish(SideBySideHalf, kHd, false), None,
       "HDMI-A-1, 1280x720 at 60.00 Hz, no 3D signal"},
      {"amdgpu", generousTelevision(), wish(SideBySideHalf, kFullHd), SideBySideHalf,
       "HDMI-A-1, 1920x1080 at 60.00 Hz, side by side"},
      {"amdgpu", generousTelevision(), wish(TopAndBottom, kFullHd), TopAndBottom,
       "HDMI-A-1, 1920x1080 at 60.00 Hz, top and bottom"},
      {"amdgpu", halvesTelevision(), wish(FramePacking), SideBySideHalf,
       "HDMI-A-1, 1920x1080 at 60.00 Hz, side by side"},
      {"i915", sonyTelevision(), wish(FramePacking, kFullHd), FramePacking,
       "HDMI-A-1, 1920x1080 at 30.00 Hz, frame packing in one picture of 1920x2205"},
      {"vc4", samsungTelevision(), wish(FramePacking, kFullHd), FramePacking,
       "HDMI-A-1, 1920x1080 at 30.00 Hz, frame packing as two halves of 3840x1080"},
      {"amdgpu", samsungTelevision(), wish(SideBySideHalf, kFullHd), SideBySideHalf,
       "HDMI-A-1, 1920x1080 at 60.00 Hz, side by side"},
      {"i915", lgTelevision(), wish(FramePacking), FramePacking,
       "HDMI-A-1, 1280x720 at 60.00 Hz, frame packing in one picture of 1280x1470"},
      {"i915", lgTelevision(), wish(SideBySideHalf, kFullHd), SideBySideHalf,
       "HDMI-A-1, 1920x1080 at 30.00 Hz, side by side"},
      {"amdgpu", panasonicTelevision(), wish(FramePacking, kFullHd), FramePacking,
       "HDMI-A-1, 1920x1080 at 24.00 Hz, frame packing in one picture of 1920x2205"},
      {"amdgpu", panasonicTelevision(), wish(TopAndBottom, kFullHd), TopAndBottom,
       "HDMI-A-1, 1920x1080 at 60.00 Hz, top and bottom"},
      {"nvidia-drm", plainTelevision(), wish(FramePacking, kFullHd), None,
       "HDMI-A-1, 1920x1080 at 60.00 Hz, no 3D signal"},
      {"nvidia-drm", plainTelevision(), wish(None), None, "HDMI-A-1, 1280x720 at 60.00 Hz, no 3D signal"},
  };
  for (const Choice& choice : choices) {
    SCOPED_TRACE(choice.words);
    Television television(choice.driver, choice.modes);
    if (const auto opened = television.open(choice.config); !opened) GTEST_SKIP() << opened.error().message;
    EXPECT_EQ(television.display().description(), choice.words);
    const DisplaySurface surface = television.surface();
    EXPECT_EQ(surface.stereo, choice.sent);
    ASSERT_TRUE(television.display().present());
    const drmModeModeInfo mode = television.card().mode().value();
    EXPECT_EQ(mode.flags & DRM_MODE_FLAG_INTERLACE, 0U);
    const std::uint32_t flag = choice.sent == FramePacking     ? DRM_MODE_FLAG_3D_FRAME_PACKING
                               : choice.sent == TopAndBottom   ? DRM_MODE_FLAG_3D_TOP_AND_BOTTOM
                               : choice.sent == SideBySideHalf ? DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF
                                                               : 0;
    EXPECT_EQ(mode.flags & DRM_MODE_FLAG_3D_MASK, flag);
    television.display().close();
    EXPECT_FALSE(television.card().mode()) << "what was there before is given back";
  }
}

// A compositor with HDR and a night light, on another virtual terminal.
TEST(Hdmi3d, WhatAnotherProgramLeftIsUndoneWhereTheCardTakesIt) {
  for (const bool keeps : {false, true}) {
    Television television("i915", plainTelevision());
    television.card().wasUsed(keeps);
    OPEN_OR_SKIP(television, .width = kHd.width, .height = kHd.height);
    (void)television.surface();
    ASSERT_TRUE(television.display().present());
    EXPECT_EQ(television.card().left().size(), keeps ? 5U : 0U);
    EXPECT_EQ(television.card().rejected(), keeps ? 1 : 0);
    EXPECT_EQ(television.card().mode().value().vdisplay, kHd.height);
  }
}

TEST(Hdmi3d, FramePackingAloneIsRefusedWhereTheKernelListsNone) {
  Television television("nvidia-drm", plainTelevision());
  const auto opened = television.open({.stereo = FramePacking});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("does not support frame packing"));
}

}  // namespace
}  // namespace relievo::test
