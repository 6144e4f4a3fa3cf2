// SPDX-License-Identifier: Apache-2.0
// The full-screen display on the screens of a guest: QEMU's, which can be captured, and one that refreshes in virtual
// time like a real screen.
#pragma once

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <functional>
#include <memory>

#include "drivers/egl/egl.h"
#include "platform/clock.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/machine/guest_screen.h"

namespace relievo::test {

inline void fill(int x, int y, int width, int height, float red, float green, float blue) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, y, width, height);
  glClearColor(red, green, blue, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

class KmsDisplay : public testing::Test {
 protected:
  explicit KmsDisplay(const char* driver = "virtio") : screen_(GuestScreen::find(driver)) {}
  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << kNoGuest;
    display_ = makeKmsDisplay(screen_->card());
  }
  void open(const DisplayConfig& config) {
    const auto opened = display_->open(config);
    ASSERT_TRUE(opened) << opened.error().message << " " << opened.error().os_error;
  }
  // The left half in one colour, the right half in another.
  void show(const std::array<float, 3>& left, const std::array<float, 3>& right) {
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    const int half = surface->width / 2;
    fill(0, 0, half, surface->height, left[0], left[1], left[2]);
    fill(half, 0, half, surface->height, right[0], right[1], right[2]);
    const auto shown = display_->present();
    ASSERT_TRUE(shown) << shown.error().message << " " << shown.error().os_error;
    EXPECT_LE(*shown, display_->capabilities().refresh_period);
  }
  // QEMU updates its picture in host time, which the guest cannot observe.
  bool untilDump(const std::function<bool(const ScreenDump&)>& so) {
    MonotonicClock clock;
    for (int tries = 0; tries < 30; ++tries) {
      if (so(screen_->dump())) return true;
      clock.sleepUntil(clock.now() + std::chrono::milliseconds(50));
    }
    return false;
  }
  bool untilShows(int width, int height, int x, int y, const Rgb& color) {
    return untilDump(
        [&](const ScreenDump& dump) { return dump.width == width && dump.height == height && dump.at(x, y) == color; });
  }
  ErrorCode attendUntilRefused() {
    MonotonicClock clock;
    for (int i = 0; i < 300; ++i) {
      if (const auto attended = display_->attend(); !attended) return attended.error().code;
      clock.sleepUntil(clock.now() + std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "the loss was not noticed";
    return ErrorCode::InvalidState;
  }

  std::unique_ptr<GuestScreen> screen_;
  std::unique_ptr<Display> display_;
};

class PacedKmsDisplay : public KmsDisplay {
 protected:
  PacedKmsDisplay() : KmsDisplay("vkms") {}
};

inline constexpr std::array<float, 3> kRed{1, 0, 0}, kGreen{0, 1, 0}, kBlue{0, 0, 1};

}  // namespace relievo::test
