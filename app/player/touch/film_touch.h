// SPDX-License-Identifier: Apache-2.0
// Touch for a film: feeds its surface to one finger or two, each with a device, and follows the devices.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "app/depth_window/look_ahead.h"
#include "app/depth_window/surface_feeder.h"
#include "app/player/film/depth_around.h"
#include "app/player/film/live_times.h"
#include "app/player/film/seek_times.h"
#include "app/player/journal.h"
#include "app/player/touch/finger.h"
#include "app/render/gl/scene_renderer.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/haptic_device.h"
#include "hal/media/media_clock.h"
#include "platform/clock.h"

namespace relievo {

// The player's thread only, but for `hear`. No call blocks on the device. Two fingers share the surface and nothing
// else: each has its own task, thread and limits, and feels what it would feel alone.
class FilmTouch {
 public:
  // The parts are borrowed. Without a first device there is no touch; without a second one, there is one finger.
  FilmTouch(const FingerParts& first, const FingerParts& second, Clock& clock, Ticking ticking, Journal& journal);

  // Starts opening and homing the devices.
  void begin();
  // Zero force first, in all fingers; then stops the threads and the devices.
  void stop() noexcept;
  // Sets the force to zero between two films; the devices stay homed.
  void rest() noexcept;

  // Sets how to read this film's depth, the display volume that it fills, and its material. `material_scale`: of the
  // film's material track; empty: it has none.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume, const Material& material,
                const Material& material_scale = {}) noexcept;
  [[nodiscard]] const DisplayVolume& volume() const noexcept { return volume_; }
  // How long a live film's surface waits for frames. Before `start`.
  void setLookAhead(const LookAhead& ahead) noexcept;
  // Call when the next depth does not continue the last one: after an opening or a seek.
  void beginEpoch() noexcept;
  // Publishes the surface to the haptic tasks.
  void feed(const DepthAround& depth, const ClockSample& clock);
  // Takes the newest depth of a live film without waiting until the player has drawn. Any thread.
  void hear(const Frame& depth, const Frame& material);

  // Notes losses and recoveries of devices. True if a device is ready and waits for `start`.
  [[nodiscard]] bool followDevice();
  [[nodiscard]] bool waiting() const noexcept;
  [[nodiscard]] bool running() const noexcept;
  // Starts the haptic task of each device that waits, on the surface fed last. The force fades in from zero.
  void start();
  // Records the ticks since the last call, reports the first one after a seek to `seeks`, those of a live film to
  // `live` (null: none), and notes faults.
  void drain(SeekTimes& seeks, LiveTimes* live);
  // Sleeps; without haptic threads, the ticks run meanwhile.
  void sleepUntil(MonotonicTime deadline) noexcept;

  // The position of each finger; nullopt without its device.
  [[nodiscard]] FingerMarks marks() noexcept;
  // One or two.
  [[nodiscard]] const std::deque<Finger>& fingers() const noexcept { return fingers_; }

 private:
  void publish() noexcept;

  std::mutex mutex_;  // guards surface and fingers against `hear`
  std::deque<Finger> fingers_;
  Clock& clock_;
  Journal& journal_;
  SurfaceFeeder surface_;
  DisplayVolume volume_;
  Material material_, material_scale_;
  LookAhead look_ahead_;
  bool missing_ = false;  // the present picture has no depth
  bool refused_ = false;  // the film's depth format cannot be felt; noted once
};

}  // namespace relievo
