// SPDX-License-Identifier: Apache-2.0
// Measures a clip's depth and chooses the least smoothing that it needs: the plan.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "app/depth_window/felt_scale.h"
#include "app/depth_window/look_ahead.h"
#include "app/depth_window/surface_window.h"
#include "app/depth_window/waves.h"

namespace relievo {

// Reads up to two hundred thousand samples of each of a few frames; not for the real-time thread.
struct ClipMeasure {
  int frames = 0;
  double quantum_mm = 0;      // smallest step between depth values, in mm
  double noise_mm = 0;        // standard deviation between samples, beyond what the quantum explains
  double speed_mm_per_s = 0;  // of the fastest 5 % of the readable places
  double flicker_mm = 0;      // standard deviation of what whole frames do at random (flickerMm)
  double edges = 0;           // share of the places beside a step of more than 3 mm
  double ripples = 0;         // share of the steps between samples that are ripples (ripplesOf)
  Waves waves_mm{};           // relief that is fine for a wide smoothing (wavesOf)
  double sample_mm = 0;       // pitch of the samples
  double period_s = 0;        // of the frames
  bool still = false;         // no sampled place changes
  bool whole_rows = false;    // blocks are read in whole rows (HeightField::blockOf)
};
// Frames in ascending order, all of one size. All zero without frames.
[[nodiscard]] ClipMeasure measureClip(std::span<const TimedSurface> frames);
// Whether a codec has changed the depth.
[[nodiscard]] bool isCoded(const ClipMeasure& measure);

struct TouchPlan {
  ClipMeasure measure;
  FeltScale scale;
  double error = 0;    // expected error of the force, as a share of it
  std::string reason;  // one line
};

// The smoothing with the least expected error for a finger 5 mm deep, and the law of time that suits the noise; of the
// laws that need no frames beyond the look-ahead.
[[nodiscard]] TouchPlan planTouch(const ClipMeasure& measure, const LookAhead& ahead = {});
// The plan for a film that begins with these frames, in ascending order and with shots marked. It is measured on the
// first four frames, which a player has when it begins. Player, probe and laboratory all use this function.
inline constexpr std::size_t kPlanFrames = 4;
[[nodiscard]] TouchPlan planFilm(std::span<const TimedSurface> first_frames, const LookAhead& ahead = {});
// "levels of 0.28 and 1.98 mm, 3.96 where straight, linear and fitted in time"
[[nodiscard]] std::string describe(const FeltScale& scale);

}  // namespace relievo
