// SPDX-License-Identifier: Apache-2.0
// Hues to depth: over subsampled chroma, at edges, holes and the circle's seam.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "app/scene/height_field.h"
#include "tests/unit/scene/hue_frames.h"

namespace relievo {
namespace {

using test::hueColor;
using test::kHue;
using test::kUnit;
using test::Rgb;

// Full range of BT.709, 4:2:0: chroma is the mean of four samples, rounded.
struct Film {
  int cols = 48, rows = 32;
  std::function<Rgb(int, int)> color;
  bool blurred = false;  // luma: 1/4, 1/2, 1/4 across

  [[nodiscard]] Frame frame() const {
    const auto samples = std::make_shared<std::vector<std::uint8_t>>();
    const auto put = [&](double x) {
      samples->push_back(static_cast<std::uint8_t>(std::min(255L, std::lround(255 * x))));
    };
    const auto luma = [&](const Rgb& k) { return 0.2126 * k[0] + 0.7152 * k[1] + 0.0722 * k[2]; };
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        const double own = luma(color(c, r));
        put(blurred ? own / 2 + (luma(color(c - 1, r)) + luma(color(c + 1, r))) / 4 : own);
      }
    }
    for (const std::size_t part : {2U, 0U}) {
      const double span = part == 2 ? 1.8556 : 1.5748;
      for (int r = 0; r < rows; r += 2) {
        for (int c = 0; c < cols; c += 2) {
          double sum = 0;
          for (int k = 0; k < 4; ++k) {
            const Rgb at = color(c + k % 2, r + k / 2);
            sum += (at[part] - luma(at)) / span / 4;
          }
          put(sum + 128.0 / 255);
        }
      }
    }
    Frame frame = test::bt709Frame(cols, rows, 1);
    const int luma_size = cols * rows;
    for (std::uint8_t i = 0; i < 3; ++i) {
      frame.components[i] = {.plane = i};
      const int begin = i == 0 ? 0 : luma_size + (i - 1) * luma_size / 4;
      frame.planes[i] = {samples->data() + begin, i == 0 ? cols : cols / 2};
    }
    frame.owner = samples;
    return frame;
  }
};

// Pairs of hues whose mean is gray, or another hue. The step lies within a chroma sample in both directions.
TEST(HueOverYuv, EverySampleAtAnEdgeIsOneSideOrTheOther) {
  for (const auto& [left, right] : {std::pair(0.1, 0.6), {0.6, 0.1}, {0.05, 0.9}, {0.75, 0.2}}) {
    const auto is_right = [](int c, int r) { return c >= 17 || r >= 21; };
    const Film film{.color = [&](int c, int r) { return hueColor(is_right(c, r) ? right : left); }};
    const Frame frame = film.frame();
    const auto field = HeightField::make(frame, kHue, kUnit).value();
    int wrong_side = 0, holes = 0;
    for (int r = 0; r < 32; ++r) {
      for (int c = 0; c < 48; ++c) {
        const double height = field.heightMm(c, r), own = is_right(c, r) ? right : left;
        const double other = is_right(c, r) ? left : right;
        if (std::isnan(height)) {
          ++holes;
          continue;
        }
        EXPECT_LT(std::min(std::abs(height - own), std::abs(height - other)), 0.04)
            << left << ' ' << right << " at " << c << ' ' << r << ": " << height;
        if (std::abs(height - own) > 0.04) ++wrong_side;
      }
    }
    EXPECT_LE(holes, 1) << left << ' ' << right << ": in the corner";
    EXPECT_LE(wrong_side, 8) << left << ' ' << right << ": brightness tells the sides apart";
  }
}

// A ball before a wall that is nearly as bright as its rim, and luma blurred as codecs do: neither brightness nor
// chroma alone tells the sides apart.
TEST(HueOverYuv, ARoundBallKeepsItsRim) {
  const auto truth = [](int c, int r) {
    const double out = std::hypot(c - 23.3, r - 15.8) / 13.2;
    return out < 1 ? 0.66 + 0.09 * out * out : 0.95;
  };
  const Film film{.color = [&](int c, int r) { return hueColor(truth(c, r)); }, .blurred = true};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  int off = 0;
  for (int r = 0; r < 32; ++r) {
    for (int c = 0; c < 48; ++c) off += std::abs(field.heightMm(c, r) - truth(c, r)) < 0.05 ? 0 : 1;
  }
  EXPECT_EQ(off, 0) << "of 150 at the rim";
}

// A step so low that the mixture of its colours is near the circle of hues.
TEST(HueOverYuv, ALowStepIsAsSharpAsItsBrightness) {
  const auto truth = [](int c) { return c >= 17 ? 0.8 : 0.7; };
  const Film film{.color = [&](int c, int) { return hueColor(truth(c)); }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  for (int c = 0; c < 48; ++c) EXPECT_NEAR(field.heightMm(c, 10), truth(c), 0.02) << c;
}

// Colours from red to yellow are on a straight line, so that a block's mean is the height of its middle. At its ends a
// block may cover half of a chroma sample.
TEST(HueOverYuv, TheMeanOfABlockIsThatOfItsMiddleWhereverItBegins) {
  constexpr double kBegin = 0.02, kRise = 0.005;
  for (const bool across : {true, false}) {
    const Film film{
        .cols = 24, .rows = 24, .color = [&](int c, int r) { return hueColor(kBegin + kRise * (across ? c : r)); }};
    const Frame frame = film.frame();
    const auto field = HeightField::make(frame, kHue, kUnit).value();
    for (const auto& [size, most] : {std::pair(2, 8), {3, 8}, {4, 8}, {5, 8}, {6, 8}, {7, 8}, {12, 4}}) {
      for (int k = 0; k < 2 * (25 - size); ++k) {
        const int begin = k / 2, other = 2 + k % 2, c = across ? begin : other, r = across ? other : begin;
        const double middle = kBegin + kRise * (begin + (size - 1) / 2.0);
        EXPECT_NEAR(field.meanHeight(c, r, {size, size, most}), middle, 0.001)
            << size << ' ' << begin << (across ? " across" : " down");
      }
    }
  }
}

// At yellow the curve turns: the mean of colours on both sides lies off it, nearer to a place beside the mean height.
TEST(HueOverYuv, TheMeanOfABlockWithACornerOfTheCurveIsThatOfItsSamples) {
  constexpr double kRise = 0.005;
  constexpr int kSize = 16;
  const Film film{.cols = 48, .rows = 32, .color = [](int c, int) { return hueColor(0.05 + kRise * c); }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  for (int c = 0; c + kSize <= film.cols; ++c) {
    const double middle = 0.05 + kRise * (c + (kSize - 1) / 2.0);
    EXPECT_NEAR(field.meanHeight(c, 4, {kSize, kSize, 8}), middle, 0.002) << c;
  }
}

// Three of eight samples are known, those of the upper quarters' upper three fourths: fewer than half.
TEST(HueOverYuv, ABlockIsAHoleByAllOfItsSamples) {
  const Film film{
      .cols = 48, .rows = 32, .color = [](int c, int r) { return r < 6 ? hueColor(0.1 + 0.02 * c) : Rgb{}; }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  EXPECT_TRUE(std::isnan(field.meanHeight(0, 0, {16, 16, 16})));
  EXPECT_FALSE(std::isnan(field.meanHeight(0, 0, {16, 8, 16})));
}

// Black, which is no depth, and the blue beside it lie on one piece of the curve.
TEST(HueOverYuv, ABlockAtAHoleHasTheHeightOfWhatIsKnown) {
  for (const int size : {2, 8, 15}) {
    const Film film{.cols = 48, .rows = 32, .color = [](int c, int) { return Rgb{0, 0, c < 20 ? 0.6 : 0}; }};
    const Frame frame = film.frame();
    const DepthCalibration kinect{.code = DepthCode::Kinect, .invalid = CodeSet(CodeSet::Range{0, 8})};
    const auto field = HeightField::make(frame, kinect, kUnit).value();
    EXPECT_NEAR(field.meanHeight(19 - size / 2, 4, {size, size, 16}), 0.2, 0.01) << size;
  }
}

// Codecs ring: black that is a little yellow lies before the curve's beginning.
TEST(HueOverYuv, ColoursBeyondTheEndsOfTheCurveAreThoseOfItsEnds) {
  const Film film{.cols = 48, .rows = 32, .color = [](int c, int) { return Rgb{0, 0, c < 20 ? -0.02 : 0.6}; }};
  const Frame frame = film.frame();
  const DepthCalibration kinect{.code = DepthCode::Kinect, .invalid = CodeSet(CodeSet::Range{0, 8})};
  const auto field = HeightField::make(frame, kinect, kUnit).value();
  EXPECT_TRUE(std::isnan(field.heightMm(5, 5)));
  EXPECT_TRUE(std::isnan(field.meanHeight(4, 4, {8, 8, 16})));
}

// Columns in any order, with edges, black and the seam among them.
TEST(HueOverYuv, ARowIsReadAsItsSamplesAre) {
  const Film film{
      .color = [](int c, int r) { return c < 9 ? Rgb{} : hueColor(c < 30 ? 0.01 * c : 0.9 + 0.01 * (r % 16)); }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  std::vector<int> columns;
  for (int c = 47; c >= 0; c -= 1 + c % 2) columns.push_back(c);
  std::vector<float> heights(columns.size());
  for (int r = 0; r < film.rows; ++r) {
    EXPECT_TRUE(field.readRow(r, columns, heights.data()));  // black is a hole
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto alone = static_cast<float>(field.heightMm(columns[i], r));
      EXPECT_TRUE(heights[i] == alone || (std::isnan(heights[i]) && std::isnan(alone))) << columns[i] << ' ' << r;
    }
  }
}

// Of an edge that takes five samples, those in its middle are on neither side.
TEST(HueOverYuv, ASoftEdgeHasItsSlope) {
  for (const auto& [left, right] : {std::pair(0.5, 0.8), {0.8, 0.5}, {0.1, 0.4}, {0.25, 0.65}}) {
    const auto truth = [&](int c) { return left + (right - left) / (1 + std::exp(-(c - 20.3))); };
    const Film film{.color = [&](int c, int) { return hueColor(truth(c)); }};
    const Frame frame = film.frame();
    const auto field = HeightField::make(frame, kHue, kUnit).value();
    for (int c = 0; c < 48; ++c) {
      EXPECT_NEAR(field.heightMm(c, 10), truth(c), 0.06) << left << ' ' << right << " at " << c;
    }
  }
}

// The mean of two hues that are close is between them, a slope and not a wall.
TEST(HueOverYuv, AMixtureOfCloseHuesIsBetweenThem) {
  const Film film{.color = [](int c, int) { return hueColor(c >= 17 ? 0.45 : 0.3); }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  for (int c = 0; c < 48; ++c) {
    const double height = field.heightMm(c, 10);
    EXPECT_GT(height, 0.295) << c;
    EXPECT_LT(height, 0.455) << c;
  }
}

TEST(HueOverYuv, BlackIsAHoleWithASharpEdge) {
  const Film film{.color = [](int c, int) { return c >= 17 ? Rgb{} : hueColor(0.2); }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  for (int c = 0; c < 48; ++c) {
    const double height = field.heightMm(c, 10);
    if (c >= 17) {
      EXPECT_TRUE(std::isnan(height)) << c << ": " << height;
    } else {
      EXPECT_NEAR(height, 0.2, 0.02) << c;
    }
  }
}

// Coding moves a hue at the seam, red, from one end of the depth to the other. Red alone is a hole; red beside a
// surface near one end belongs to that end, so that no wall appears.
TEST(HueOverYuv, TheSeamIsNoWall) {
  const Film film{.color = [](int c, int) { return hueColor(c < 24 ? 0.02 : (c % 2 == 0 ? 0.0005 : 0.9995)); }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  for (int c = 0; c < 48; ++c) {
    const double height = field.heightMm(c, 10);
    if (c < 28) {
      EXPECT_NEAR(height, 0.02, 0.015) << c;
    } else {
      EXPECT_TRUE(std::isnan(height)) << c << ": " << height;
    }
  }
}

// A hole that is painted red keeps its border, though the surface beside it may be as bright.
TEST(HueOverYuv, RedIsAHoleUpToItsEdge) {
  for (const double beside : {0.15, 0.55, 0.8}) {
    const Film film{.color = [&](int c, int) { return hueColor(c >= 17 ? 0 : beside); }};
    const Frame frame = film.frame();
    const auto field = HeightField::make(frame, kHue, kUnit).value();
    for (int c = 0; c < 48; ++c) {
      const double height = field.heightMm(c, 10);
      if (c >= 18) {
        EXPECT_TRUE(std::isnan(height)) << beside << ' ' << c << ": " << height;
      }
      if (c < 16) {
        EXPECT_NEAR(height, beside, 0.02) << c;
      }
    }
  }
}

// A film whose colours are all a little paler than pure is read all the same.
TEST(HueOverYuv, PaleHuesAreReadWhereNoneIsPure) {
  const Film film{.color = [](int c, int) {
    Rgb color = hueColor(0.1 + 0.005 * c);
    for (double& part : color) part = 0.08 + 0.84 * part;
    return color;
  }};
  const Frame frame = film.frame();
  const auto field = HeightField::make(frame, kHue, kUnit).value();
  for (int c = 0; c < 48; ++c) EXPECT_NEAR(field.heightMm(c, 10), 0.1 + 0.005 * c, 0.04) << c;
}

}  // namespace
}  // namespace relievo
