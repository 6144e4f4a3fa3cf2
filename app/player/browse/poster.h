// SPDX-License-Identifier: Apache-2.0
// A small picture of a film.
#pragma once

#include "app/render/text/text_picture.h"
#include "hal/media/frame.h"

namespace relievo {

struct Poster {
  static constexpr int kMostCols = 192, kMostRows = 108;
  TextPicture picture;  // at most kMostCols x kMostRows, in the film's shape; empty: the film could not be read
  double length_s = 0;  // of the film; 0: unknown
  [[nodiscard]] bool empty() const noexcept { return picture.rgba.empty(); }
};

// Pure. An empty picture for an empty frame.
[[nodiscard]] TextPicture posterOf(const Frame& frame);

}  // namespace relievo
