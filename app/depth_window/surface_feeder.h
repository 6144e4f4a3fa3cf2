// SPDX-License-Identifier: Apache-2.0
// The player's depth window: puts the depth of the pictures on the screen and after it into the frames that are felt.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "app/depth_window/surface_window.h"
#include "app/depth_window/window_frames.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/media/frame.h"
#include "hal/media/media_clock.h"
#include "platform/error.h"

namespace relievo {

// A depth frame comes with every colour frame that it belongs to; the window holds it once, at its own time. A
// HeightField is made once per depth frame.
class SurfaceFeeder {
 public:
  // The pictures of the film's material track at the times of the depth: empty frames where there is none.
  struct Materials {
    Frame present;
    std::span<const Frame> ahead;
  };

  // What depth means in this film, and the box that it fills. Before the first update.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume) noexcept {
    calibration_ = calibration;
    volume_ = volume;
  }

  // Call where the film is not continuous: after opening, seeking, looping. A new epoch begins.
  void beginEpoch() noexcept;

  // `present` is the depth of the picture on the screen, `ahead` that of those after it, an empty frame where there is
  // none; `last`: nothing follows `ahead`. Without a present depth the window is empty, one of another size begins an
  // epoch. True when the frames or the clock are not those of the last call: then `fill` and publish. Fails for a depth
  // format that cannot be felt; the window is then empty.
  // `felt`: the moment that is felt, where it lies before the present picture, as in a live film.
  [[nodiscard]] Result<bool> update(const Frame& present, std::span<const Frame> ahead, bool last,
                                    const ClockSample& clock, const Materials& materials = {},
                                    std::optional<MediaTime> felt = {});
  // Adds the newest depth of a live film before its picture is the present one. True if it was added: then publish.
  [[nodiscard]] bool hear(const Frame& depth, const Frame& material = {});
  // How far the surface is carried forward in time. Before the first update.
  void setCarried(Duration carried) noexcept { carried_ = carried; }
  // The whole window; what it held before is released.
  void fill(SurfaceWindow& window) const;

  // The time of the frame that the surface at `now` begins from; nullopt if the window is empty.
  [[nodiscard]] std::optional<MediaTime> frameAt(MediaTime now) const noexcept;

 private:
  // False if some frames of `ahead` did not fit.
  bool addAhead(std::span<const Frame> ahead, std::span<const Frame> materials);
  // False if `depth` has another size than the frames in the window.
  [[nodiscard]] Result<bool> add(const Frame& depth, const Frame& material);

  DepthCalibration calibration_;
  DisplayVolume volume_;
  WindowFrames frames_;
  std::uint32_t epoch_ = 0;
  ClockSample clock_;
  bool ended_ = false;
  Duration carried_{0};
};

}  // namespace relievo
