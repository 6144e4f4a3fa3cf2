// SPDX-License-Identifier: Apache-2.0
// Tracks each place of a film's picture back to an earlier picture, so that a map painted over that picture stays on
// the objects that it covers.
#pragma once

#include <optional>
#include <vector>

#include "app/motion/motion_field.h"

namespace relievo {

// Tracks from picture to picture, so a small error grows with their number. A place that has come into the picture from
// outside, from behind an object or after a cut has no earlier position.
class MapFollower {
 public:
  // A position in the painted picture, in samples; x below 0: the place was not in that picture.
  using Place = Motion;

  // The next picture; all of one size.
  void add(GrayPicture picture);
  // Makes the last added picture the painted one. Before the first call it is the first picture.
  void begin();
  // Call at a cut: no place of the painted picture is left.
  void cut();

  // Row by row.
  [[nodiscard]] const std::vector<Place>& places() const noexcept { return places_; }

 private:
  [[nodiscard]] Place placeBefore(double x, double y) const;

  std::optional<GrayPicture> last_;
  std::vector<Place> places_;
};

}  // namespace relievo
