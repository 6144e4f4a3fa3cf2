// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color_samples.h"

#include <algorithm>
#include <cstring>

namespace relievo {
namespace {

// Red, green and blue (0 to 1) of a frame's components, each a share of full scale.
std::array<double, 3> toRgb(const Frame& frame, const std::array<double, 3>& share) noexcept {
  if (frame.model == ColorModel::Rgb) return share;
  const bool full = frame.range == ColorRange::Full;
  const auto [kr, kb] = lumaWeights(frame);
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

template <bool kWords>
std::optional<YuvColor> ColorSamples::meanOf(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  const auto code = [&](const Part& part, const std::uint8_t* at) -> std::uint32_t {
    return kWords ? (at[0] | static_cast<std::uint32_t>(at[1]) << 8) >> part.shift & mask_ : at[0];
  };
  // Of an odd number, every other one has the same middle.
  const int skip_x = block.across.count % 2 == 1 ? 1 + shift_x_ : 1,
            skip_y = block.down.count % 2 == 1 ? 1 + shift_y_ : 1;
  const std::uint32_t most = (mask_ + 1) / 4;
  float mean[3] = {};
  for (std::size_t i = 2; i > 0; --i) {
    const Part& part = parts_[i];
    std::uint32_t sum = 0, count = 0, low = mask_, high = 0;
    for (int j = 0; j < block.down.count; j += skip_y) {
      const int r = r0 + block.down.first + j * block.down.step;
      const std::uint8_t* const row = part.data + (r >> shift_y_) * part.stride_bytes;
      for (int k = 0; k < block.across.count; k += skip_x, ++count) {
        const int c = c0 + block.across.first + k * block.across.step;
        const std::uint32_t here = code(part, row + static_cast<std::ptrdiff_t>(c >> shift_x_) * part.step_bytes);
        sum += here;
        low = std::min(low, here);
        high = std::max(high, here);
      }
    }
    if (high - low > most) return std::nullopt;
    mean[i] = static_cast<float>(static_cast<int>(sum)) / static_cast<float>(static_cast<int>(count));
  }
  const Part& luma = parts_[0];
  std::uint32_t sum = 0;
  for (int j = 0; j < block.down.count; ++j) {
    const std::uint8_t* at = luma.data + (r0 + block.down.first + j * block.down.step) * luma.stride_bytes +
                             static_cast<std::ptrdiff_t>(c0 + block.across.first) * luma.step_bytes;
    for (int k = 0; k < block.across.count; ++k, at += block.across.step * luma.step_bytes) sum += code(luma, at);
  }
  mean[0] = static_cast<float>(static_cast<int>(sum)) / static_cast<float>(block.across.count * block.down.count);
  return colorOf(mean[0], mean[1], mean[2]);
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

std::optional<YuvColor> ColorSamples::meanOfEvenBlock(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  return words_ ? meanOf<true>(c0, r0, block) : meanOf<false>(c0, r0, block);
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
