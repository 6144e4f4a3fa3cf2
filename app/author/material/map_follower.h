// SPDX-License-Identifier: Apache-2.0
// Where each place of a film's picture was in an earlier one: a map painted over that one stays on its things.
#pragma once

#include <optional>
#include <vector>

#include "app/motion/motion_field.h"

namespace relievo {

// Follows from picture to picture, so a small error grows with their number. What comes into the picture from outside,
// from behind a thing or after a cut, was nowhere.
class MapFollower {
 public:
  // A place of the picture that was painted over, in samples; x below 0: the place was not in it.
  using Place = Motion;

  // The next picture; all of one size.
  void add(GrayPicture picture);
  // The last picture is the one that was painted over; before the first call it is the first one.
  void begin();
  // Nothing of the picture that was painted over is left.
  void cut();

  // Row by row.
  [[nodiscard]] const std::vector<Place>& places() const noexcept { return places_; }

 private:
  [[nodiscard]] Place placeBefore(double x, double y) const;

  std::optional<GrayPicture> last_;
  std::vector<Place> places_;
};

}  // namespace relievo
