// SPDX-License-Identifier: Apache-2.0
// The places of a picture at which a clip is measured.
#pragma once

#include <algorithm>

#include "app/scene/height_field.h"

namespace relievo {

struct Lattice {
  static constexpr int kAcross = 64, kDown = 48;
  static constexpr int kPlaces = kAcross * kDown;

  // Calls visit(column, row) for the middle sample of each lattice field; its left and right neighbours are inside the
  // picture.
  template <class Visit>
  static void forPlaces(const HeightField& field, Visit&& visit) {
    if (field.cols() < 3 || field.rows() < 1) return;
    for (int r = 0; r < kDown; ++r) {
      for (int c = 0; c < kAcross; ++c) {
        visit(std::clamp((2 * c + 1) * field.cols() / (2 * kAcross), 1, field.cols() - 2),
              (2 * r + 1) * field.rows() / (2 * kDown));
      }
    }
  }
};

}  // namespace relievo
