// SPDX-License-Identifier: Apache-2.0
// The drawing of silhouettes, vertex by vertex, and the filling of holes.
#include "app/render/relief/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <tuple>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/relief_triangles.h"
#include "app/render/relief/stereo.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160.0, 80.0, 40.0};
constexpr int kCols = 65, kRows = 33;  // two tiles of 32 cells and one: every sample is a vertex, once
constexpr double kHole = -1;
constexpr int kEdge = 33;  // the first near column

using HeightMm = std::function<double(int c, int r)>;

Frame frameOf(const HeightMm& height, int cols = kCols, int rows = kRows) {
  return test::makeGrayFrame(cols, rows, 16, MediaTime{}, [&](int c, int r) {
    const double z = height(c, r);
    return z == kHole ? 0U : static_cast<std::uint32_t>(1 + std::lround(z / 40 * 65534));
  });
}
HeightField fieldOf(const Frame& frame) {
  return HeightField::make(frame, {.bits = 16, .invalid = 0}, kVolume).value();
}
HeightLattice latticeOf(const HeightMm& height, int cols = kCols, int rows = kRows) {
  const Frame frame = frameOf(height, cols, rows);
  HeightLattice lattice;
  lattice.read(fieldOf(frame), 4096);
  return lattice;
}
std::vector<std::uint32_t> cutsOf(HeightLattice lattice) {
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  return cuts.cells();
}

struct Drawn {
  HeightLattice lattice;
  OutputArray<TexturedVertex> vertices;
  OutputArray<std::uint32_t> indices;

  // The heights drawn at a lattice vertex.
  [[nodiscard]] std::vector<double> heightsAt(int c, int r) const {
    std::vector<double> heights;
    for (const TexturedVertex& v : vertices) {
      if (std::abs(v.x - lattice.x(c)) < 1e-4F && std::abs(v.y - lattice.y(r)) < 1e-4F)
        heights.push_back(static_cast<double>(v.z));
    }
    return heights;
  }
  [[nodiscard]] bool isDrawnAt(int c, int r, double z) const {
    const auto all = heightsAt(c, r);
    return std::ranges::any_of(all, [z](double one) { return std::abs(one - z) < 0.01; });
  }
  // The number of triangles that cover a point, borders excluded.
  [[nodiscard]] int timesDrawnAt(float x, float y) const {
    const auto left_of = [&](const TexturedVertex& from, const TexturedVertex& to) {
      return (to.x - from.x) * (y - from.y) - (x - from.x) * (to.y - from.y) > 0;
    };
    int times = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const auto &a = vertices[indices[i]], &b = vertices[indices[i + 1]], &c = vertices[indices[i + 2]];
      if (left_of(a, b) && left_of(b, c) && left_of(c, a)) ++times;
    }
    return times;
  }
};

// One cell, whose top left corner is (c, r).
Drawn drawCell(const HeightMm& height, int c, int r, const ViewSpan& view = {}) {
  Drawn drawn{.lattice = latticeOf(height), .vertices = {}, .indices = {}};
  const auto corner = static_cast<std::uint32_t>(r * drawn.lattice.cols() + c);
  // The surface has one vertex there, on the far side.
  drawn.vertices.add({{{drawn.lattice.x(c), drawn.lattice.y(r), 0, drawn.lattice.u(c), drawn.lattice.v(r)}}});
  std::vector<std::uint32_t> slots(drawn.lattice.size(), 0);
  slots[corner] = 1;
  SilhouetteDrawer(drawn.lattice, view, drawn.vertices, drawn.indices).drawCell(corner, slots);
  return drawn;
}

double step(int c, int /*r*/) {
  return c < kEdge ? 5 : 30;
}

TEST(Silhouette, TheFarSideGoesOnBehindTheNearOne) {
  const Drawn drawn = drawCell(step, kEdge - 1, 10);
  for (const int r : {10, 11}) {
    EXPECT_TRUE(drawn.isDrawnAt(kEdge, r, 30)) << "the near side";
    EXPECT_TRUE(drawn.isDrawnAt(kEdge, r, 5)) << "and the far one behind it";
    EXPECT_FALSE(drawn.isDrawnAt(kEdge - 1, r, 30));
  }
}

// The cell at (kEdge, row) with the given near corners.
Drawn drawCorners(unsigned near, int row) {
  const auto height = [&](int c, int r) {
    const int corner = c == kEdge ? r - row : c == kEdge + 1 ? 3 - (r - row) : -1;
    return r >= row && r <= row + 1 && corner >= 0 && (near >> corner & 1U) != 0 ? 39.0 : 5.0;
  };
  return drawCell(height, kEdge, row);
}

// Bits of the corners, counterclockwise from the top left. High in the picture an eye sees behind objects above, low in
// the picture behind objects below.
class SilhouetteOfCorners : public testing::TestWithParam<std::tuple<unsigned, int>> {};
INSTANTIATE_TEST_SUITE_P(All, SilhouetteOfCorners, testing::Combine(testing::Range(1U, 15U), testing::Values(4, 27)));

TEST_P(SilhouetteOfCorners, DrawsTheNearPartAndAllOfTheFarOneAndOnBehindIt) {
  const auto [near, row] = GetParam();
  const auto is_near = [near](int k) { return (near >> k & 1U) != 0; };
  const Drawn drawn = drawCorners(near, row);
  const auto& lattice = drawn.lattice;
  const float left = lattice.x(kEdge), right = lattice.x(kEdge + 1), top = lattice.y(row), low = lattice.y(row + 1);
  double of_near = 0, of_far = 0;
  for (std::size_t i = 0; i < drawn.indices.size(); i += 3) {
    const auto& a = drawn.vertices[drawn.indices[i]];
    const auto& b = drawn.vertices[drawn.indices[i + 1]];
    const auto& c = drawn.vertices[drawn.indices[i + 2]];
    const double area = 0.5 * static_cast<double>((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
    EXPECT_GT(area, 0) << "counterclockwise to the viewer";
    EXPECT_TRUE(std::abs(a.z - b.z) < 0.01F && std::abs(a.z - c.z) < 0.01F) << "from one thing to the other";
    const float x = (a.x + b.x + c.x) / 3, y = (a.y + b.y + c.y) / 3;
    if (x < left || x > right || y > top || y < low) continue;  // behind what is beside the cell
    (a.z > 20 ? of_near : of_far) += area;
  }
  const double cell = static_cast<double>((right - left) * (top - low));
  const std::array<double, 4> share{0, 1.0 / 8, near == 5 || near == 10 ? 3.0 / 4 : 1.0 / 2, 7.0 / 8};
  EXPECT_NEAR(of_near / cell, share[static_cast<std::size_t>(std::popcount(near))], 1e-4);
  EXPECT_NEAR(of_far / cell, 1, 1e-4);

  const auto any = [&](auto&& beyond) { return std::ranges::any_of(drawn.vertices, beyond); };
  const bool far_left = !is_near(0) && !is_near(1), far_right = !is_near(2) && !is_near(3);
  const bool far_above = !is_near(0) && !is_near(3), far_below = !is_near(1) && !is_near(2);
  EXPECT_EQ(any([&](auto& v) { return v.x > right + 0.1F; }), far_left);
  EXPECT_EQ(any([&](auto& v) { return v.x < left - 0.1F; }), far_right);
  EXPECT_EQ(any([&](auto& v) { return v.y < low - 0.1F; }), far_above && row > kRows / 2);
  EXPECT_EQ(any([&](auto& v) { return v.y > top + 0.1F; }), far_below && row < kRows / 2);

  // The far side takes its colour from further away.
  const int aside_right = (is_near(0) ? -1 : 1) + (is_near(1) ? -1 : 1) - (is_near(2) ? -1 : 1) - (is_near(3) ? -1 : 1);
  const int aside_down = (is_near(1) ? -1 : 1) + (is_near(2) ? -1 : 1) - (is_near(0) ? -1 : 1) - (is_near(3) ? -1 : 1);
  const auto toward = [](int sum) { return static_cast<float>((sum > 0) - (sum < 0)); };
  if (!is_near(0)) {
    EXPECT_NEAR(drawn.vertices[0].u, lattice.u(kEdge) - 1.5F * toward(aside_right) / kCols, 1e-6) << "of the surface";
    EXPECT_NEAR(drawn.vertices[0].v, lattice.v(row) + 1.5F * toward(aside_down) / kRows, 1e-6);
  }
}

TEST_P(SilhouetteOfCorners, WhatGoesOnBehindTheNearPartIsThereOnce) {
  const auto [near, row] = GetParam();
  const Drawn drawn = drawCorners(near, row);
  const auto& lattice = drawn.lattice;
  const float left = lattice.x(kEdge), right = lattice.x(kEdge + 1), top = lattice.y(row), low = lattice.y(row + 1);
  float leftmost = left, rightmost = right, lowest = low, topmost = top;
  for (const TexturedVertex& v : drawn.vertices) {
    leftmost = std::min(leftmost, v.x), rightmost = std::max(rightmost, v.x);
    lowest = std::min(lowest, v.y), topmost = std::max(topmost, v.y);
  }
  for (const float p : {0.1F, 0.6F, 0.85F}) {
    for (const float q : {0.2F, 0.7F}) {
      const float x = std::lerp(left, right, q), y = std::lerp(low, top, q);
      EXPECT_EQ(drawn.timesDrawnAt(std::lerp(right, rightmost, p), y), rightmost > right ? 1 : 0);
      EXPECT_EQ(drawn.timesDrawnAt(std::lerp(left, leftmost, p), y), leftmost < left ? 1 : 0);
      EXPECT_EQ(drawn.timesDrawnAt(x, std::lerp(top, topmost, p)), topmost > top ? 1 : 0);
      EXPECT_EQ(drawn.timesDrawnAt(x, std::lerp(low, lowest, p)), lowest < low ? 1 : 0);
    }
  }
}

TEST(Silhouette, ACornerBelongsToTheSideThatItIsNearerTo) {
  const auto height = [](int c, int r) { return c >= kEdge ? 30.0 : r > 10 ? 12.0 : 5.0; };
  const Drawn drawn = drawCell(height, kEdge - 1, 10);
  EXPECT_TRUE(drawn.isDrawnAt(kEdge, 11, 12)) << "the far side's own slope goes on behind the near one";
  EXPECT_TRUE(drawn.isDrawnAt(kEdge, 10, 5));
}

TEST(Silhouette, BesideTheOutlineTheFarSideShowsWhatIsFartherAway) {
  const Drawn drawn = drawCell(step, kEdge - 1, 10);
  const float aside = drawn.lattice.u(kEdge - 1) - 1.5F / kCols;
  EXPECT_NEAR(drawn.vertices[0].u, aside, 1e-6) << "of the surface";
  for (const TexturedVertex& v : drawn.vertices) {
    const bool is_far = std::abs(v.x - drawn.lattice.x(kEdge - 1)) < 1e-4F;
    EXPECT_NEAR(v.u, is_far ? aside : v.u, 1e-6);
    EXPECT_NEAR(v.v, drawn.lattice.v(v.y > drawn.lattice.y(10) - 1e-4F ? 10 : 11), 1e-6);
  }
}

// Behind an object that rises over several samples, an eye sees as far as over its top.
TEST(Silhouette, ReachesAsFarBehindAsSomeEyeSees) {
  const auto height = [](int c, int /*r*/) { return c < kEdge ? 5.0 : 20.0 + std::min(2 * (c - kEdge), 20); };
  const ViewSpan view;
  const Drawn drawn = drawCell(height, kEdge - 1, 10, view);
  const double top = 20 + 2 * 7;  // the height of the eight samples examined
  const double distance = view.distance_mm + view.screen_z_mm - top;
  const double length = (top - 5) * (static_cast<double>(drawn.lattice.x(kEdge)) + view.eye_mm) / distance;
  double reach = 0;
  for (const TexturedVertex& v : drawn.vertices) {
    if (v.z < 6) reach = std::max(reach, static_cast<double>(v.x));
  }
  EXPECT_NEAR(reach, static_cast<double>(drawn.lattice.x(kEdge)) + length, 0.01);
}

// The far side already extends half a cell behind the outline, which is enough without a strip.
TEST(Silhouette, DrawsNoStripWhereTheCellItselfReachesFarEnough) {
  const auto reach = [](double jump_mm) {
    const Drawn drawn =
        drawCell([=](int c, int /*r*/) { return c < kEdge ? 5.0 : 5.0 + jump_mm; }, kEdge - 1, 10, ViewSpan{});
    double right = -1e9;
    for (const TexturedVertex& v : drawn.vertices) {
      if (v.z < 5.1F) right = std::max(right, static_cast<double>(v.x - drawn.lattice.x(kEdge)));
    }
    return right;
  };
  const Drawn drawn = drawCell(step, kEdge - 1, 10);
  const double half = 0.5 * static_cast<double>(drawn.lattice.x(kEdge) - drawn.lattice.x(kEdge - 1));
  const double per_mm = (static_cast<double>(drawn.lattice.x(kEdge)) + ViewSpan{}.eye_mm) / 600;  // about
  const double enough = half / per_mm;
  EXPECT_NEAR(reach(0.9 * enough), 0, 1e-4);
  EXPECT_GT(reach(1.1 * enough), half);
}

TEST(CutCells, AThinThingIsNoSmear) {
  const auto wire = [](int c, int /*r*/) { return c == 20 ? 30.0 : 5.0; };
  HeightLattice lattice = latticeOf(wire);
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  EXPECT_NEAR(lattice.heights()[20], 30, 0.01);
  EXPECT_EQ(cuts.cells().size(), 2U * (kRows - 1));
}

TEST(CutCells, NothingIsLeftOfAnotherPicture) {
  CutCells cuts;
  HeightLattice wide = latticeOf([](int c, int r) { return (c + r) % 2 == 0 ? 5.0 : 30.0; });
  cuts.find(wide, wide.jumpMm());
  HeightLattice narrow = latticeOf(step, 49, 25);
  cuts.find(narrow, narrow.jumpMm());
  EXPECT_EQ(cuts.cells(), cutsOf(latticeOf(step, 49, 25)));
  for (int r = 0; r + 1 < narrow.rows(); ++r) {
    EXPECT_FALSE(cuts.contains(static_cast<std::size_t>(r + 1) * narrow.cols() - 1)) << "right of the picture";
  }
}

TEST(HeightLattice, ARowThatNobodyMeasuredLiesOnTheFarPlane) {
  const HeightLattice lattice = latticeOf([](int, int) { return kHole; });
  EXPECT_EQ(std::count(lattice.heights(), lattice.heights() + lattice.size(), 0.0F),
            static_cast<std::ptrdiff_t>(lattice.size()));
}

TEST(HeightLattice, AHoleTakesTheHeightOfItsFartherSideWhicheverThatIs) {
  for (const bool left_is_far : {false, true}) {
    const HeightLattice lattice = latticeOf([&](int c, int) {
      return c >= 20 && c < 24 ? kHole : (c < 20) == left_is_far ? 5.0 : 30.0;
    });
    for (int i = 20; i < 24; ++i) EXPECT_NEAR(lattice.heights()[i], 5, 0.01) << left_is_far << ' ' << i;
  }
}

// Four times the pitch of the samples, along the side that has more than one; and never below a millimetre.
TEST(HeightLattice, AJumpIsFourTimesAsSteepAsWideAndAMillimetreAtLeast) {
  const auto flat = [](int, int) { return 5.0; };
  EXPECT_NEAR(latticeOf(flat, 41, 1).jumpMm(), 4 * 160.0 / 41, 1e-3);
  EXPECT_NEAR(latticeOf(flat, 1, 9).jumpMm(), 4 * 80.0 / 9, 1e-3);
  EXPECT_NEAR(latticeOf(flat, 1601, 17).jumpMm(), 1, 1e-6);
}

// Samples are read by runs of 16.
TEST(HeightLattice, AHoleThatIsAWholeRunEndsWhereItEnds) {
  const HeightLattice lattice = latticeOf([](int c, int) { return c >= 16 && c < 32 ? kHole : c < 16 ? 5.0 : 30.0; });
  for (int i = 14; i < 35; ++i) EXPECT_NEAR(lattice.heights()[i], i < 32 ? 5 : 30, 0.01) << i;
}

// The hole of the second row is wider than that of the first and has a lower neighbour.
TEST(HeightLattice, WhatIsFilledHasNoJumps) {
  const auto height = [](int c, int r) {
    if (r == 0) return c >= 20 && c < 40 ? kHole : 30.0;
    return c >= 5 && c < 40 ? kHole : c < 5 ? 2.0 : 30.0;
  };
  const HeightLattice lattice = latticeOf(height);
  const float* second = lattice.heights() + lattice.cols();
  for (int c = 6; c < 40; ++c) EXPECT_LE(std::abs(second[c] - second[c - 1]), 0.5001F * lattice.jumpMm()) << c;
  EXPECT_GT(*std::max_element(second + 5, second + 40), 15) << "it follows the row above";
}

TEST(ReliefTriangles, AFrameJoinsTheReliefToThePicturesRectangle) {
  const Frame frame = frameOf([](int, int) { return 30.0; });
  ReliefTriangles relief;
  relief.build(fieldOf(frame), kVolume, {});
  const float screen_mm = 20;
  int left = 0, right = 0, above = 0, below = 0;
  const auto& at = relief.vertices();
  for (std::size_t i = 0; i + 2 < relief.indices().size(); i += 3) {
    bool on_relief = false, on_screen = false;
    float x = 0, y = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      const TexturedVertex& v = at[relief.indices()[k]];
      on_relief = on_relief || std::abs(v.z - 30) < 0.01F;
      on_screen = on_screen || v.z == screen_mm;
      if (v.z == screen_mm) x = v.x, y = v.y;
    }
    if (!on_relief || !on_screen) continue;
    left += x == -80;
    right += x == 80;
    above += y == 40;
    below += y == -40;
  }
  for (const int side : {left, right, above, below}) EXPECT_GT(side, 1);
}

// The same scene side by side on 1280 x 720, from depth pictures of three sizes: waves, and a disc before them.
TEST(ReliefTriangles, ALargerDepthPictureTakesNoMoreTrianglesOnTheSameScreen) {
  const StereoSettings stereo{.layout = StereoLayout::SideBySide};
  const DisplayVolume volume{160.0, 108.0, 40.0};
  const EyeViews eyes = eyeViews(stereo, volume, 1280, 720);
  const ReliefDetail detail{.most_across = ReliefDetail::cellsFor(eyes.pixels_per_mm * volume.width_mm),
                            .error_mm = 0.5 * heightOfPixelMm(stereo, volume, eyes.pixels_per_mm)};
  EXPECT_GE(detail.most_across, 533) << "a cell for each of the picture's pixels";
  std::size_t small = 0, small_cuts = 0;
  for (const int times : {1, 2, 4}) {
    const int cols = 720 * times, rows = 486 * times;
    const Frame frame = test::makeGrayFrame(cols, rows, 16, MediaTime{}, [&](int c, int r) {
      const float x = static_cast<float>(c) / static_cast<float>(cols),
                  y = static_cast<float>(r) / static_cast<float>(rows);
      const bool on_disc = (x - 0.4F) * (x - 0.4F) + (y - 0.5F) * (y - 0.5F) < 0.04F;
      return static_cast<std::uint32_t>((on_disc ? 50'000.0F : 15'000.0F) + 30'000.0F * x * (1 - x) * (1 - y));
    });
    ReliefTriangles relief;
    relief.build(HeightField::make(frame, {.bits = 16}, volume).value(), volume, detail);
    const std::size_t count = relief.indices().size() / 3;
    if (times == 1) small = count, small_cuts = relief.cutCells();
    EXPECT_LE(static_cast<double>(count), 1.2 * static_cast<double>(small)) << times;
    EXPECT_LE(static_cast<double>(relief.cutCells()), 1.2 * static_cast<double>(small_cuts)) << times;
    EXPECT_GT(relief.cutCells(), 500U);
    EXPECT_LE(static_cast<double>(relief.samples()), 1.2 * 720 * 486) << times;
  }
}

// An error of 2 px instead of half of one hardly matters to a picture of outlines; a wider pitch does.
TEST(ReliefTriangles, ALargerErrorTakesFewerTrianglesAlongOutlinesToo) {
  EXPECT_EQ(ReliefDetail::cellsFor(540), 720);
  EXPECT_EQ(ReliefDetail::cellsFor(540, 1.5), 480);
  EXPECT_EQ(ReliefDetail::cellsFor(540, 8), 360) << "at most twice as wide";
  const Frame frame = test::makeGrayFrame(720, 486, 16, MediaTime{},
                                          [](int c, int r) { return (c / 60 + r / 60) % 2 == 0 ? 10'000U : 50'000U; });
  const HeightField field = HeightField::make(frame, {.bits = 16}, kVolume).value();
  const auto count = [&](double factor) {
    ReliefTriangles relief;
    relief.build(field, kVolume, {.most_across = ReliefDetail::cellsFor(540, factor), .error_mm = 0.5 * factor});
    return static_cast<double>(relief.indices().size());
  };
  EXPECT_LT(count(2), 0.6 * count(1));
}

TEST(ReliefTriangles, WhatStandsStillIsNotMadeAgain) {
  const auto pictureOf = [](int raised) {
    return frameOf([=](int c, int r) { return c == raised && r == 7 ? 30.0 : c < kEdge ? 5.0 : 25.0; });
  };
  const Frame first = pictureOf(-1), same = pictureOf(-1), other = pictureOf(12);
  ReliefTriangles relief;
  ReliefDetail detail;
  EXPECT_TRUE(relief.build(fieldOf(first), kVolume, detail));
  const std::size_t triangles = relief.indices().size();
  EXPECT_FALSE(relief.build(fieldOf(same), kVolume, detail));
  EXPECT_EQ(relief.indices().size(), triangles);
  EXPECT_TRUE(relief.build(fieldOf(other), kVolume, detail)) << "one sample has risen";
  EXPECT_GT(relief.indices().size(), triangles);
  EXPECT_TRUE(relief.build(fieldOf(same), kVolume, detail)) << "it has sunk again";
  EXPECT_EQ(relief.indices().size(), triangles);
  detail.view.eye_mm *= 2;
  EXPECT_TRUE(relief.build(fieldOf(same), kVolume, detail)) << "seen from elsewhere";
  DisplayVolume deeper = kVolume;
  deeper.depth_mm *= 2;
  EXPECT_TRUE(relief.build(HeightField::make(same, {.bits = 16}, deeper).value(), deeper, detail));
}

}  // namespace
}  // namespace relievo
