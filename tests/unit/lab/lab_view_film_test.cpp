// SPDX-License-Identifier: Apache-2.0
// Films of two views for measurements: whether the right view lies where the disparity says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/lab/film/view_film.h"
#include "app/scene/height_field.h"

namespace relievo {
namespace {

int lumaAt(const Frame& frame, int c, int r) {
  return frame.planes[0].data[r * frame.planes[0].stride_bytes + c];
}

// The disparity around a place: by how many pixels its 25 x 9 neighbours lie further left in the right view, by least
// squares.
double foundAt(const ViewFilm& film, int c, int r) {
  double least = std::numeric_limits<double>::max();
  int found = 0;
  for (int d = -20; d <= 20; ++d) {
    double sum = 0;
    for (int y = r - 4; y <= r + 4; ++y) {
      for (int x = c - 12; x <= c + 12; ++x) {
        sum += std::pow(lumaAt(film.left[0], x, y) - lumaAt(film.right[0], x - d, y), 2);
      }
    }
    if (sum >= least) continue;
    least = sum;
    found = d;
  }
  return found;
}

TEST(LabViewFilm, ThePaintHasMovedByTheHeightsDisparity) {
  constexpr int kCols = 320, kRows = 216;
  const auto surface = makeTrueSurface("plane");
  for (const bool rich : {true, false}) {
    const ViewFilmFormat format{.cols = kCols, .reach = 0.05, .rich = rich, .crf = {}};
    const auto film = ViewFilm::make(*surface, format, 1);
    ASSERT_TRUE(film.has_value());
    ASSERT_EQ(film->left[0].height, kRows);
    const GridMapping grid(TrueSurface::kVolume, kCols, kRows);
    for (const auto& [c, r] : {std::pair{80, 60}, {160, 108}, {250, 160}}) {
      // A third of the reach lies behind the screen, and the reach is of 40 mm.
      const double share = surface->height(grid.x(c), grid.y(r), 0) / 40;
      EXPECT_NEAR(foundAt(*film, c, r), kCols * 0.05 * (share - 1.0 / 3), 1) << c << " " << r << (rich ? "" : " weak");
    }
  }
}

TEST(LabViewFilm, DisparitiesBecomeTheHeightsTheyWereMadeOf) {
  const ViewFilmFormat format{.cols = 320, .reach = 0.05};
  EXPECT_NEAR(format.disparityOf(0), -0.05 / 3, 1e-12);
  const Frame depth = depthOfDisparity(format, 2, 1, MediaTime{}, [&](std::size_t i) {
    return i == 0 ? 0.0 : 1.0;  // in the screen, and nearer than near
  });
  const auto field = HeightField::make(depth, {.bits = 16}, TrueSurface::kVolume);
  ASSERT_TRUE(field.has_value());
  EXPECT_NEAR(field->heightMm(0, 0), 40.0 / 3, 0.001);
  EXPECT_NEAR(field->heightMm(1, 0), 40, 0.001);
}

// A codec's errors and a grain that changes.
TEST(LabViewFilm, ACoarseCodecChangesThePictures) {
  const auto surface = makeTrueSurface("plane");
  const auto as_made = ViewFilm::make(*surface, {.cols = 160, .crf = {}}, 2);
  const auto coarse = ViewFilm::make(*surface, {.cols = 160, .crf = 40}, 2);
  ASSERT_TRUE(as_made && coarse);
  double grain = 0, off = 0;
  for (int r = 0; r < as_made->left[0].height; ++r) {
    for (int c = 0; c < 160; ++c) {
      grain = std::max<double>(grain, std::abs(lumaAt(as_made->left[0], c, r) - lumaAt(as_made->left[1], c, r)));
      off += std::abs(lumaAt(as_made->left[0], c, r) - lumaAt(coarse->left[0], c, r)) / (160.0 * 108);
    }
  }
  EXPECT_GT(grain, 2);
  EXPECT_LT(grain, 8);
  EXPECT_GT(off, 3);
}

}  // namespace
}  // namespace relievo
