// SPDX-License-Identifier: Apache-2.0
// The colour of single samples of a picture as shares of red, green and blue.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "hal/media/samples.h"

namespace relievo {

// Black is 0 and white is 1 in every model, range and number of bits, in the primaries and transfer of the picture.
// What a range leaves room for beyond black and white, and a colour of YUV that no RGB has, lies outside of 0 to 1.
// Gray has three equal shares. The frame must outlive the reader. Any thread.
class ColorShares {
 public:
  using Shares = std::array<double, 3>;  // red, green, blue

  explicit ColorShares(const Frame& frame) noexcept : frame_(&frame), weights_(lumaWeights(frame)) {
    const bool limited = frame.model != ColorModel::Rgb && isLimited(frame);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const int bits = frame.components[i].bits;
      const bool chroma = frame.model == ColorModel::Yuv && i > 0;
      const double unit = 1U << std::max(bits - 8, 0), highest = (1U << bits) - 1;
      parts_[i].low = chroma ? 128 * unit : limited ? 16 * unit : 0;
      parts_[i].range = limited ? (chroma ? 224 : 219) * unit : highest;
    }
  }

  [[nodiscard]] Shares at(int c, int r) const noexcept {
    const double first = part(0, c, r);
    if (frame_->model == ColorModel::Gray) return {first, first, first};
    if (frame_->model == ColorModel::Rgb) return {first, part(1, c, r), part(2, c, r)};
    const int x = c >> frame_->chroma_shift_x, y = r >> frame_->chroma_shift_y;
    const auto [kr, kb] = weights_;
    const double red = first + 2 * (1 - kr) * part(2, x, y), blue = first + 2 * (1 - kb) * part(1, x, y);
    return {red, (first - kr * red - kb * blue) / (1 - kr - kb), blue};
  }

 private:
  struct Part {
    double low = 0, range = 1;  // codes of its 0, and from there to its 1
  };
  [[nodiscard]] double part(std::size_t i, int c, int r) const noexcept {
    return (codeAt(*frame_, frame_->components[i], c, r) - parts_[i].low) / parts_[i].range;
  }

  const Frame* frame_;
  LumaWeights weights_;
  std::array<Part, 3> parts_;
};

}  // namespace relievo
