// SPDX-License-Identifier: Apache-2.0
// The few depth frames around the present moment that the haptic side may look at, with the clock to place them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "app/scene/height_field.h"
#include "hal/media_clock.h"
#include "hal/media_time.h"

namespace relievo {

struct TimedSurface {
  HeightField field;
  MediaTime time;
  std::shared_ptr<const void> owner;  // keeps the samples alive; only the window's writer touches it
  std::uint32_t shot = 0;             // frames of one shot continue each other; where it changes there is a cut
  bool repeats = false;               // every sample is as in the frame before it, which may be read in its place
};

// Frames in ascending order of time, all of one size. The writer puts in the frames from two before the present one
// to five after it, as far as there are that many; a reader finds its place by time, so that a writer which comes
// late by a frame or two does no harm: three frames of look-ahead are left then.
struct SurfaceWindow {
  static constexpr int kBefore = 2, kAhead = 5;
  static constexpr int kCapacity = kBefore + 1 + kAhead;
  std::array<TimedSurface, kCapacity> frames{};
  int count = 0;
  std::uint32_t epoch = 0;  // changes where the film is not continuous: opened, sought, looped
  ClockSample clock;        // rate 0: paused; the surface stands still and stays touchable
  bool ended = false;       // no frame follows the last: holding it is right, not a lost feed
};

}  // namespace relievo
