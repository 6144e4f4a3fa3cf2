// SPDX-License-Identifier: Apache-2.0
// The colours of a picture in the decoder's memory, in the coordinates of a ColorCurve.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "app/scene/color_curve.h"
#include "app/scene/sampled_block.h"
#include "hal/media/frame.h"
#include "platform/realtime.h"

namespace relievo {

// Trivially copyable. Does not own the samples.
class ColorSamples {
 public:
  ColorSamples() = default;
  // `frame` is YUV or RGB.
  explicit ColorSamples(const Frame& frame) noexcept;

  [[nodiscard]] YuvColor at(int c, int r) const RELIEVO_RT {
    const float first = codeAt(0, c, r);
    const float second = codeAt(1, c >> shift_x_, r >> shift_y_), third = codeAt(2, c >> shift_x_, r >> shift_y_);
    return colorOf(first, second, third);
  }
  // The colours of four samples of a row.
  [[nodiscard]] ColorCurve::FourColors ofFour(const int* columns, int r) const RELIEVO_RT {
    ColorCurve::Four first, second, third;
    for (int i = 0; i < 4; ++i) {
      first[i] = codeAt(0, columns[i], r);
      second[i] = codeAt(1, columns[i] >> shift_x_, r >> shift_y_);
      third[i] = codeAt(2, columns[i] >> shift_x_, r >> shift_y_);
    }
    const auto part = [&](const std::array<float, 4>& row) {
      return row[0] * first + row[1] * second + row[2] * third + row[3];
    };
    return {part(rows_[0]), part(rows_[1]), part(rows_[2])};
  }
  // The colour of (c, r) with chroma interpolated to its place, from the four chroma samples around it. `cols` and
  // `rows`: of the picture.
  [[nodiscard]] YuvColor interpolatedAt(int c, int r, int cols, int rows) const RELIEVO_RT;
  // The mean colour of the block's samples, and by how much their chroma differs; false, and none, if the second or
  // third component varies by more than a quarter of full scale. (An optional would be put together in memory, which
  // costs more than reading a small block.)
  struct Even {
    YuvColor mean;
    float chroma = 0;
  };
  [[nodiscard]] bool meanOfEvenBlock(int c0, int r0, const SampledBlock& block, Even& even) const RELIEVO_RT;
  // What one code changes in the colour.
  [[nodiscard]] double step() const noexcept;
  // Whether the second and third components of two pictures of the same format and size are equal.
  [[nodiscard]] bool sameChroma(const ColorSamples& other, int cols, int rows) const noexcept;
  // Whether the other picture has the same format, wherever it lies.
  [[nodiscard]] bool readsLike(const ColorSamples& other) const noexcept;
  bool operator==(const ColorSamples&) const = default;

 private:
  struct Part {
    const std::uint8_t* data = nullptr;
    std::ptrdiff_t stride_bytes = 0;
    std::uint8_t step_bytes = 1, shift = 0;
    bool operator==(const Part&) const = default;
  };
  [[nodiscard]] YuvColor colorOf(float first, float second, float third) const RELIEVO_RT {
    const auto part = [&](const std::array<float, 4>& row) {
      return row[0] * first + row[1] * second + row[2] * third + row[3];
    };
    return {part(rows_[0]), part(rows_[1]), part(rows_[2])};
  }
  template <bool kWords>
  [[nodiscard]] bool meanOf(int c0, int r0, const SampledBlock& block, Even& even) const RELIEVO_RT;
  template <class Spread>
  int addOneByOne(int c0, int r0, const SampledBlock& block, Spread& u, Spread& v) const RELIEVO_RT;
  [[nodiscard]] float codeAt(std::size_t part, int c, int r) const RELIEVO_RT {
    const Part& p = parts_[part];
    const std::uint8_t* at = p.data + r * p.stride_bytes + static_cast<std::ptrdiff_t>(c) * p.step_bytes;
    const std::uint32_t word = words_ ? at[0] | static_cast<std::uint32_t>(at[1]) << 8 : at[0];
    return static_cast<float>(static_cast<int>(word >> p.shift & mask_));
  }

  std::array<Part, 3> parts_{};
  std::array<std::array<float, 4>, 3> rows_{};  // to y, u, v: factors of the three codes, and what is added
  std::uint32_t mask_ = 0xff;
  std::uint8_t shift_x_ = 0, shift_y_ = 0;
  bool words_ = false;
};

}  // namespace relievo
