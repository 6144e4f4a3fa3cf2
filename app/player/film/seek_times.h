// SPDX-License-Identifier: Apache-2.0
// Measures what the viewer's seeks led to: the first picture after each, and the first touch. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/media_time.h"
#include "platform/clock.h"

namespace relievo {

// The first picture after a seek, and the depth frame under the first touch after that picture. Eye and hand agree when
// the two are equal. Empty where there was none.
struct SeekEntry {
  double target_s = 0;
  std::optional<double> picture_s;
  std::optional<double> surface_s;
  std::optional<double> picture_ms, surface_ms;  // from the key to the picture, and to the touch
};

class SeekTimes {
 public:
  // A seek to `target` begins. One that the viewer did not ask for ends the measurement before it and gets no entry.
  void asked(MediaTime target, bool by_viewer, MonotonicTime now);
  // The picture at `picture` was on the screen at `now`. Touch counts from `touch_from` on: earlier ticks were on the
  // surface before.
  void shown(MediaTime picture, MonotonicTime now, MonotonicTime touch_from);
  // The device ticked at `tick`, on the depth frame of the time `frame`; nothing: on no frame.
  void felt(MonotonicTime tick, std::optional<MediaTime> frame);
  // Another film begins: nothing is waited for.
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
