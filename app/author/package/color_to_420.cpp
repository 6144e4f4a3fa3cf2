// SPDX-License-Identifier: Apache-2.0
// Converts colour sample by sample, in integer arithmetic.
#include "app/author/package/color_to_420.h"

#include <algorithm>
#include <array>

namespace relievo {
namespace {

// One component of a frame, read as hal/media/frame.h describes and reduced to 8 bits.
class Samples {
 public:
  Samples(const Frame& frame, std::size_t component) : c_(frame.components[component]), plane_(frame.planes[c_.plane]) {
    mask_ = (1 << c_.bits) - 1;
    // Limited range scales by 2^(n - 8) from 8 to n bits, full range does not: 255 corresponds to 2^n - 1.
    full_ = frame.range == ColorRange::Full || frame.model == ColorModel::Rgb;
  }

  [[nodiscard]] int at(int column, int row) const {
    const std::uint8_t* p =
        plane_.data + row * plane_.stride_bytes + c_.offset_bytes + std::ptrdiff_t{column} * c_.step_bytes;
    if (c_.bits <= 8) return (p[0] >> c_.shift) & mask_;
    const int code = ((p[0] | p[1] << 8) >> c_.shift) & mask_;
    if (full_) return (code * 255 + mask_ / 2) / mask_;
    return std::min((code + (1 << (c_.bits - 9))) >> (c_.bits - 8), 255);
  }

  [[nodiscard]] bool isPlainBytes() const { return c_.bits == 8 && c_.step_bytes == 1 && c_.shift == 0; }
  [[nodiscard]] const std::uint8_t* row(int r) const { return plane_.data + r * plane_.stride_bytes + c_.offset_bytes; }

 private:
  Component c_;
  Plane plane_;
  int mask_ = 255;
  bool full_ = true;
};

void copyPlane(const Samples& from, int width, int height, std::vector<std::uint8_t>& to) {
  auto out = to.begin();
  for (int r = 0; r < height; ++r) {
    if (from.isPlainBytes()) {
      out = std::copy_n(from.row(r), width, out);
      continue;
    }
    for (int c = 0; c < width; ++c) *out++ = static_cast<std::uint8_t>(from.at(c, r));
  }
}

// The mean of the samples that fall into each sample of 4:2:0; coarser chroma is repeated.
void copyChroma(const Samples& from, const Frame& frame, int width, int height, std::vector<std::uint8_t>& to) {
  const int fine_x = frame.chroma_shift_x == 0 ? 2 : 1, fine_y = frame.chroma_shift_y == 0 ? 2 : 1;
  const int coarse_x = std::max(frame.chroma_shift_x - 1, 0), coarse_y = std::max(frame.chroma_shift_y - 1, 0);
  if (fine_x * fine_y == 1 && coarse_x + coarse_y == 0) {
    copyPlane(from, width, height, to);
    return;
  }
  const int count = fine_x * fine_y;
  auto out = to.begin();
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      int sum = 0;
      for (int j = 0; j < fine_y; ++j) {
        for (int i = 0; i < fine_x; ++i) sum += from.at((c * fine_x + i) >> coarse_x, (r * fine_y + j) >> coarse_y);
      }
      *out++ = static_cast<std::uint8_t>((sum + count / 2) / count);
    }
  }
}

// ITU-R BT.709, limited range, coefficients times 65536: Y' = 16 + 219 (0.2126 R + 0.7152 G + 0.0722 B)/255,
// Cb = 128 + 224 (B - Y)/(1.8556 x 255), Cr = 128 + 224 (R - Y)/(1.5748 x 255).
struct Rgb {
  int r = 0, g = 0, b = 0;
};
std::uint8_t lumaOf(const Rgb& c) {
  return static_cast<std::uint8_t>((11966 * c.r + 40254 * c.g + 4064 * c.b + (16 << 16) + 32768) >> 16);
}
// From the sum of four.
std::uint8_t cbOf(const Rgb& c) {
  return static_cast<std::uint8_t>((-6596 * c.r - 22189 * c.g + 28785 * c.b + 4 * (128 << 16) + 131072) >> 18);
}
std::uint8_t crOf(const Rgb& c) {
  return static_cast<std::uint8_t>((28785 * c.r - 26145 * c.g - 2640 * c.b + 4 * (128 << 16) + 131072) >> 18);
}

void convertRgb(const Frame& frame, ColorPicture420& picture) {
  const std::array<Samples, 3> rgb{Samples(frame, 0), Samples(frame, 1), Samples(frame, 2)};
  const auto width = static_cast<std::size_t>(picture.width);
  for (int r = 0; r < picture.height; r += 2) {
    for (int c = 0; c < picture.width; c += 2) {
      Rgb sum;
      for (int i = 0; i < 4; ++i) {
        const int column = c + i % 2, row = r + i / 2;
        const Rgb pixel{rgb[0].at(column, row), rgb[1].at(column, row), rgb[2].at(column, row)};
        picture.y[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)] = lumaOf(pixel);
        sum = {sum.r + pixel.r, sum.g + pixel.g, sum.b + pixel.b};
      }
      const std::size_t at = static_cast<std::size_t>(r / 2) * (width / 2) + static_cast<std::size_t>(c / 2);
      picture.u[at] = cbOf(sum);
      picture.v[at] = crOf(sum);
    }
  }
}

}  // namespace

Result<void> toColor420(const Frame& frame, ColorPicture420& picture) {
  if (frame.width % 2 != 0 || frame.height % 2 != 0 || frame.width < 2 || frame.height < 2) {
    return fail(ErrorCode::InvalidArgument, "4:2:0 needs an even width and height; crop the picture");
  }
  picture.width = frame.width;
  picture.height = frame.height;
  picture.range = frame.range;
  picture.matrix = frame.matrix;
  const auto pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  picture.y.resize(pixels);
  picture.u.resize(pixels / 4);
  picture.v.resize(pixels / 4);
  if (frame.model == ColorModel::Rgb) {
    picture.range = ColorRange::Limited;
    picture.matrix = ColorMatrix::Bt709;
    convertRgb(frame, picture);
    return {};
  }
  copyPlane(Samples(frame, 0), frame.width, frame.height, picture.y);
  if (frame.model == ColorModel::Gray) {
    std::fill(picture.u.begin(), picture.u.end(), std::uint8_t{128});
    std::fill(picture.v.begin(), picture.v.end(), std::uint8_t{128});
    return {};
  }
  copyChroma(Samples(frame, 1), frame, frame.width / 2, frame.height / 2, picture.u);
  copyChroma(Samples(frame, 2), frame, frame.width / 2, frame.height / 2, picture.v);
  return {};
}

}  // namespace relievo
