// SPDX-License-Identifier: Apache-2.0
// One eye's picture reduced for quick matching.
#pragma once

#include "app/stereo/view_picture.h"
#include "hal/media/frame.h"

namespace relievo {

struct ViewSize {
  int cols = 0, rows = 0;
  bool operator==(const ViewSize&) const = default;
};

// The size with `cols` columns, at most the picture's, in the shape in which it is shown: a view that was squeezed to
// half of its width has half as many rows.
[[nodiscard]] ViewSize reducedSize(const Frame& view, int cols) noexcept;

// The mean of up to 4 x 4 samples of each cell, read `lower` rows further down in the view, its last row repeated.
// Reuses the memory of `into`.
void readSmall(const Frame& view, ViewSize size, ViewPicture& into, int lower = 0);

// Reduces a picture that is as large or larger to the means of its cells.
void reduce(const ViewPicture& view, ViewSize size, ViewPicture& into);

// Left and right exchanged.
void mirror(ViewPicture& view);

}  // namespace relievo
