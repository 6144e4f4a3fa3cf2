// SPDX-License-Identifier: Apache-2.0
// The full-screen display in a guest with two screens: its modes, its refresh, how it is lost, found and closed.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "drivers/egl/egl.h"
#include "tests/golden/kms_display.h"

namespace relievo::test {
namespace {

TEST_F(KmsDisplay, TheModeIsTheOneAskedForElseTheScreensFavourite) {
  const struct {
    DisplayConfig wish;
    int width, height;
  } cases[] = {{{800, 600}, 800, 600}, {{1024, 768}, 1024, 768}, {{1234, 567}, 1280, 800}};
  for (const auto& [wish, width, height] : cases) {
    open(wish);
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->width, width);
    EXPECT_EQ(surface->height, height);
    EXPECT_EQ(surface->stereo, StereoSignal::None);
    EXPECT_EQ(surface->eye_gap_rows, 0);
    fill(0, 0, width, height, 1, 1, 0);
    ASSERT_TRUE(display_->present());
    EXPECT_TRUE(untilShows(width, height, width - 1, height - 1, {255, 255, 0})) << width;
    display_->close();
  }
}

TEST_F(KmsDisplay, WhatWasOnTheScreenBeforeIsGivenBack) {
  const auto now = [&] {
    const UniqueFd card(::open(screen_->card().c_str(), O_RDWR | O_CLOEXEC));
    drmModeRes* all = drmModeGetResources(card.get());
    drmModeCrtc* crtc = drmModeGetCrtc(card.get(), all->crtcs[0]);
    const std::array<std::uint32_t, 3> state{crtc->buffer_id, crtc->mode.hdisplay, crtc->mode.vdisplay};
    drmModeFreeCrtc(crtc);
    drmModeFreeResources(all);
    return state;
  };
  const auto before = now();
  ASSERT_NE(before[0], 0u) << "the kernel's console is on it";
  open({640, 480});
  EXPECT_EQ(now(), before) << "until there is a picture";
  show(kRed, kRed);
  EXPECT_NE(now(), before);
  show(kRed, kRed);
  display_->close();
  EXPECT_EQ(now(), before);
  EXPECT_TRUE(untilDump([&](const ScreenDump& dump) { return dump.width == static_cast<int>(before[1]); }));
}

TEST_F(KmsDisplay, PulledOutItIsLostAndPutInItOpensAgain) {
  open({1280, 800});
  show(kRed, kBlue);
  ASSERT_TRUE(display_->attend());
  screen_->plug(false);
  EXPECT_EQ(attendUntilRefused(), ErrorCode::Lost);
  display_->close();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(display_->open({1280, 800}).error().code, ErrorCode::NotFound);
  screen_->plug(true);
  open({1280, 800});
  show(kGreen, kBlue);
  EXPECT_TRUE(untilShows(1280, 800, 10, 10, {0, 255, 0}));
}

TEST_F(KmsDisplay, TheFirstCardThatHasAScreenIsTaken) {
  const auto other = GuestScreen::find("vkms");
  ASSERT_NE(other, nullptr);
  const auto any = makeKmsDisplay();
  screen_->plug(false);
  other->plug(false);
  EXPECT_EQ(any->open({}).error().code, ErrorCode::NotFound);
  screen_->plug(true);
  ASSERT_TRUE(any->open({1280, 800}));
  const auto surface = any->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->width, 1280);
  fill(0, 0, 1280, 800, 1, 0, 1);
  ASSERT_TRUE(any->present());
  EXPECT_TRUE(untilShows(1280, 800, 10, 10, {255, 0, 255}));
}

TEST_F(KmsDisplay, ACardThatAnotherProgramShowsOnIsRefused) {
  const UniqueFd other(::open(screen_->card().c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_EQ(drmSetMaster(other.get()), 0);
  EXPECT_EQ(display_->open({}).error().code, ErrorCode::PermissionDenied);
  EXPECT_THAT(lookAtKmsScreens().at(0).state, testing::HasSubstr("another program uses this card's screens"));
  ASSERT_EQ(drmDropMaster(other.get()), 0);
  open({});
  EXPECT_NE(drmSetMaster(other.get()), 0);
  display_->close();
  EXPECT_EQ(drmSetMaster(other.get()), 0) << "it lets go";
}

TEST_F(KmsDisplay, WithoutThatCardItSaysSo) {
  const auto opened = makeKmsDisplay("/dev/dri/card9")->open({});
  EXPECT_EQ(opened.error().code, ErrorCode::NotFound);
  EXPECT_EQ(makeKmsDisplay("/dev/null")->open({}).error().code, ErrorCode::Unsupported);
}

TEST_F(KmsDisplay, IsListedWithItsModesAndWhatItTakes) {
  const auto screens = lookAtKmsScreens();
  ASSERT_GE(screens.size(), 2u);
  EXPECT_EQ(screens[0].card, screen_->card());
  EXPECT_TRUE(screens[0].there);
  EXPECT_THAT(screens[0].state, testing::MatchesRegex("Virtual-1: 1280x800 at [67][0-9][.][0-9]+ Hz, [0-9]+ modes; "
                                                      "no 3D signals"));
  screen_->plug(false);
  EXPECT_THAT(lookAtKmsScreens()[0].state, testing::StartsWith("Virtual-1: no screen is connected"));
}

// Frames are shown in consecutive refreshes. The kernel's events are in virtual time and do not depend on the load of
// this machine.
TEST_F(PacedKmsDisplay, FramesAreShownWithTheRefresh) {
  open({640, 480});
  const Duration period = display_->capabilities().refresh_period;
  EXPECT_NEAR(toSeconds(period), 1 / 59.94, 1e-4);
  MonotonicClock clock;
  MonotonicTime last;
  int next_refresh = 0;
  constexpr int kFrames = 30;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_TRUE(display_->beginFrame());
    const auto shown = display_->present();
    ASSERT_TRUE(shown) << shown.error().message;
    const MonotonicTime now = clock.now();
    EXPECT_GE(*shown, Duration(0));
    EXPECT_LE(*shown, period);
    const MonotonicTime on_screen = now + *shown;  // a refresh
    if (i > 2) {
      const double periods = toSeconds(on_screen - last) / toSeconds(period);
      EXPECT_NEAR(periods, std::round(periods), 0.1) << "frame " << i;
      EXPECT_GT(periods, 0.5) << "two frames in one refresh";
      next_refresh += std::lround(periods) == 1 ? 1 : 0;
    }
    last = on_screen;
  }
  EXPECT_GT(next_refresh, kFrames / 2) << "it keeps up with the screen";
}

TEST_F(PacedKmsDisplay, OpensAgainTenTimes) {
  for (int round = 0; round < 10; ++round) {
    open({640, 480});
    show(kRed, kBlue);
    show(kBlue, kRed);
    display_->close();
  }
}

TEST_F(PacedKmsDisplay, ClosedInTheMiddleOfAFlipItLeavesNothingBehind) {
  for (int round = 0; round < 5; ++round) {
    open({640, 480});
    for (int i = 0; i < 3; ++i) show(kRed, kBlue);
    ASSERT_TRUE(display_->beginFrame());
    display_->close();
  }
}

// The guest's vkms is a television of 1280 x 1470: two pictures of 720 rows with 30 between them.
TEST_F(PacedKmsDisplay, FramePackingIsSentToAScreenThatTakesIt) {
  open({1280, 720, StereoSignal::FramePacking});
  EXPECT_TRUE(display_->capabilities().stereo.frame_packing);
  const auto surface = display_->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->stereo, StereoSignal::FramePacking);
  EXPECT_EQ(surface->width, 1280);
  EXPECT_EQ(surface->height, 1470);
  EXPECT_EQ(surface->eye_gap_rows, 30);
  const auto shown = display_->present();
  ASSERT_TRUE(shown) << shown.error().message << " " << shown.error().os_error;
  show(kRed, kBlue);
  show(kBlue, kRed);

  const UniqueFd card(::open(screen_->card().c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_EQ(drmSetClientCap(card.get(), DRM_CLIENT_CAP_STEREO_3D, 1), 0);
  drmModeRes* all = drmModeGetResources(card.get());
  drmModeCrtc* crtc = drmModeGetCrtc(card.get(), all->crtcs[0]);
  EXPECT_EQ(crtc->mode.vdisplay, 720);
  EXPECT_EQ(crtc->mode.flags & DRM_MODE_FLAG_3D_MASK, unsigned{DRM_MODE_FLAG_3D_FRAME_PACKING});
  drmModeFreeCrtc(crtc);
  drmModeFreeResources(all);
  EXPECT_THAT(lookAtKmsScreens().back().state, testing::HasSubstr("another program"));
  display_->close();
  EXPECT_THAT(lookAtKmsScreens().back().state, testing::HasSubstr("3D signals: frame packing"));
}

TEST_F(PacedKmsDisplay, SideBySideThatTheScreenIsNotToldOfIsShownAllTheSame) {
  open({640, 480, StereoSignal::SideBySideHalf});
  const auto surface = display_->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->stereo, StereoSignal::None);
  EXPECT_EQ(surface->width, 640);
}

TEST_F(KmsDisplay, FramePackingThatTheScreenDoesNotTakeIsRefused) {
  const auto opened = display_->open({1920, 1080, StereoSignal::FramePacking});
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("does not support frame packing"));
}

}  // namespace
}  // namespace relievo::test
