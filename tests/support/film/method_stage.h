// SPDX-License-Identifier: Apache-2.0
// A film in memory, and the default method that is given it tick by tick as the player would.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "app/depth_window/window_frames.h"
#include "app/haptics/method/relievo_method.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

class MethodStage : public testing::Test {
 protected:
  static constexpr DisplayVolume kVolume{160, 108, 40};
  static constexpr int kCols = 240, kRows = 162;
  static constexpr double kPeriod = 1.0 / 30, kTick = 0.001, kStiffness = 0.5;
  using Height = std::function<double(double x, double y, double t)>;

  void film(double seconds, const Height& height, double depth_mm = 40) {
    DisplayVolume volume = kVolume;
    volume.depth_mm = depth_mm;
    for (int k = 0; k * kPeriod <= seconds; ++k) {
      surfaces_.push_back(surfaceOf(makeReliefFrame(kCols, kRows, volume, mediaTime(k * kPeriod),
                                                    [&](double x, double y) { return height(x, y, k * kPeriod); }),
                                    volume));
    }
  }
  // Call before another film: removes the pictures and makes the method forget the finger.
  void clear() {
    surfaces_.clear();
    frames_.clear();
    ++window_.epoch;
    method_.reset();
  }
  Touch tick(double t, const glm::dvec3& hip) {
    const auto now = std::min(static_cast<std::ptrdiff_t>(t / kPeriod + 1e-6), std::ssize(surfaces_) - 1);
    const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(now - SurfaceWindow::kBefore, 0);
    const std::ptrdiff_t end = std::min<std::ptrdiff_t>(now + 1 + SurfaceWindow::kAhead, std::ssize(surfaces_));
    frames_.moveTo(surfaces_[static_cast<std::size_t>(now)].time);
    for (std::ptrdiff_t i = begin; i < end; ++i) frames_.add(surfaces_[static_cast<std::size_t>(i)]);
    frames_.fill(window_);
    const std::uint64_t before = method_.blocksRead();
    const Touch touch = method_.update(hip, window_, mediaTime(t));
    read_by_update_ = method_.blocksRead() - before;
    method_.upkeep(window_, mediaTime(t));
    return touch;
  }
  // One picture that stands still, for a method of its own.
  template <class Shape>
  [[nodiscard]] static SurfaceWindow picture(Shape&& height) {
    const Frame frame = makeReliefFrame(kCols, kRows, kVolume, {}, height);
    return makeWindow(std::span(&frame, 1), kVolume);
  }

  // Replaces the method; a method cannot be assigned.
  void make(const RelievoMethod::Config& config) {
    std::destroy_at(&method_);
    std::construct_at(&method_, config);
  }
  RelievoMethod method_{{.stiffness_n_per_mm = kStiffness}};
  std::vector<TimedSurface> surfaces_;
  WindowFrames frames_;
  SurfaceWindow window_;
  std::uint64_t read_by_update_ = 0;  // blocks, in the last tick
};

}  // namespace relievo::test
