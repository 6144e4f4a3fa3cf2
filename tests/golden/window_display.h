// SPDX-License-Identifier: Apache-2.0
// A window on an X server of the test's own, with its keys and its mouse.
#pragma once

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <thread>

#include "drivers/egl/egl.h"
#include "drivers/window/window_input.h"
#include "tests/support/machine/x_screen.h"

namespace relievo::test {

using Rgb = std::array<int, 3>;

inline void fill(int x, int y, int width, int height, float red, float green, float blue) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, y, width, height);
  glClearColor(red, green, blue, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

class WindowDisplay : public testing::Test {
 protected:
  static constexpr int kWidth = 200, kHeight = 120;

  static void SetUpTestSuite() { screen_ = XScreen::start(); }
  static void TearDownTestSuite() { screen_.reset(); }
  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << kNoXServer;
    const auto opened = display_->open({kWidth, kHeight});
    ASSERT_TRUE(opened) << opened.error().message;
    window_ = screen_->find("relievo");
    ASSERT_NE(window_, 0u);
    place_ = *screen_->place(window_);
    ASSERT_TRUE(until([&] { return redraw_; })) << "a window that has just come up is to be drawn";
    redraw_ = false;
  }

  // Each corner in its own colour, upper left first: red, green, blue, white.
  void drawCorners() {
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->framebuffer, 0u);
    const int w = surface->width / 2, h = surface->height / 2;
    fill(0, h, w, h, 1, 0, 0);
    fill(w, h, w, h, 0, 1, 0);
    fill(0, 0, w, h, 0, 0, 1);
    fill(w, 0, w, h, 1, 1, 1);
    const auto shown = display_->present();
    ASSERT_TRUE(shown);
    EXPECT_LE(*shown, display_->capabilities().refresh_period);
  }
  // Polls, because X and SDL exchange messages asynchronously.
  bool until(const std::function<bool()>& so) {
    for (int tries = 0; tries < 2000; ++tries) {
      if (so()) return true;
      const auto redraw = display_->attend();
      redraw_ = redraw_ || (redraw && *redraw);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  bool untilPixel(int x, int y, const Rgb& color) {
    return until([&] { return screen_->pixel(place_.x + x, place_.y + y) == color; });
  }
  KeyEvent nextKey() {
    std::optional<KeyEvent> key;
    EXPECT_TRUE(until([&] { return (key = input_->keys.tryPop()).has_value(); })) << "no key came";
    return key.value_or(KeyEvent{});
  }
  const WindowMouse& mouse() {
    input_->mouse.refresh();
    return input_->mouse.front();
  }

  bool pointsAt(double x_mm, double y_mm) {
    const auto& ray = mouse().ray;
    return ray && glm::distance(ray->screen_mm, glm::dvec2(x_mm, y_mm)) < 1e-9;
  }

  static inline std::unique_ptr<XScreen> screen_;
  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  std::shared_ptr<WindowInput> input_ = std::make_shared<WindowInput>();
  std::unique_ptr<Display> display_ = makeWindowDisplay(input_, clock_);
  unsigned long window_ = 0;
  XScreen::Place place_;
  bool redraw_ = false;
};
}  // namespace relievo::test
