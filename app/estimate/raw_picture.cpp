// SPDX-License-Identifier: Apache-2.0
#include "app/estimate/raw_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relievo {
namespace {

// A component's samples as shares of full scale: luma and colours 0 to 1, chroma -0.5 to 0.5.
class Part {
 public:
  Part(const Frame& frame, std::size_t component, bool chroma) : c_(frame.components[component]) {
    plane_ = frame.planes[c_.plane];
    const bool limited =
        frame.model != ColorModel::Rgb && (frame.range == ColorRange::Limited ||
                                           (frame.model == ColorModel::Yuv && frame.range == ColorRange::Unspecified));
    const auto unit = static_cast<float>(1U << std::max(c_.bits - 8, 0));
    const auto highest = static_cast<float>((1U << c_.bits) - 1);
    low_ = chroma ? 128 * unit : limited ? 16 * unit : 0;
    scale_ = 1 / (limited ? (chroma ? 224 : 219) * unit : highest);
  }
  [[nodiscard]] float at(int c, int r) const noexcept {
    const std::uint8_t* const sample =
        plane_.data + r * plane_.stride_bytes + c_.offset_bytes + std::ptrdiff_t{c} * c_.step_bytes;
    return (static_cast<float>(codeAt(c_, sample)) - low_) * scale_;
  }

 private:
  Component c_;
  Plane plane_;
  float low_ = 0, scale_ = 1;
};

std::uint8_t byteOf(float share) noexcept {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0F, 1.0F)));
}

template <class Pixel>
RawPicture filled(const Frame& frame, Pixel&& pixel) {
  RawPicture picture(frame.width, frame.height);
  std::uint8_t* out = picture.bytes.data();
  for (int r = 0; r < frame.height; ++r) {
    for (int c = 0; c < frame.width; ++c) {
      for (const float share : pixel(c, r)) *out++ = byteOf(share);
    }
  }
  return picture;
}

}  // namespace

RawPicture rawOf(const Frame& frame) {
  using Color = std::array<float, 3>;
  const Part first(frame, 0, false);
  if (frame.model == ColorModel::Gray) {
    return filled(frame, [&](int c, int r) { return Color{first.at(c, r), first.at(c, r), first.at(c, r)}; });
  }
  const bool yuv = frame.model == ColorModel::Yuv;
  const Part second(frame, 1, yuv), third(frame, 2, yuv);
  if (!yuv) return filled(frame, [&](int c, int r) { return Color{first.at(c, r), second.at(c, r), third.at(c, r)}; });
  const auto [kr, kb] = lumaWeights(frame);
  const auto of_v = static_cast<float>(2 * (1 - kr)), of_u = static_cast<float>(2 * (1 - kb));
  const auto red_share = static_cast<float>(kr / (1 - kr - kb)), blue_share = static_cast<float>(kb / (1 - kr - kb));
  return filled(frame, [&](int c, int r) {
    const int x = c >> frame.chroma_shift_x, y = r >> frame.chroma_shift_y;
    const float luma = first.at(c, r), red = of_v * third.at(x, y), blue = of_u * second.at(x, y);
    return Color{luma + red, luma - red_share * red - blue_share * blue, luma + blue};
  });
}

}  // namespace relievo
