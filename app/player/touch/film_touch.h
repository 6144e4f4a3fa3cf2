// SPDX-License-Identifier: Apache-2.0
// The touch of a film: feeds the surface to the haptic session, follows the device, and collects its ticks and faults.
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "app/depth_window/look_ahead.h"
#include "app/depth_window/surface_feeder.h"
#include "app/player/film/depth_around.h"
#include "app/player/film/live_times.h"
#include "app/player/film/seek_times.h"
#include "app/player/journal.h"
#include "app/player/touch/haptic_session.h"
#include "app/player/touch/recorder.h"
#include "app/render/gl/scene_renderer.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/haptic_device.h"
#include "hal/media/media_clock.h"
#include "platform/clock.h"

namespace relievo {

// The player's thread only, but for `hear`. No call blocks on the device.
class FilmTouch {
 public:
  // `device` and `recorder` are borrowed and may be null.
  FilmTouch(HapticDevice* device, Recorder* recorder, Clock& clock, Ticking ticking, Journal& journal) noexcept
      : session_(device, clock, ticking), recorder_(recorder), journal_(journal) {}

  // Starts opening and homing the device.
  void begin() { session_.begin(); }
  // Zero force first; then stops the thread and the device.
  void stop() noexcept;
  // Zero force between two films; the device stays homed.
  void rest() noexcept;

  // How to read this film's depth, the display volume that it fills, and what its surface feels like.
  // `material_scale`: of the film's material track; empty: it has none.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume, const Material& material,
                const Material& material_scale = {}) noexcept;
  [[nodiscard]] const DisplayVolume& volume() const noexcept { return volume_; }
  // How long a live film's surface waits for frames. Before `start`.
  void setLookAhead(const LookAhead& ahead) noexcept;
  // The next depth does not continue the last one: after an opening or a seek.
  void beginEpoch() noexcept;
  // Publishes the surface to the haptic task.
  void feed(const DepthAround& depth, const ClockSample& clock);
  // The newest depth of a live film, which need not wait until the player has drawn. Any thread.
  void hear(const Frame& depth, const Frame& material);

  // Notes the device's losses and recoveries. True if it is ready and waits for `start`.
  [[nodiscard]] bool followDevice();
  [[nodiscard]] bool waiting() const noexcept { return session_.waiting(); }
  // Starts the haptic task on the surface fed last. The force fades in from zero.
  void start();
  // Records the ticks since the last call, reports the first one after a seek to `seeks`, those of a live film to
  // `live` (null: none), and notes faults.
  void drain(SeekTimes& seeks, LiveTimes* live);
  // Sleeps; without a haptic thread, the ticks run meanwhile.
  void sleepUntil(MonotonicTime deadline) noexcept { session_.sleepUntil(deadline); }

  // Where the finger is; nullopt without a device.
  [[nodiscard]] std::optional<FingerMark> mark() noexcept;
  // The name of the running device; empty if there is none.
  [[nodiscard]] std::string device() const { return session_.running() ? session_.capabilities().name : ""; }
  // The first tick with a device.
  [[nodiscard]] std::optional<MonotonicTime> firstTick() const noexcept { return first_tick_; }
  [[nodiscard]] HapticSummary summary() const { return session_.summary(); }

 private:
  std::mutex mutex_;  // guards surface and session against `hear`
  HapticSession session_;
  Recorder* recorder_;
  Journal& journal_;
  SurfaceFeeder surface_;
  DisplayVolume volume_;
  Material material_, material_scale_;
  LookAhead look_ahead_;
  bool was_lost_ = false;  // the device has been lost at least once
  bool missing_ = false;   // the present picture has no depth
  bool refused_ = false;   // the film's depth format cannot be felt; noted once
  std::optional<MonotonicTime> first_tick_;
};

}  // namespace relievo
