// SPDX-License-Identifier: Apache-2.0
// What was read of a film of the recorded scene, compared with the scene's distances.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo::test {

// What is read may differ from `scale` times the true distance by so many mm and by this share of it.
struct Tolerance {
  double mm = 0, share = 0;
};

// Every sample has the distance of the scene, and its holes are holes.
inline void expectScene(const OpenedFilm& film, double scale, const Tolerance& tolerance) {
  ASSERT_FALSE(film.pair.depth.empty());
  for (int r = 0; r < kSceneRows; ++r) {
    for (int c = 0; c < kSceneCols; ++c) {
      const double mm = scale * distanceMm(c, r), read = film.distanceAt(c, r);
      ASSERT_EQ(std::isnan(read), mm == 0) << c << ", " << r;
      if (mm == 0) continue;
      ASSERT_NEAR(read, mm, tolerance.mm + tolerance.share * mm) << c << ", " << r;
    }
  }
}

}  // namespace relievo::test
