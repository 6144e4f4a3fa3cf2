// SPDX-License-Identifier: Apache-2.0
// One finger on the film: its device, haptic session, recording, and entries in the journal.
#pragma once

#include <optional>
#include <string>

#include "app/player/film/live_times.h"
#include "app/player/film/seek_times.h"
#include "app/player/journal.h"
#include "app/player/touch/haptic_session.h"
#include "app/player/touch/recorder.h"
#include "app/render/gl/scene_renderer.h"

namespace relievo {

// Borrowed; either may be null.
struct FingerParts {
  HapticDevice* device = nullptr;
  Recorder* recorder = nullptr;
};

// The player's thread only. No call blocks on the device.
class Finger {
 public:
  // `who`: prefix of its entries in the journal, such as "second finger (blue): "; empty if there is one finger.
  Finger(const FingerParts& parts, std::string who, Clock& clock, Ticking ticking, Journal& journal)
      : session_(parts.device, clock, ticking), recorder_(parts.recorder), who_(std::move(who)), journal_(journal) {}

  [[nodiscard]] HapticSession& session() noexcept { return session_; }
  [[nodiscard]] const HapticSession& session() const noexcept { return session_; }

  // Notes the device's losses and recoveries.
  void follow();
  // Starts the haptic task if the device waits for it; see HapticSession::start.
  void start(const DisplayVolume& volume, const Material& material, const Material& material_scale,
             const LookAhead& ahead, const SurfaceFeeder& first);
  // Records the ticks since the last call and notes faults; see FilmTouch::drain.
  void drain(const SurfaceFeeder& surface, SeekTimes& seeks, LiveTimes* live);

  // Its position; nullopt without a device.
  [[nodiscard]] std::optional<FingerMark> mark() noexcept;
  // The name of the running device; empty if there is none.
  [[nodiscard]] std::string device() const { return session_.running() ? session_.capabilities().name : ""; }
  // The first tick with a device.
  [[nodiscard]] std::optional<MonotonicTime> firstTick() const noexcept { return first_tick_; }

 private:
  HapticSession session_;
  Recorder* recorder_;
  std::string who_;
  Journal& journal_;
  bool was_lost_ = false;  // the device has been lost at least once
  std::optional<MonotonicTime> first_tick_;
};

}  // namespace relievo
