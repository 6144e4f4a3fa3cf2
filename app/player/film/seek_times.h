// SPDX-License-Identifier: Apache-2.0
// Measures how long after each of the viewer's seeks the first picture and the first touch come. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/media/media_time.h"
#include "platform/clock.h"

namespace relievo {

// A seek, the first picture after it, and the depth frame of the first touch after that picture. Eye and hand agree if
// both times are equal. Nullopt if there was none.
struct SeekEntry {
  double target_s = 0;
  std::optional<double> picture_s;
  std::optional<double> surface_s;
  std::optional<double> picture_ms, surface_ms;  // from the key to the picture, and to the touch
};

class SeekTimes {
 public:
  static constexpr std::size_t kMost = 1000;  // the first ones, of a run that lasts for months

  // A seek to `target` begins. A seek that the viewer did not ask for, or one too many, ends a running measurement and
  // gets no entry.
  void asked(MediaTime target, bool by_viewer, MonotonicTime now);
  // The picture of time `picture` was on the screen at `now`. Ticks before `touch_from` still felt the old surface.
  void shown(MediaTime picture, MonotonicTime now, MonotonicTime touch_from);
  // The device ticked at `tick`, on the depth frame of time `frame` (nullopt: on none).
  void felt(MonotonicTime tick, std::optional<MediaTime> frame);
  // Ends a running measurement: another film begins.
  void forget() noexcept { waits_ = Waits::Nothing; }

  // Whether `felt` at this time would be counted.
  [[nodiscard]] bool waitsForTouch(MonotonicTime tick) const noexcept {
    return waits_ == Waits::Touch && tick > touch_from_;
  }
  [[nodiscard]] const std::vector<SeekEntry>& entries() const noexcept { return entries_; }

 private:
  enum class Waits : std::uint8_t { Nothing, Picture, Touch };

  std::vector<SeekEntry> entries_;
  Waits waits_ = Waits::Nothing;
  MonotonicTime asked_;
  MonotonicTime touch_from_;
};

}  // namespace relievo
