// SPDX-License-Identifier: Apache-2.0
// The way from a pair to the screen: the display, the renderer on it, and what happens when the screen goes away.
#pragma once

#include <memory>
#include <optional>

#include "app/media/pair_reader.h"
#include "app/render/scene_renderer.h"
#include "app/render/stereo.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/display.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// A display without GLES draws nothing, at its own pace. A display that is lost is tried again once a second: film and
// touch go on meanwhile. Owner's thread only, the GL context's.
class Picture {
 public:
  enum class Shown : std::uint8_t {
    OnScreen,
    NoScreen,  // the screen is away
    Lost,      // it went away just now
    Back,      // it came back just now, and the picture is on it
  };

  Picture(Display& display, const DisplayConfig& config, const StereoSettings& stereo) noexcept
      : display_(display), config_(config), stereo_(stereo) {}
  ~Picture() { close(); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  [[nodiscard]] Result<void> open() { return display_.open(config_); }
  void close() noexcept;

  // Known when the film is open. `frame_budget`: how long drawing may take.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume, Duration frame_budget) noexcept;
  // What `show` shows from now on; a reference is kept, for a screen that comes back.
  void setPair(const FramePair& pair);
  // Fails for what no retry helps: no renderer, a pixel format that cannot be drawn.
  [[nodiscard]] Result<Shown> show(const std::optional<FingerMark>& finger, MonotonicTime now);
  // Between pictures, often. True when the last one should be drawn anew; Lost when the screen has gone just now, and
  // is tried again from `show`; Cancelled when the viewer has closed it.
  [[nodiscard]] Result<bool> attend(MonotonicTime now);
  // Mono, side by side, anaglyph, mono, ..
  void nextLayout() noexcept;

  [[nodiscard]] bool away() const noexcept { return display_.state() == Display::State::Closed; }
  [[nodiscard]] DisplayCapabilities capabilities() const noexcept { return display_.capabilities(); }
  [[nodiscard]] StereoLayout layout() const noexcept { return stereo_.layout; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] const RenderStatistics& statistics() const noexcept { return statistics_; }

 private:
  void lose(MonotonicTime now) noexcept;
  [[nodiscard]] Result<void> drawAndPresent(const std::optional<FingerMark>& finger);
  [[nodiscard]] Result<void> draw(const DisplaySurface& surface, const std::optional<FingerMark>& finger);

  Display& display_;
  DisplayConfig config_;
  StereoSettings stereo_;
  DepthCalibration calibration_;
  DisplayVolume volume_;
  Duration frame_budget_{0};
  std::unique_ptr<SceneRenderer> renderer_;
  FramePair pair_;
  bool uploaded_ = false;
  MonotonicTime next_retry_;
  int width_ = 0, height_ = 0;
  RenderStatistics statistics_;
};

}  // namespace relievo
