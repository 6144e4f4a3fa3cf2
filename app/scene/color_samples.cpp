// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color_samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "app/scene/code_sums.h"

namespace relievo {
namespace {

// The frame's matrix; BT.601 if it states none, whatever its size: a program that draws depth in colours mostly hands
// RGB to OpenCV or FFmpeg, which convert it so. Of a film, the reader has stated the matrix that its colours fit.
LumaWeights weightsOf(const Frame& frame) noexcept {
  return frame.matrix == ColorMatrix::Unspecified ? LumaWeights{} : lumaWeights(frame);
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

// Evenly spaced columns or rows of a component, each of weight 2, but for those at the ends of which a block covers
// half.
struct Run {
  int first = 0, step = 1, count = 0;
  std::uint32_t half_first = 0, half_last = 0;  // 1 if so

  [[nodiscard]] int weight() const RELIEVO_RT { return 2 * count - static_cast<int>(half_first + half_last); }
};

// The run whose mean is that of a block's samples; none (count 0) if they fall on a subsampled component at uneven
// steps. Of an odd number of samples farther apart, every other one has the same middle.
Run runOf(int origin, const SampledBlock::Places& places, int shift) RELIEVO_RT {
  const int first = origin + places.first;
  if (shift == 0) return {.first = first, .step = places.step, .count = places.count};
  if (shift > 1) return {};
  if (places.step == 1) {
    const int last = first + places.count - 1, count = (last >> 1) - (first >> 1) + 1;
    const auto odd = [](int at) { return static_cast<std::uint32_t>(at & 1); };
    return {.first = first >> 1, .count = count, .half_first = odd(first), .half_last = 1 - odd(last)};
  }
  if ((places.count & 1) == 0) return {};
  return {.first = first >> 1, .step = places.step, .count = (places.count + 1) >> 1};
}

// The weighted sum, the least and the greatest of the codes added.
template <bool kWords>
struct Spread {
  std::uint32_t mask, sum = 0, low = ~0U, high = 0;
  std::uint8_t shift;

  // kAcross 0: the width is known only at run time.
  template <int kAcross>
  void addRows(const CodeBlock& codes, const Run& columns, const Run& rows) RELIEVO_RT {
    const int across = kAcross > 0 ? kAcross : codes.across;
    const auto codeAt = [this](const std::uint8_t* at) -> std::uint32_t {
      return kWords ? (at[0] | static_cast<std::uint32_t>(at[1]) << 8) >> shift & mask : at[0];
    };
    const std::uint8_t* row = codes.first;
    for (int j = 0; j < codes.down; ++j, row += codes.stride_bytes) {
      std::uint32_t in_row = 0;
      for (int k = 0; k < across; ++k) {
        const std::uint32_t code = codeAt(row + k * codes.step_bytes);
        in_row += code;
        low = std::min(low, code);
        high = std::max(high, code);
      }
      in_row = 2 * in_row - columns.half_first * codeAt(row) -
               columns.half_last * codeAt(row + (across - 1) * codes.step_bytes);
      sum += (2 - (j == 0 ? rows.half_first : 0) - (j == codes.down - 1 ? rows.half_last : 0)) * in_row;
    }
  }
  void add(const CodeBlock& codes, const Run& columns, const Run& rows) RELIEVO_RT {
    switch (codes.across) {  // a width known at compile time takes fewer instructions
      case 1:
        return addRows<1>(codes, columns, rows);
      case 2:
        return addRows<2>(codes, columns, rows);
      case 3:
        return addRows<3>(codes, columns, rows);
      default:
        return addRows<0>(codes, columns, rows);
    }
  }
};

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

// Adds the chroma of a block whose samples fall on it at uneven steps. Returns their weight.
template <class Spread>
[[gnu::noinline]] int ColorSamples::addOneByOne(int c0, int r0, const SampledBlock& block, Spread& u,
                                                Spread& v) const RELIEVO_RT {
  const int skip_x = block.across.count % 2 == 1 ? 1 + shift_x_ : 1,
            skip_y = block.down.count % 2 == 1 ? 1 + shift_y_ : 1;
  int count = 0;
  for (int j = 0; j < block.down.count; j += skip_y) {
    const int r = (r0 + block.down.first + j * block.down.step) >> shift_y_;
    for (int k = 0; k < block.across.count; k += skip_x, ++count) {
      const int c = (c0 + block.across.first + k * block.across.step) >> shift_x_;
      const auto codeOf = [&](const Part& part) -> CodeBlock {
        return {.first = part.data + r * part.stride_bytes + static_cast<std::ptrdiff_t>(c) * part.step_bytes};
      };
      u.add(codeOf(parts_[1]), {.count = 1}, {.count = 1});
      v.add(codeOf(parts_[2]), {.count = 1}, {.count = 1});
    }
  }
  return 4 * count;
}

template <bool kWords>
bool ColorSamples::meanOf(int c0, int r0, const SampledBlock& block, Even& even) const RELIEVO_RT {
  const auto codesOf = [](const Part& part, const Run& across, const Run& down) -> CodeBlock {
    return {.first = part.data + down.first * part.stride_bytes +
                     static_cast<std::ptrdiff_t>(across.first) * part.step_bytes,
            .step_bytes = static_cast<std::ptrdiff_t>(across.step) * part.step_bytes,
            .stride_bytes = down.step * part.stride_bytes,
            .across = across.count,
            .down = down.count};
  };
  const Part &luma = parts_[0], &u = parts_[1], &v = parts_[2];
  Spread<kWords> of_u{.mask = mask_, .shift = u.shift}, of_v{.mask = mask_, .shift = v.shift};
  const Run columns = runOf(c0, block.across, shift_x_), rows = runOf(r0, block.down, shift_y_);
  int weight = columns.weight() * rows.weight();
  if (weight > 0) {
    of_u.add(codesOf(u, columns, rows), columns, rows);
    of_v.add(codesOf(v, columns, rows), columns, rows);
  } else {
    weight = addOneByOne(c0, r0, block, of_u, of_v);
  }
  const std::uint32_t spread_u = of_u.high - of_u.low, spread_v = of_v.high - of_v.low;
  if (std::max(spread_u, spread_v) > (mask_ + 1) / 4) return false;
  const Run luma_columns = runOf(c0, block.across, 0), luma_rows = runOf(r0, block.down, 0);
  const CodeBlock all = codesOf(luma, luma_columns, luma_rows);
  Spread<kWords> of_luma{.mask = mask_, .shift = luma.shift};
  if (kWords) {
    of_luma.add(all, luma_columns, luma_rows);
  } else {
    of_luma.sum = 4 * sumOfBytes(all);
  }
  const auto mean = [](std::uint32_t sum, int codes) {
    return static_cast<float>(static_cast<int>(sum)) / static_cast<float>(codes);
  };
  even.mean = colorOf(mean(of_luma.sum, luma_columns.weight() * luma_rows.weight()), mean(of_u.sum, weight),
                      mean(of_v.sum, weight));
  const auto by = [&](std::size_t row) {
    return std::abs(rows_[row][1]) * static_cast<float>(static_cast<int>(spread_u)) +
           std::abs(rows_[row][2]) * static_cast<float>(static_cast<int>(spread_v));
  };
  even.chroma = std::sqrt(by(1) * by(1) + by(2) * by(2));
  return true;
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

bool ColorSamples::meanOfEvenBlock(int c0, int r0, const SampledBlock& block, Even& even) const RELIEVO_RT {
  const auto &across = block.across, &down = block.down;
  const int c = c0 + across.first, r = r0 + down.first;
  const int past_c = c + (across.count - 1) * across.step, past_r = r + (down.count - 1) * down.step;
  const int chroma_c = c >> shift_x_, chroma_r = r >> shift_y_;
  if (past_c >> shift_x_ == chroma_c && past_r >> shift_y_ == chroma_r) {  // all share one chroma sample
    float luma = 0;
    for (int at_r = r; at_r <= past_r; at_r += down.step) {
      for (int at_c = c; at_c <= past_c; at_c += across.step) luma += codeAt(0, at_c, at_r);
    }
    const auto count = static_cast<float>(across.count * down.count);
    even = {colorOf(luma / count, codeAt(1, chroma_c, chroma_r), codeAt(2, chroma_c, chroma_r)), 0};
    return true;
  }
  return words_ ? meanOf<true>(c0, r0, block, even) : meanOf<false>(c0, r0, block, even);
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
