// SPDX-License-Identifier: Apache-2.0
// What the player writes on the screen, and for how long: pure.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/player/state_table.h"
#include "app/render/relief/stereo.h"
#include "platform/clock.h"

namespace relievo {

// What there is to tell of a moment.
struct ScreenFacts {
  std::string title;
  double position_s = 0, duration_s = 0;  // duration 0: unknown
  PlayerState state = PlayerState::Boot;
  bool held = false;
  double rate = 1;
  bool loop = false;
  std::size_t film = 1, films = 1;  // the how manieth of the list
  StereoSettings stereo;
  bool has_depth = false;
  std::string haptic;  // the device's name; empty: none
  bool contact = false;
};

// "1:02:05", "0:07".
[[nodiscard]] std::string clockTime(double seconds);

// Shown for some seconds after the viewer has done something, when something goes wrong, and at the start; as long as
// the film stands; and on wish until it is wished away.
class ScreenText {
 public:
  void wake(MonotonicTime now) noexcept { awake_until_ = now + kAwake; }
  void toggle() noexcept { wished_ = !wished_; }
  // Why something is off: it is told once with the rest.
  void tell(std::string why, MonotonicTime now);

  [[nodiscard]] bool shown(const ScreenFacts& facts, MonotonicTime now) const noexcept;
  // Nothing while it is not shown. It changes at most once a second by itself.
  [[nodiscard]] std::vector<std::string> lines(const ScreenFacts& facts, MonotonicTime now) const;

 private:
  static constexpr Duration kAwake = std::chrono::seconds(4);

  bool wished_ = false;
  MonotonicTime awake_until_;
  std::string why_;
  MonotonicTime told_until_;
};

}  // namespace relievo
