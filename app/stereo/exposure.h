// SPDX-License-Identifier: Apache-2.0
// Brings the right view to the brightness and colours of the left one.
#pragma once

#include <array>

#include "app/stereo/view_picture.h"

namespace relievo {

// Mean and spread of each component over many pictures of a view.
class ViewTone {
 public:
  void add(const ViewPicture& view);
  [[nodiscard]] double mean(std::size_t component) const;
  [[nodiscard]] double spread(std::size_t component) const;

 private:
  double count_ = 0;
  std::array<double, 3> sum_{}, squares_{};
};

// True for a view in which there is nothing to match, such as the black of a fade with its noise, or an even white. A
// faint bright view, such as fog, sky or snow, is none.
[[nodiscard]] bool isBlank(const ViewPicture& view);

// Maps a code of each component to gain * code + offset.
struct Exposure {
  std::array<double, 3> gain{1, 1, 1}, offset{};

  // True if the difference may be visible: more than 6 % of contrast, or 4 levels.
  [[nodiscard]] bool isNeeded() const;
};

[[nodiscard]] Exposure exposureBetween(const ViewTone& left, const ViewTone& right);
void balance(ViewPicture& right, const Exposure& exposure);

}  // namespace relievo
