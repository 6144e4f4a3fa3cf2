// SPDX-License-Identifier: Apache-2.0
// Only what a scene needs: measures what a clip's depth is like, and picks the parts of the method for it.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "app/depth_window/felt_scale.h"
#include "app/depth_window/surface_window.h"

namespace relievo {

// Not the real-time thread: reads some ten thousand samples of a few frames.
struct ClipMeasure {
  int frames = 0;
  double quantum_mm = 0;      // the smallest step between depth values, as they are used
  double noise_mm = 0;        // standard deviation from sample to sample, beyond what the quantum explains
  double speed_mm_per_s = 0;  // of the fastest twentieth of the places that can be read
  double edges = 0;           // share of the places next to a step of more than 3 mm
  double sample_mm = 0;       // pitch of the samples
  double period_s = 0;        // of the frames
  bool still = false;         // no sample of those looked at changes
};
// Frames in ascending order, all of one size. No frames, no reading: all zero.
[[nodiscard]] ClipMeasure measureClip(std::span<const TimedSurface> frames);

struct TouchPlan {
  ClipMeasure measure;
  FeltScale scale;
  double error = 0;    // of the force that is to be expected, as a share of it
  std::string reason;  // one line
};

// The share of a force that its error may take: a third of the 6 % that people can just feel (Jones 2000).
inline constexpr double kErrorWanted = 0.02;

// The narrowest smoothing with which the error stays under kErrorWanted for a finger that presses 5 mm deep, the widest
// where none does; and the law of time that noise or its absence asks for.
[[nodiscard]] TouchPlan planTouch(const ClipMeasure& measure);
// The plan for a film that begins with these frames, in ascending order and with their shots marked: it is measured on
// the first four, which are there when a player begins. Player, probe and laboratory all plan so.
inline constexpr std::size_t kPlanFrames = 4;
[[nodiscard]] TouchPlan planFilm(std::span<const TimedSurface> first_frames);
// "levels of 0.28 and 0.72 mm, linear and fitted in time"
[[nodiscard]] std::string describe(const FeltScale& scale);

}  // namespace relievo
