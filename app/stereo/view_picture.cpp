// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/view_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/media/samples.h"

namespace relievo {
namespace {

// From a component's codes to a byte.
class ByteScale {
 public:
  ByteScale(int bits, bool limited, bool chroma) {
    const double unit = 1 << (bits - 8);
    low_ = chroma ? 0 : limited ? 16 * unit : 0;
    middle_ = chroma ? 128 * unit : 0;
    const double reach = chroma ? (limited ? 224 * unit : 255 * unit) : limited ? 219 * unit : 256 * unit - 1;
    scale_ = 255 / reach;
    base_ = chroma ? 128 : 0;
  }
  [[nodiscard]] std::uint8_t operator()(std::uint32_t code) const noexcept {
    const double value = base_ + (code - low_ - middle_) * scale_;
    return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
  }

 private:
  double low_ = 0, middle_ = 0, scale_ = 1, base_ = 0;
};

template <class Pixel>
ViewPicture filled(const Frame& frame, Pixel&& pixel) {
  ViewPicture view(frame.width, frame.height);
  std::uint8_t* out = view.bytes.data();
  for (int r = 0; r < frame.height; ++r) {
    for (int c = 0; c < frame.width; ++c, out += 3) pixel(c, r, out);
  }
  return view;
}

ViewPicture fromRgb(const Frame& frame) {
  std::array<double, 3> to_byte{};
  for (std::size_t i = 0; i < 3; ++i) to_byte[i] = 255.0 / ((1U << frame.components[i].bits) - 1);
  return filled(frame, [&](int c, int r, std::uint8_t* out) {
    std::array<double, 3> color{};
    for (std::size_t i = 0; i < 3; ++i) color[i] = codeAt(frame, frame.components[i], c, r) * to_byte[i];
    const auto [red, green, blue] = color;
    const double luma = 0.299 * red + 0.587 * green + 0.114 * blue;
    out[0] = static_cast<std::uint8_t>(std::lround(luma));
    out[1] = static_cast<std::uint8_t>(std::clamp(128.5 + 0.564 * (blue - luma), 0.0, 255.0));
    out[2] = static_cast<std::uint8_t>(std::clamp(128.5 + 0.713 * (red - luma), 0.0, 255.0));
  });
}

}  // namespace

void lumaOf(const ViewPicture& view, std::vector<std::uint8_t>& luma) {
  luma.resize(view.size());
  for (std::size_t i = 0; i < luma.size(); ++i) luma[i] = *view.pixel(i);
}

ViewPicture readView(const Frame& frame) {
  if (frame.model == ColorModel::Rgb) return fromRgb(frame);
  const bool yuv = frame.model == ColorModel::Yuv;
  const bool limited = isLimited(frame);
  const ByteScale luma(frame.components[0].bits, limited, false);
  const ByteScale chroma(yuv ? frame.components[1].bits : 8, limited, true);
  return filled(frame, [&](int c, int r, std::uint8_t* out) {
    out[0] = luma(codeAt(frame, frame.components[0], c, r));
    for (std::size_t i = 1; i < 3; ++i) {
      out[i] =
          yuv ? chroma(codeAt(frame, frame.components[i], c >> frame.chroma_shift_x, r >> frame.chroma_shift_y)) : 128;
    }
  });
}

}  // namespace relievo
