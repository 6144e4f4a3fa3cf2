// SPDX-License-Identifier: Apache-2.0
// The results of a player's run as numbers; as JSON for programs and as a few lines for people.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/player/film/live_times.h"
#include "app/player/film/seek_times.h"
#include "app/player/sound/sound.h"
#include "app/player/state_table.h"
#include "app/player/touch/haptic_session.h"
#include "app/player/views/relief_maker.h"
#include "app/scene/display_volume.h"

namespace relievo {

// A fault, or something missing, and what the player did about it.
struct FaultEntry {
  double time_s = 0;  // since the start; of the first one if it repeated
  std::string what;
  std::string done;
  std::uint64_t count = 1;

  [[nodiscard]] std::string sentence() const { return what + "; " + done; }
};

// The second finger's part of the report, if two devices were requested.
struct SecondFinger {
  HapticSummary haptic;
  std::optional<double> first_touch_ms;
};

struct PlayReport {
  std::string source, depth_source;
  std::vector<std::string> films;  // opened, in order; the first 1000
  std::set<std::string> opened;    // all files, with lists and depth, which no output may replace; not in the JSON
  FilmInfo film;                   // the last one
  PairCounters pairs;
  DisplayVolume volume;
  double wall_s = 0;
  double media_s = 0;  // shown, without pauses

  std::string display, display_mode;
  std::string stereo;
  int surface_width = 0, surface_height = 0;
  bool imported = false;      // whether the last picture's colour was taken from dma-bufs
  std::size_t triangles = 0;  // of the relief, in the last picture
  double picture_error_px = 0;
  double mesh_ms = 0, draw_ms = 0;  // a picture's, smoothed
  std::uint64_t frames_shown = 0, frames_dropped = 0;
  double drawn_size = 1;  // RenderStatistics::size
  std::optional<double> first_frame_ms;
  std::optional<double> first_touch_ms;  // the first tick on the film's surface
  std::optional<LiveLatency> live;
  ReliefSummary reliefs;  // made from films of two views

  HapticSummary haptic;  // of the first finger
  std::optional<SecondFinger> second_finger;
  SoundSummary sound;
  std::vector<PlayerState> states;
  std::vector<FaultEntry> faults;
  std::vector<SeekEntry> seeks;

  // A repetition of the last fault is only counted. True for the first fault of its name, which is printed.
  bool addFault(double time_s, std::string what, std::string done);
};

// The force on each finger, N; 0 without one.
using FingerForces = std::array<double, 2>;

[[nodiscard]] std::string toJson(const PlayReport& report);
// A few lines for a viewer; `verbose`: for a developer.
[[nodiscard]] std::string toText(const PlayReport& report, bool verbose = false);
// The report's counters and times alone, as JSON in one line, while the film plays.
[[nodiscard]] std::string metricsOf(const PlayReport& report);

}  // namespace relievo
