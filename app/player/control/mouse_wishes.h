// SPDX-License-Identifier: Apache-2.0
// What the viewer has done with the mouse since the player last checked. Pure.
#pragma once

#include <optional>
#include <utility>

namespace relievo {

// Mouse events arrive in the middle of a round, between two pictures; the player carries them out at its own place in
// the round.
class MouseWishes {
 public:
  // Notches of the wheel over the film.
  void turn(int notches) noexcept { notches_ += notches; }
  // A place on the bar was pressed, as a share of the film; the last one counts.
  void drag(double share) noexcept { dragged_to_ = share; }
  // Over the list of films: whether the button is down, and on a film. True if that film has just been clicked.
  [[nodiscard]] bool press(bool pressed, bool on_film) noexcept {
    const bool clicks = pressed && !pressed_ && on_film;
    pressed_ = pressed;
    chosen_ = chosen_ || clicks;
    return clicks;
  }
  // Call when the list is no longer shown.
  void leaveList() noexcept { pressed_ = chosen_ = false; }

  // Each is returned once.
  [[nodiscard]] int takeNotches() noexcept { return std::exchange(notches_, 0); }
  [[nodiscard]] std::optional<double> takeDrag() noexcept { return std::exchange(dragged_to_, std::nullopt); }
  [[nodiscard]] bool takeChoice() noexcept { return std::exchange(chosen_, false); }

 private:
  int notches_ = 0;
  std::optional<double> dragged_to_;
  bool pressed_ = false;
  bool chosen_ = false;
};

}  // namespace relievo
