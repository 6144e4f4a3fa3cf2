// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color/color_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace relievo {
namespace {

// The frame's matrix; BT.601 if it states none, whatever its size: a program that draws depth in colours mostly hands
// RGB to OpenCV or FFmpeg, which convert it so. Of a film, the reader has stated the matrix that its colours fit.
LumaWeights weightsOf(const Frame& frame) noexcept {
  return frame.matrix == ColorMatrix::Unspecified ? LumaWeights{} : lumaWeights(frame);
}

// Whether eight cells can be read side by side (color_tile.cpp).
bool isReadSideBySide(const Frame& frame) noexcept {
  const int code = frame.components[0].bits > 8 ? 2 : 1;
  const auto isApart = [&](std::size_t i, int codes) { return frame.components[i].step_bytes == codes * code; };
  const bool whole = frame.chroma_shift_x == 0 && frame.chroma_shift_y == 0 && isApart(1, 1) && isApart(2, 1);
  const bool halved = frame.chroma_shift_x == 1 && frame.chroma_shift_y == 1 && (isApart(1, 1) || isApart(1, 2)) &&
                      (isApart(2, 1) || isApart(2, 2));
  const bool bytes_hold_codes = code == 2 || frame.components[0].shift == 0;
  return std::endian::native == std::endian::little && bytes_hold_codes && isApart(0, 1) && (whole || halved);
}

// All formats whose codes are read alike have one number.
std::uint8_t formatOf(const Frame& frame) noexcept {
  if (frame.model == ColorModel::Rgb) return 0;
  const ColorMatrix matrix = frame.matrix == ColorMatrix::Unspecified ? ColorMatrix::Bt601 : frame.matrix;
  const auto number = 2 * static_cast<int>(matrix) + (frame.range == ColorRange::Full ? 1 : 0);
  return static_cast<std::uint8_t>(1 + number);
}

// Red, green and blue (0 to 1) of a frame's components, each a share of full scale.
std::array<double, 3> toRgb(const Frame& frame, const std::array<double, 3>& share) noexcept {
  if (frame.model == ColorModel::Rgb) return share;
  const bool full = frame.range == ColorRange::Full;
  const auto [kr, kb] = weightsOf(frame);
  const double y = full ? share[0] : (255 * share[0] - 16) / 219;
  const double u = full ? share[1] - 128.0 / 255 : (255 * share[1] - 128) / 224;
  const double v = full ? share[2] - 128.0 / 255 : (255 * share[2] - 128) / 224;
  const double red = y + 2 * (1 - kr) * v, blue = y + 2 * (1 - kb) * u;
  return {red, (y - kr * red - kb * blue) / (1 - kr - kb), blue};
}

}  // namespace

// The way to YUV is affine: what the three components add to it is read off at unit codes.
ColorSamples::ColorSamples(const Frame& frame) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const Component& from = frame.components[i];
    const Plane& plane = frame.planes[from.plane];
    parts_[i] = {plane.data + from.offset_bytes, plane.stride_bytes, from.step_bytes, from.shift};
  }
  const int bits = frame.components[0].bits;
  bits_ = static_cast<std::uint8_t>(bits);
  of_eight_bits_ = 1 / static_cast<float>(1U << (bits - 8));
  format_ = formatOf(frame);
  side_by_side_ = isReadSideBySide(frame);
  words_ = bits > 8;
  mask_ = (1U << bits) - 1;
  shift_x_ = frame.chroma_shift_x;
  shift_y_ = frame.chroma_shift_y;
  // More bits hold 8-bit codes times 2^(bits - 8).
  const double share_of_code = 1.0 / (255 * static_cast<double>(1U << (bits - 8)));
  const auto yuvOf = [&](const std::array<double, 3>& share) {
    const auto [red, green, blue] = toRgb(frame, share);
    const YuvColor color = toYuv(red, green, blue);
    return std::array<double, 3>{static_cast<double>(color.y), static_cast<double>(color.u),
                                 static_cast<double>(color.v)};
  };
  const auto zero = yuvOf({0, 0, 0});
  const std::array<std::array<double, 3>, 3> ones{yuvOf({1, 0, 0}), yuvOf({0, 1, 0}), yuvOf({0, 0, 1})};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 3; ++i) {
      rows_[row][i] = static_cast<float>((ones[i][row] - zero[row]) * share_of_code);
    }
    rows_[row][3] = static_cast<float>(zero[row]);
  }
}

// A luma sample is a quarter of the chroma samples' distance from the nearest one.
YuvColor ColorSamples::interpolatedAt(int c, int r, int cols, int rows) const RELIEVO_RT {
  const auto beside = [](int at, int shift, int size) {
    const int width = 1 << shift;
    return shift == 0 ? at : std::clamp((at & width >> 1) != 0 ? at + width : at - width, 0, size - 1);
  };
  const int col = beside(c, shift_x_, cols), row = beside(r, shift_y_, rows);
  const YuvColor own = at(c, r), across = at(col, r), down = at(c, row), both = at(col, row);
  const auto mean = [](float near, float side, float below, float far) {
    return (9 * near + 3 * side + 3 * below + far) / 16;
  };
  return {own.y, mean(own.u, across.u, down.u, both.u), mean(own.v, across.v, down.v, both.v)};
}

const ColorTable& ColorSamples::tableOf(DepthCode code) const {
  ColorTable::Colors colors = rows_;
  for (auto& row : colors) {
    for (std::size_t i = 0; i < 3; ++i) row[i] /= of_eight_bits_;
  }
  return relievo::tableOf(code, format_, colors);
}

double ColorSamples::step() const noexcept {
  double most = 0;
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, static_cast<double>(std::abs(row[i])));
  return most;
}

bool ColorSamples::sameChroma(const ColorSamples& other, int cols, int rows) const noexcept {
  const int across = (cols + (1 << shift_x_) - 1) >> shift_x_, down = (rows + (1 << shift_y_) - 1) >> shift_y_;
  for (const std::size_t i : {1U, 2U}) {
    const Part &a = parts_[i], &b = other.parts_[i];
    const std::size_t bytes = static_cast<std::size_t>(across - 1) * a.step_bytes + (words_ ? 2 : 1);
    for (int r = 0; r < down; ++r) {
      if (std::memcmp(a.data + r * a.stride_bytes, b.data + r * b.stride_bytes, bytes) != 0) return false;
    }
  }
  return true;
}

bool ColorSamples::readsLike(const ColorSamples& other) const noexcept {
  ColorSamples there = other;
  for (std::size_t i = 0; i < 3; ++i) {
    there.parts_[i].data = parts_[i].data;
    there.parts_[i].stride_bytes = parts_[i].stride_bytes;
  }
  return there == *this;
}

}  // namespace relievo
