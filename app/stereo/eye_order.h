// SPDX-License-Identifier: Apache-2.0
// Tells from two views which eye's is which.
#pragma once

#include <cstdint>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// Where the disparity rises from left to right, points lie between that the left eye alone sees. They belong to the far
// side: with the eyes in order that is their left one, with the eyes swapped their right one. The colours tell. In the
// right view, the same holds in a mirror.
struct EyeVotes {
  std::uint64_t in_order = 0, swapped = 0;  // pixels

  EyeVotes& operator+=(const EyeVotes& other) noexcept;
  // Both may be false: too little to tell. Few votes tell if hardly any is against them.
  [[nodiscard]] bool areSwapped() const noexcept { return tell(swapped, in_order); }
  [[nodiscard]] bool areInOrder() const noexcept { return tell(in_order, swapped); }

 private:
  [[nodiscard]] static bool tell(std::uint64_t votes, std::uint64_t others) noexcept;
};

// `map` as matched, `seen` told, of the left view; `from_right` -infinity where nothing was found.
[[nodiscard]] EyeVotes voteOnEyes(const DisparityMap& map, const ViewPicture& left, const ViewPicture& right);

}  // namespace relievo
