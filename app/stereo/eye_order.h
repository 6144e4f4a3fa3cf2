// SPDX-License-Identifier: Apache-2.0
// Determines which of two views is the right eye's.
#pragma once

#include <cstdint>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// Where the disparity rises from left to right, there are points between both sides that only the left eye sees. They
// belong to the far side: its left one if the eyes are in order, its right one if they are swapped. Their colours show
// which. The same holds, mirrored, in the right view.
struct EyeVotes {
  std::uint64_t in_order = 0, swapped = 0;  // pixels

  EyeVotes& operator+=(const EyeVotes& other) noexcept;
  // Both may be false if there are too few votes. Few votes suffice if hardly any is against them.
  [[nodiscard]] bool areSwapped() const noexcept { return tell(swapped, in_order); }
  [[nodiscard]] bool areInOrder() const noexcept { return tell(in_order, swapped); }

 private:
  [[nodiscard]] static bool tell(std::uint64_t votes, std::uint64_t others) noexcept;
};

// `map`: of the left view, matched, with `seen` set; `from_right` is -infinity where nothing was found.
[[nodiscard]] EyeVotes voteOnEyes(const DisparityMap& map, const ViewPicture& left, const ViewPicture& right);

}  // namespace relievo
