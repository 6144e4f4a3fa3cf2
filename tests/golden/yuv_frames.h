// SPDX-License-Identifier: Apache-2.0
// Frames of YUV and RGB whose colours are known, and what the renderer makes of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

inline constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};

// Eight bars from left to right: the corners of the colour cube, slightly inset.
inline Rgb bar(double fraction) {
  const int i = std::min(static_cast<int>(fraction * 8), 7);
  return {(i & 4) != 0 ? 240 : 20, (i & 2) != 0 ? 230 : 30, (i & 1) != 0 ? 220 : 40};
}

// The standards' definition: E'Y = Kr R + Kg G + Kb B, E'Cb = (B - E'Y)/(2 (1 - Kb)), and the same for Cr.
inline std::array<double, 3> yuvOf(const Rgb& rgb, ColorMatrix matrix, bool limited, int bits) {
  const double kr = matrix == ColorMatrix::Bt601 ? 0.299 : matrix == ColorMatrix::Bt709 ? 0.2126 : 0.2627;
  const double kb = matrix == ColorMatrix::Bt601 ? 0.114 : matrix == ColorMatrix::Bt709 ? 0.0722 : 0.0593;
  const double r = rgb[0] / 255.0, g = rgb[1] / 255.0, b = rgb[2] / 255.0;
  const double y = kr * r + (1 - kr - kb) * g + kb * b;
  const double u = (b - y) / (2 * (1 - kb));
  const double v = (r - y) / (2 * (1 - kr));
  const double unit = std::pow(2.0, bits - 8);
  const double full = std::pow(2.0, bits) - 1;
  if (limited) return {(16 + 219 * y) * unit, (128 + 224 * u) * unit, (128 + 224 * v) * unit};
  return {full * y, 128 * unit + full * u, 128 * unit + full * v};
}

struct YuvFormat {
  const char* name;
  ColorMatrix matrix = ColorMatrix::Bt601;
  ColorRange range = ColorRange::Limited;
  int bits = 8;
  int shift = 0;
  int chroma_x = 1, chroma_y = 1;
  bool semi_planar = false;
  bool v_first = false;
  int padding = 0;  // bytes after each row
  bool upside_down = false;
};

// `offset` and `step` in samples.
inline Component componentIn(const YuvFormat& format, int plane, int offset, int step) {
  const int bytes = format.bits > 8 ? 2 : 1;
  return {static_cast<std::uint8_t>(plane), static_cast<std::uint8_t>(offset * bytes),
          static_cast<std::uint8_t>(step * bytes), static_cast<std::uint8_t>(format.shift),
          static_cast<std::uint8_t>(format.bits)};
}

// Bars of `width` x `height`, one memory plane after another; padding bytes have an arbitrary value.
inline Frame makeYuvFrame(int width, int height, const YuvFormat& format) {
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.model = ColorModel::Yuv;
  frame.range = format.range;
  frame.matrix = format.matrix;
  frame.chroma_shift_x = static_cast<std::uint8_t>(format.chroma_x);
  frame.chroma_shift_y = static_cast<std::uint8_t>(format.chroma_y);
  const int bytes = format.bits > 8 ? 2 : 1;
  const int chroma_width = (width + (1 << format.chroma_x) - 1) >> format.chroma_x;
  const int chroma_height = (height + (1 << format.chroma_y) - 1) >> format.chroma_y;
  auto owner = std::make_shared<std::vector<std::vector<std::uint8_t>>>();

  const auto addPlane = [&](int columns, int rows, int channels, auto&& value) {
    const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(columns) * channels * bytes + format.padding;
    auto& plane = owner->emplace_back(static_cast<std::size_t>(stride * rows), std::uint8_t{0xcd});
    for (int r = 0; r < rows; ++r) {
      std::uint8_t* out = plane.data() + stride * (format.upside_down ? rows - 1 - r : r);
      for (int i = 0; i < columns * channels; ++i) {
        const auto word = static_cast<unsigned>(std::lround(value(i / channels, i % channels))) << format.shift;
        *out++ = static_cast<std::uint8_t>(word & 0xff);
        if (bytes == 2) *out++ = static_cast<std::uint8_t>(word >> 8);
      }
    }
    frame.planes[frame.plane_count++] =
        format.upside_down ? Plane{plane.data() + stride * (rows - 1), -stride} : Plane{plane.data(), stride};
  };
  owner->reserve(3);
  const bool limited = format.range == ColorRange::Limited;
  const auto at = [&](double x, int component) {
    return yuvOf(bar(x), format.matrix, limited, format.bits)[static_cast<std::size_t>(component)];
  };
  const auto lumaAt = [&](int c) { return (c + 0.5) / width; };
  // The centre of the luma samples that share this chroma sample.
  const auto chromaAt = [&](int c) {
    const int first = c << format.chroma_x;
    return 0.5 * (first + std::min(first + (1 << format.chroma_x), width)) / width;
  };

  addPlane(width, height, 1, [&](int c, int) { return at(lumaAt(c), 0); });
  frame.components[0] = componentIn(format, 0, 0, 1);
  if (format.semi_planar) {
    addPlane(chroma_width, chroma_height, 2,
             [&](int c, int channel) { return at(chromaAt(c), (channel == 0) == format.v_first ? 2 : 1); });
    frame.components[1] = componentIn(format, 1, format.v_first ? 1 : 0, 2);
    frame.components[2] = componentIn(format, 1, format.v_first ? 0 : 1, 2);
  } else {
    for (int plane = 1; plane <= 2; ++plane) {
      addPlane(chroma_width, chroma_height, 1, [&](int c, int) { return at(chromaAt(c), plane); });
      frame.components[static_cast<std::size_t>(plane)] = componentIn(format, plane, 0, 1);
    }
  }
  frame.owner = owner;
  return frame;
}

inline void expectColor(const Image& image, int x, int y, const Rgb& wanted, int tolerance) {
  const Rgb seen = image.at(x, y);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen[c], wanted[c], tolerance) << "channel " << c << " at " << x << ", " << y;
  }
}

// The middle of each bar, near the top and near the bottom.
inline void expectBars(const Image& image, int tolerance) {
  for (int i = 0; i < 8; ++i) {
    const double middle = (i + 0.5) / 8;
    const int x = static_cast<int>(middle * image.width);
    expectColor(image, x, 6, bar(middle), tolerance);
    expectColor(image, x, image.height - 7, bar(middle), tolerance);
  }
}

inline ErrorCode refusal(Stage& stage, const Scene& scene) {
  const auto shown = stage.tryShow(scene);
  EXPECT_FALSE(shown);
  if (shown) return {};
  EXPECT_STRNE(shown.error().message, "");
  return shown.error().code;
}

}  // namespace relievo::test
