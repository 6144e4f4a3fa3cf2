// SPDX-License-Identifier: Apache-2.0
// How long the surface of a live film waits for frames, from the stream's period and its frames' delay. Pure.
#pragma once

#include <array>
#include <cstddef>

#include "app/depth_window/parts.h"
#include "app/depth_window/surface_window.h"
#include "hal/media/media_time.h"
#include "platform/clock.h"

namespace relievo {

// The frames beyond the present one that the surface waits for, and how far it is then carried forward in time. The
// defaults are those of a film that is not live: its frames are there long before they are shown.
struct LookAhead {
  int frames = SurfaceWindow::kAhead - 1;
  Duration carried{0};

  [[nodiscard]] bool operator==(const LookAhead&) const = default;
};

// The felt surface of a live film should be no older than this.
inline constexpr Duration kLiveAge = std::chrono::milliseconds(50);
// People do not notice touch that comes up to 50 ms after the picture, nor up to 15 ms before it (Di Luca et al., World
// Haptics 2019).
inline constexpr Duration kMostBehind = std::chrono::milliseconds(50), kMostBefore = std::chrono::milliseconds(15);

// For frames that are `period` apart and arrive up to `late` after they were taken: waits for as many frames as
// kLiveAge leaves room for. If there is no room for one frame, the surface waits for one all the same and is
// extrapolated by the missing time: by no more than a period, and not at all where an extrapolated surface would be
// less exact than an old one (kNodHz).
[[nodiscard]] LookAhead lookAheadFor(Duration period, Duration late) noexcept;
// Returns `law` if `frames` of look-ahead suffice for it, else the smoothest law for which they do.
[[nodiscard]] TimeLaw lawWithin(TimeLaw law, int frames) noexcept;

// The clock rate that makes up for `behind` in about half a second. It differs from 1 by at most 5 %, which a finger
// cannot tell from the scene's own speed.
[[nodiscard]] double rateToGain(Duration behind) noexcept;

// Records the delays of a live stream's last frames, and derives the age of the felt surface from them. One thread.
class Arrivals {
 public:
  static constexpr std::size_t kCounted = 128;  // about four seconds
  // Added to the measured age: the time from a frame's arrival to the tick that feels it.
  static constexpr Duration kMargin = std::chrono::milliseconds(2);

  // Adds the next frame, of media time `media`, which arrived `delay` after it was taken. In order of time.
  void add(MediaTime media, Duration delay) noexcept;
  // Forgets all but the last few: the first frames of a stream may have waited in its buffer.
  void forgetAllBut(std::size_t last) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  // True once the reader has had to wait for the last frame: no frame is left in the stream's buffer.
  [[nodiscard]] bool keepsPace() const noexcept;
  // The delay within which 49 of 50 of the counted frames arrived, and the shortest delay; 0 without frames.
  [[nodiscard]] Duration late() const noexcept;
  [[nodiscard]] Duration soonest() const noexcept;
  // The delay of the newest frame.
  [[nodiscard]] Duration newest() const noexcept { return count_ == 0 ? Duration(0) : back(0).delay; }
  // The mean time between two frames; 0 with fewer than two.
  [[nodiscard]] Duration period() const noexcept;
  // The surface's age at which the frames that it waits for have arrived, 49 times of 50.
  [[nodiscard]] Duration age(const LookAhead& ahead) const noexcept;

 private:
  struct Frame {
    MediaTime media;
    Duration delay{0};
  };
  // Frame 0 is the newest.
  [[nodiscard]] const Frame& back(std::size_t i) const noexcept { return frames_[(count_ - 1 - i) % kCounted]; }
  [[nodiscard]] std::size_t held() const noexcept { return count_ < kCounted ? count_ : kCounted; }
  template <class Figure>
  [[nodiscard]] Duration usualMost(std::size_t figures, Figure&& figure) const noexcept;

  std::array<Frame, kCounted> frames_{};
  std::size_t count_ = 0;
};

}  // namespace relievo
