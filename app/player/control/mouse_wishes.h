// SPDX-License-Identifier: Apache-2.0
// What the viewer has done with the mouse since the player last checked. Pure.
#pragma once

#include <optional>
#include <utility>

#include "app/player/control/command.h"

namespace relievo {

// Mouse events arrive in the middle of a round, between two pictures; the player carries them out at its own place in
// the round.
class MouseWishes {
 public:
  // Notches of the wheel over the film.
  void turn(int notches) noexcept { notches_ += notches; }
  // A place on the bar was pressed, as a share of the film; the last one counts.
  void drag(double share) noexcept { dragged_to_ = share; }
  // Whether the button is down. True if it has just been pressed.
  [[nodiscard]] bool press(bool pressed) noexcept {
    const bool was_pressed = std::exchange(pressed_, pressed);
    return pressed && !was_pressed;
  }
  // A button of the bar, the selected film of the list, or the words below the list were clicked.
  void click(PlayerVerb verb) noexcept { clicked_ = verb; }

  // Each is returned once.
  [[nodiscard]] int takeNotches() noexcept { return std::exchange(notches_, 0); }
  [[nodiscard]] std::optional<double> takeDrag() noexcept { return std::exchange(dragged_to_, std::nullopt); }
  [[nodiscard]] std::optional<PlayerVerb> takeClick() noexcept { return std::exchange(clicked_, std::nullopt); }

 private:
  int notches_ = 0;
  std::optional<double> dragged_to_;
  bool pressed_ = false;
  std::optional<PlayerVerb> clicked_;
};

}  // namespace relievo
