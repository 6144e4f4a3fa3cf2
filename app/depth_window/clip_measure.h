// SPDX-License-Identifier: Apache-2.0
// What a clip's depth is like: its steps, noise, motion and fine relief.
#pragma once

#include <span>

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
  Swells swells_mm{};         // relief that is fine for the broad level (swellsOf)
  double sample_mm = 0;       // pitch of the samples
  double period_s = 0;        // of the frames
  bool still = false;         // no sampled place changes
  bool whole_rows = false;    // blocks are read in whole rows (HeightField::blockOf)
};
// Frames in ascending order, all of one size. All zero without frames.
[[nodiscard]] ClipMeasure measureClip(std::span<const TimedSurface> frames);
// The variance of a second difference of three samples (1, -2, 1) whose noise has variance 1: 1 + 4 + 1.
inline constexpr double kBendVariance = 6;
// What the noise leaves of the codes' steps, as dither does, in mm.
[[nodiscard]] double stepsUnderNoise(const ClipMeasure& measure);
// Whether a codec has changed the depth.
[[nodiscard]] bool isCoded(const ClipMeasure& measure);

}  // namespace relievo
