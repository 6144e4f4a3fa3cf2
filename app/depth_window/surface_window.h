// SPDX-License-Identifier: Apache-2.0
// The few depth frames around the present moment that the haptic side may look at, with the clock to place them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "app/scene/height_field.h"
#include "app/scene/material_map.h"
#include "hal/media/media_clock.h"
#include "hal/media/media_time.h"

namespace relievo {

struct TimedSurface {
  HeightField field;
  MediaTime time;
  std::shared_ptr<const void> owner;  // keeps the samples alive; only the window's writer touches it
  std::uint32_t shot = 0;             // frames of one shot continue each other; where it changes there is a cut
  bool repeats = false;               // every sample is as in the frame before it, which may be read in its place
  std::shared_ptr<const MaterialMap> material;  // of its places; null: the whole film's holds
};

// Frames in ascending order of time, all of one size. The writer puts in the frames from two before the present one
// to four after it, as far as there are that many. The widest surface in time reads three after the present one; a
// reader finds its place by time, so that the fourth lets the writer come late by a frame. More would make a live film
// wait longer before it begins.
struct SurfaceWindow {
  static constexpr int kBefore = 2, kAhead = 4;
  static constexpr int kCapacity = 8;  // a reader has one bit for each frame in a byte
  static_assert(kBefore + 1 + kAhead <= kCapacity);
  std::array<TimedSurface, kCapacity> frames{};
  int count = 0;
  std::uint32_t epoch = 0;  // changes where the film is not continuous: opened, sought, looped
  ClockSample clock;        // rate 0: paused; the surface stands still and stays touchable
  Duration carried{0};      // how far the surface is carried forward in time
  bool ended = false;       // no frame follows the last: holding it is right, not a lost feed
};

}  // namespace relievo
