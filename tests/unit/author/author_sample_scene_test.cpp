// SPDX-License-Identifier: Apache-2.0
// The sample film before encoding: its depth agrees with its surfaces, its objects are where they should be, and they
// move as they should.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "app/author/sample/sample_renderer.h"
#include "app/author/sample/sample_scene.h"
#include "app/author/sample/sample_stage.h"

namespace relievo {
namespace {

constexpr double kCodesPerMm = 255.0 / SampleFilm::kDepthMm;

double xOf(int c, int cols) {
  return ((c + 0.5) / cols - 0.5) * SampleFilm::kWidthMm;
}
double yOf(int r, int rows) {
  return (0.5 - (r + 0.5) / rows) * SampleFilm::kHeightMm;
}

SamplePicture rendered(double t_s, int cols, int rows, int threads = 2) {
  SamplePicture picture{.cols = cols, .rows = rows, .rgb = {}, .depth = {}};
  renderSample(t_s, threads, picture);
  return picture;
}

class AuthorSampleScene : public testing::TestWithParam<double> {};

// The picture's rays are cast in groups, in single precision, skipping distant parts; the height comes from the plain
// march in double precision over all parts. At grazed edges the two may differ.
TEST_P(AuthorSampleScene, DepthIsThatOfTheSurfaceToHalfACode) {
  constexpr int kCols = SampleFilm::kCols, kRows = SampleFilm::kRows;
  const SamplePicture picture = rendered(GetParam(), kCols, kRows);
  const auto code = [&](int c, int r) {
    return static_cast<int>(picture.depth[static_cast<std::size_t>(r * kCols + c)]);
  };
  int looked_at = 0, off = 0;
  for (int r = 3; r < kRows - 1; r += 5) {
    for (int c = 3; c < kCols - 1; c += 5) {
      ++looked_at;
      const double exact = kCodesPerMm * sampleSceneHeight(xOf(c, kCols), yOf(r, kRows), GetParam());
      if (std::abs(code(c, r) - exact) < 0.51) continue;
      ++off;
      const int jump = std::max({std::abs(code(c - 1, r) - code(c + 1, r)), std::abs(code(c, r - 1) - code(c, r + 1))});
      EXPECT_GT(jump, 3) << "at " << c << "," << r << ": " << code(c, r) << " instead of " << exact
                         << ", not at an edge";
    }
  }
  EXPECT_GT(looked_at, 13000);
  EXPECT_LE(off, 7);  // one in two thousand
}

// Independent check: nothing is above the height, and something is right below it.
TEST_P(AuthorSampleScene, HeightIsTheFirstSurfaceFromTheViewer) {
  const double t = GetParam();
  const auto check = [](const auto& scene, double x, double y, double z) {
    const double ground = scene.ground(x, y);
    for (double above = z + 0.02; above < sample::kStageDepthMm; above += 0.11) {
      ASSERT_GT(scene.solids({x, y, above}, sample::kAllParts), 0) << x << "," << y << " at " << above << " over " << z;
    }
    ASSERT_GE(z, ground - 1e-9);
    if (z > ground + 1e-6) {
      ASSERT_NEAR(scene.solids({x, y, z}, sample::kAllParts), 0, 1e-6) << x << "," << y;
    }
  };
  for (double y = -53; y < 54; y += 4.3) {
    for (double x = -79; x < 80; x += 3.7) {
      const double z = sampleSceneHeight(x, y, t) / sample::kReliefMmPerStageMm;
      if (t < SampleFilm::kCutSeconds) {
        check(sample::Portrait<double>(t), x, y, z);
      } else {
        check(sample::StillLife<double>(t), x, y, z);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Times, AuthorSampleScene, testing::Values(0.0, 1.45, 3.5, 6.1, 8.0, 10.7));

TEST(AuthorSampleFilm, PictureDoesNotDependOnTheThreads) {
  const SamplePicture one = rendered(3.0, 240, 162, 1), three = rendered(3.0, 240, 162, 3);
  EXPECT_EQ(one.rgb, three.rgb);
  EXPECT_EQ(one.depth, three.depth);
}

TEST(AuthorSampleFilm, BeginsWithAFaceInTheMiddle) {
  // The nose is the highest point, and within a finger's breadth of the middle.
  double highest = 0, at_x = 0, at_y = 0;
  for (double y = -50; y <= 50; y += 0.5) {
    for (double x = -75; x <= 75; x += 0.5) {
      const double z = sampleSceneHeight(x, y, 0);
      if (z > highest) highest = z, at_x = x, at_y = y;
    }
  }
  EXPECT_GT(highest, 18);
  EXPECT_LT(std::hypot(at_x, at_y), 12);
  // And it rises from the wall beside it by a large part of the volume.
  EXPECT_GT(sampleSceneHeight(0, 0, 0) - sampleSceneHeight(-38, 0, 0), 15);
}

TEST(AuthorSampleFilm, HeadMovesSmoothlyAndNoFasterThanAHandCanFollow) {
  double low = 1e9, high = -1e9, fastest = 0, sharpest = 0;
  constexpr double kStep = 2e-3;
  double before = sampleSceneHeight(6, -4, 0), speed_before = 0;
  for (int i = 1; i < 900; ++i) {  // 1.8 s, before the hand comes
    const double z = sampleSceneHeight(6, -4, i * kStep);
    const double speed = (z - before) / kStep;
    fastest = std::max(fastest, std::abs(speed));
    if (i > 1) sharpest = std::max(sharpest, std::abs(speed - speed_before));
    speed_before = speed;
    before = z;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  EXPECT_GT(high - low, 1.5);
  EXPECT_LT(fastest, 100);
  EXPECT_LT(sharpest, 10);  // mm/s from one step to the next: no jumps
}

TEST(AuthorSampleFilm, HandPassesBeforeTheFaceAndIsGoneAgain) {
  // At the height of the palm: nothing so near before the hand comes and after it has gone, something in between.
  const auto nearest = [](double t) {
    double highest = 0;
    for (double x = -78; x <= 78; x += 2) highest = std::max(highest, sampleSceneHeight(x, -14, t));
    return highest;
  };
  EXPECT_LT(nearest(1.9), 26);
  EXPECT_GT(nearest(3.75), 30);
  EXPECT_LT(nearest(5.6), 26);
  for (double t = 2.2; t < 5.3; t += 0.01) {
    const auto a = sample::handPose(t).palm, b = sample::handPose(t + 0.01).palm;
    EXPECT_LT(std::hypot(b.x - a.x, b.y - a.y, b.z - a.z) / 0.01, 100) << "mm/s at " << t;
  }
}

struct Changes {
  std::vector<double> of_depth, of_color;  // mean absolute difference from the previous picture
  int lowest = 255, highest = 0;
};

const Changes& changes() {
  static const Changes all = [] {
    Changes c;
    SamplePicture before;
    for (int k = 0; k < SampleFilm::kFrames; ++k) {
      SamplePicture now = rendered(k / static_cast<double>(SampleFilm::kFramesPerSecond), 120, 82);
      const auto [low, high] = std::minmax_element(now.depth.begin(), now.depth.end());
      c.lowest = std::min<int>(c.lowest, *low);
      c.highest = std::max<int>(c.highest, *high);
      const auto difference = [](const auto& a, const auto& b) {
        return std::transform_reduce(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                                     [](int p, int q) { return std::abs(p - q); }) /
               static_cast<double>(a.size());
      };
      if (k > 0) {
        c.of_depth.push_back(difference(now.depth, before.depth));
        c.of_color.push_back(difference(now.rgb, before.rgb));
      }
      before = std::move(now);
    }
    return c;
  }();
  return all;
}

TEST(AuthorSampleFilm, StaysWithinTheVolume) {
  EXPECT_GE(changes().lowest, 1);
  EXPECT_LE(changes().highest, 250);
  EXPECT_GT(changes().highest - changes().lowest, 200);  // uses most of the range
}

TEST(AuthorSampleFilm, HasOneCutAndOneOnly) {
  for (const std::vector<double>& change : {changes().of_depth, changes().of_color}) {
    const auto cut = std::max_element(change.begin(), change.end());
    // The first picture of the second scene is number 240, at 8 s; the entry before it compares it with number 239.
    EXPECT_EQ(cut - change.begin(), 239);
    std::vector<double> others(change.begin(), cut);
    others.insert(others.end(), cut + 1, change.end());
    EXPECT_GT(*cut, 5 * *std::max_element(others.begin(), others.end()));
  }
}

TEST(AuthorSampleFilm, NeverStandsStill) {
  const auto& depth = changes().of_depth;
  EXPECT_GT(*std::min_element(depth.begin(), depth.end()), 0.01);
}

}  // namespace
}  // namespace relievo
