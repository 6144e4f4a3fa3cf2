// SPDX-License-Identifier: Apache-2.0
// Makes the window of depth frames around the present moment that the haptic side looks at.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/depth_window/surface_window.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/frame.h"
#include "hal/media_clock.h"
#include "platform/error.h"

namespace relievo {

// Depth frames come with every colour frame that they belong to; the window holds each once, at its own time: two from
// before the present one, the present one, and as many after it as there is room for, since the next window comes late
// when drawing takes long. A HeightField is made once per depth frame.
class SurfaceFeeder {
 public:
  // What depth means in this film, and the box that it fills. Before the first update.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume) noexcept {
    calibration_ = calibration;
    volume_ = volume;
  }

  // The film is not continuous here: opened, sought, looped. What follows is a new epoch.
  void beginEpoch() noexcept;

  // `present` is the depth of the picture on the screen, `ahead` that of those after it, an empty frame where there is
  // none; `last`: nothing follows `ahead`. Without a present depth the window is empty, one of another size begins an
  // epoch. True when the frames or the clock are not those of the last call: then `fill` and publish. Fails for a depth
  // format that cannot be felt; the window is then empty.
  [[nodiscard]] Result<bool> update(const Frame& present, std::span<const Frame> ahead, bool last,
                                    const ClockSample& clock);
  // The whole window; what it held before is released.
  void fill(SurfaceWindow& window) const;

  // The time of the frame that the surface at `now` begins from; nothing when the window is empty.
  [[nodiscard]] std::optional<MediaTime> frameAt(MediaTime now) const noexcept;

 private:
  static constexpr std::ptrdiff_t kAhead = SurfaceWindow::kAhead;
  // False when not all of `ahead` went in.
  bool appendAhead(MediaTime present, std::span<const Frame> ahead);
  // False when `depth` is of another size than the frames before it.
  [[nodiscard]] Result<bool> append(const Frame& depth);

  DepthCalibration calibration_;
  DisplayVolume volume_;
  std::vector<TimedSurface> frames_;  // ascending, at most SurfaceWindow::kCapacity
  ShotFinder shots_;
  std::uint32_t epoch_ = 0;
  ClockSample clock_;
  bool ended_ = false;
};

}  // namespace relievo
