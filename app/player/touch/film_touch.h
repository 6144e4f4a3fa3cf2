// SPDX-License-Identifier: Apache-2.0
// The film under the finger: the surface that the device gets, the device's coming and going, and what its ticks tell.
#pragma once

#include <optional>
#include <string>

#include "app/depth_window/surface_feeder.h"
#include "app/player/film/depth_around.h"
#include "app/player/film/seek_times.h"
#include "app/player/journal.h"
#include "app/player/touch/haptic_session.h"
#include "app/player/touch/recorder.h"
#include "app/render/gl/scene_renderer.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/haptic_device.h"
#include "hal/media_clock.h"
#include "platform/clock.h"

namespace relievo {

// The player's thread only. Nothing waits for the device.
class FilmTouch {
 public:
  // `device` and `recorder` are borrowed and may be null: without a device the film is followed, and nothing is felt.
  FilmTouch(HapticDevice* device, Recorder* recorder, Clock& clock, Ticking ticking, Journal& journal) noexcept
      : session_(device, clock, ticking), recorder_(recorder), journal_(journal) {}

  // Begins to open and home the device.
  void begin() { session_.begin(); }
  // Zero force first; then the thread and the device.
  void stop() noexcept { session_.stop(); }
  // Likewise zero force, between two films; the device stays homed.
  void rest() noexcept;

  // The first picture of a film is there: what its depth means, and the box that it fills.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume) noexcept;
  [[nodiscard]] const DisplayVolume& volume() const noexcept { return volume_; }
  // The next depth does not continue the last one.
  void beginEpoch() noexcept { surface_.beginEpoch(); }
  // The surface from now on.
  void feed(const DepthAround& depth, const ClockSample& clock);

  // Notes what became of the device since the last call. True: it is ready, and waits for `start`.
  [[nodiscard]] bool followDevice();
  [[nodiscard]] bool waiting() const noexcept { return session_.waiting(); }
  // On the surface fed last. The force begins at zero.
  void start();
  // The ticks since the last call: recorded, and counted for the seek that waits for one. Then the faults among them.
  void drain(SeekTimes& seeks);
  // The owner's wait: without a thread the ticks run in it.
  void sleepUntil(MonotonicTime deadline) noexcept { session_.sleepUntil(deadline); }

  // Where the finger is; nothing without a device.
  [[nodiscard]] std::optional<FingerMark> mark() noexcept;
  // The device that is felt now; empty: none.
  [[nodiscard]] std::string device() const { return session_.running() ? session_.capabilities().name : ""; }
  // The first tick with a device.
  [[nodiscard]] std::optional<MonotonicTime> firstTick() const noexcept { return first_tick_; }
  [[nodiscard]] HapticSummary summary() const { return session_.summary(); }

 private:
  HapticSession session_;
  Recorder* recorder_;
  Journal& journal_;
  SurfaceFeeder surface_;
  DisplayVolume volume_;
  bool was_lost_ = false;  // the device was there once and went away
  bool missing_ = false;   // the film has no depth at this time
  bool refused_ = false;   // its depth cannot be felt; noted once
  std::optional<MonotonicTime> first_tick_;
};

}  // namespace relievo
