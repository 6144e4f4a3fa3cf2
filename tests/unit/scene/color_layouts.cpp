// SPDX-License-Identifier: Apache-2.0
// Blocks of colours in every layout of samples: eight cells are read side by side, or one by one at the right edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "app/scene/height_field.h"
#include "tests/unit/scene/hue_frames.h"

namespace relievo {
namespace {

using test::kHue;
using test::kUnit;

constexpr int kCols = 48, kRows = 32;

struct Layout {
  const char* name;
  int bits, shift;  // how far a code is shifted up in its word
  bool interleaved, halved;
};
constexpr Layout kLayouts[] = {
    {"yuv420p", 8, 0, false, true},     {"nv12", 8, 0, true, true},  {"yuv444p", 8, 0, false, false},
    {"yuv420p10", 10, 0, false, true},  {"p010", 10, 6, true, true}, {"yuv420p9", 9, 0, false, true},
    {"yuv444p12", 12, 0, false, false}, {"nv24", 8, 0, true, false},
};

double hueAt(double c, double r) {
  return 0.05 + 0.004 * c + 0.001 * r;  // over yellow, 1/6
}
// Luma and chroma of BT.709, 0 to 1.
std::array<double, 3> colorAt(int c, int r) {
  const auto [red, green, blue] = test::hueColor(hueAt(c, r));
  const double luma = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  return {luma, (blue - luma) / 1.8556 + 128.0 / 255, (red - luma) / 1.5748 + 128.0 / 255};
}

Frame make(const Layout& layout) {
  const int size = layout.bits > 8 ? 2 : 1, side = layout.halved ? 2 : 1, apart = layout.interleaved ? 2 : 1;
  const int cols = kCols / side, rows = kRows / side;
  const auto bytes = std::make_shared<std::vector<std::uint8_t>>(
      static_cast<std::size_t>(size) * static_cast<std::size_t>(kCols * kRows + 2 * cols * rows));
  std::uint8_t* const chroma = bytes->data() + std::ptrdiff_t{size} * kCols * kRows;
  const auto put = [&](std::uint8_t* at, double share) {
    const auto code = std::lround(std::min(share, 1.0) * 255 * (1 << (layout.bits - 8))) << layout.shift;
    at[0] = static_cast<std::uint8_t>(code);
    if (size == 2) at[1] = static_cast<std::uint8_t>(code >> 8);
  };
  Frame frame = test::bt709Frame(kCols, kRows, layout.halved ? 1 : 0);
  for (std::uint8_t i = 0; i < 3; ++i) {
    const bool second = i == 2;
    const std::ptrdiff_t behind = second && !layout.interleaved ? std::ptrdiff_t{size} * cols * rows : 0;
    frame.components[i] = {.plane = i,
                           .offset_bytes = static_cast<std::uint8_t>(second && layout.interleaved ? size : 0),
                           .step_bytes = static_cast<std::uint8_t>(i == 0 ? size : apart * size),
                           .shift = static_cast<std::uint8_t>(layout.shift),
                           .bits = static_cast<std::uint8_t>(layout.bits)};
    frame.planes[i] = {i == 0 ? bytes->data() : chroma + behind,
                       std::ptrdiff_t{size} * (i == 0 ? kCols : apart * cols)};
  }
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) put(bytes->data() + std::ptrdiff_t{size} * (r * kCols + c), colorAt(c, r)[0]);
  }
  for (std::uint8_t i = 1; i < 3; ++i) {
    std::uint8_t* const first = const_cast<std::uint8_t*>(frame.planes[i].data) + frame.components[i].offset_bytes;
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        double sum = 0;
        for (int k = 0; k < side * side; ++k) sum += colorAt(side * c + k % side, side * r + k / side)[i];
        put(first + r * frame.planes[i].stride_bytes + std::ptrdiff_t{c} * frame.components[i].step_bytes,
            sum / (side * side));
      }
    }
  }
  frame.owner = bytes;
  return frame;
}

TEST(ColorLayouts, ABlockHasTheMeanOfItsMiddle) {
  for (const Layout& layout : kLayouts) {
    const Frame frame = make(layout);
    const auto field = HeightField::make(frame, kHue, kUnit).value();
    for (const auto& [width, height] : {std::pair(2, 2), {3, 5}, {7, 4}, {16, 16}, {15, 13}, {20, 20}}) {
      for (int c = 0; c + width <= kCols; c += 3) {
        for (int r = 0; r + height <= kRows; r += 5) {
          EXPECT_NEAR(field.meanHeight(c, r, {width, height, 32}), hueAt(c + (width - 1) / 2.0, r + (height - 1) / 2.0),
                      0.0015)
              << layout.name << ' ' << width << " x " << height << " at " << c << ' ' << r;
        }
      }
    }
  }
}

}  // namespace
}  // namespace relievo
