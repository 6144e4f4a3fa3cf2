// SPDX-License-Identifier: Apache-2.0
// Reads red, green and blue of any picture.
#include "app/author/material/painted_map.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

// One component as a share of its range.
class Shares {
 public:
  Shares(const Frame& frame, const Component& component, double low, double high)
      : component_(component), plane_(frame.planes[component.plane]) {
    const double most = (1U << component.bits) - 1;
    const double of_eight_bits = component.bits >= 8 ? 1U << (component.bits - 8) : 1;
    low_ = low * of_eight_bits;
    range_ = high == 255 ? most - low_ : (high - low) * of_eight_bits;
  }
  [[nodiscard]] double at(int c, int r) const {
    const std::uint8_t* const sample = plane_.data + r * plane_.stride_bytes + component_.offset_bytes +
                                       static_cast<std::ptrdiff_t>(c) * component_.step_bytes;
    return (codeAt(component_, sample) - low_) / range_;
  }

 private:
  Component component_;
  Plane plane_;
  double low_ = 0, range_ = 255;
};

std::uint8_t codeOf(double share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

// YUV to the red, green and blue that it stands for.
class YuvShares {
 public:
  explicit YuvShares(const Frame& f)
      : weights_(lumaWeights(f)),
        limited_(f.range != ColorRange::Full),
        y_(f, f.components[0], limited_ ? 16 : 0, limited_ ? 235 : 255),
        u_(f, f.components[1], limited_ ? 16 : 0, limited_ ? 240 : 255),
        v_(f, f.components[2], limited_ ? 16 : 0, limited_ ? 240 : 255),
        shift_x_(f.chroma_shift_x),
        shift_y_(f.chroma_shift_y) {}
  [[nodiscard]] PaintedMap::Codes at(int c, int r) const {
    const double y = y_.at(c, r), middle = limited_ ? 0.5 : 128.0 / 255;
    const double u = u_.at(c >> shift_x_, r >> shift_y_) - middle, v = v_.at(c >> shift_x_, r >> shift_y_) - middle;
    const double red = y + 2 * (1 - weights_.red) * v, blue = y + 2 * (1 - weights_.blue) * u;
    const double green = (y - weights_.red * red - weights_.blue * blue) / (1 - weights_.red - weights_.blue);
    return {codeOf(red), codeOf(green), codeOf(blue)};
  }

 private:
  LumaWeights weights_;
  bool limited_;
  Shares y_, u_, v_;
  int shift_x_, shift_y_;
};

template <class Read>
void fill(PaintedMap& map, const Frame& picture, Read&& read) {
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      const int x = (2 * c + 1) * picture.width / (2 * map.cols), y = (2 * r + 1) * picture.height / (2 * map.rows);
      map.codes.push_back(read(x, y));
      map.painted.push_back(!picture.alpha || Shares(picture, *picture.alpha, 0, 255).at(x, y) >= 0.5);
    }
  }
}

}  // namespace

PaintedMap readMap(const Frame& picture, int cols, int rows) {
  PaintedMap map{.cols = cols, .rows = rows, .codes = {}, .painted = {}};
  if (picture.model == ColorModel::Yuv) {
    fill(map, picture, [yuv = YuvShares(picture)](int x, int y) { return yuv.at(x, y); });
    return map;
  }
  const bool gray = picture.model == ColorModel::Gray, limited = gray && picture.range == ColorRange::Limited;
  const auto part = [&](std::size_t k) {
    return Shares(picture, picture.components[k], limited ? 16 : 0, limited ? 235 : 255);
  };
  if (gray) {
    fill(map, picture,
         [stiffness = part(0)](int x, int y) { return PaintedMap::Codes{codeOf(stiffness.at(x, y)), 0, 0}; });
    return map;
  }
  fill(map, picture, [red = part(0), green = part(1), blue = part(2)](int x, int y) {
    return PaintedMap::Codes{codeOf(red.at(x, y)), codeOf(green.at(x, y)), codeOf(blue.at(x, y))};
  });
  return map;
}

}  // namespace relievo
