// SPDX-License-Identifier: Apache-2.0
// How long the surface of a live film waits for frames: from the stream's period and how late its frames come. Pure.
#pragma once

#include <array>
#include <cstddef>

#include "app/depth_window/parts.h"
#include "app/depth_window/surface_window.h"
#include "hal/media/media_time.h"
#include "platform/clock.h"

namespace relievo {

// The frames beyond the present one that the surface waits for, and how far it is then carried forward in time. What a
// film that is no live one gets is the first line: its frames are there long before they are shown.
struct LookAhead {
  int frames = SurfaceWindow::kAhead - 1;
  Duration carried{0};

  [[nodiscard]] bool operator==(const LookAhead&) const = default;
};

// The felt surface of a live film should be no older than this, and it should lie no further from the picture:
// people do not notice touch that comes up to 50 ms after the picture, nor up to 15 ms before it (Di Luca et al., World
// Haptics 2019).
inline constexpr Duration kLiveAge = std::chrono::milliseconds(50);
inline constexpr Duration kMostBehind = std::chrono::milliseconds(50), kMostBefore = std::chrono::milliseconds(15);

// For frames a `period` apart that come up to `late` after they were taken: as many frames as kLiveAge leaves room for.
// Where there is no room for one, the surface waits for it all the same, and is carried forward by what is missing; by
// no more than a period, and not where that is further off than an old surface (kNodHz).
[[nodiscard]] LookAhead lookAheadFor(Duration period, Duration late) noexcept;
// The law if it needs no more frames than there are, else the smoothest that does.
[[nodiscard]] TimeLaw lawWithin(TimeLaw law, int frames) noexcept;

// The rate of a clock that is to gain `behind`: in about half a second, and by no more than 5 %, which no finger tells
// from the scene's own speed.
[[nodiscard]] double rateToGain(Duration behind) noexcept;

// When the frames of a live stream come, from their times: what the age of the surface has to be. One thread.
class Arrivals {
 public:
  static constexpr std::size_t kCounted = 128;  // about four seconds
  // What is added to the age that was measured: from the frame to the tick that feels it.
  static constexpr Duration kMargin = std::chrono::milliseconds(2);

  // The next frame, of the time `media`, was there `delay` after it was taken. In order of time.
  void add(MediaTime media, Duration delay) noexcept;
  // Keeps the last few, as of a stream whose first frames had been piled up.
  void forgetAllBut(std::size_t last) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  // The stream no longer hands out what it had piled up: its last frame had to be waited for.
  [[nodiscard]] bool keepsPace() const noexcept;
  // The delay that 49 of 50 of the counted frames stay within, and the shortest; 0 without frames.
  [[nodiscard]] Duration late() const noexcept;
  [[nodiscard]] Duration soonest() const noexcept;
  // The newest one's.
  [[nodiscard]] Duration newest() const noexcept { return count_ == 0 ? Duration(0) : back(0).delay; }
  // The mean step between them; 0 without two.
  [[nodiscard]] Duration period() const noexcept;
  // The age at which the surface has the frames that it waits for, 49 times of 50.
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
