// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color/color_shares.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace relievo {
namespace {

// One sample of three parts, each of two bytes.
class Sample {
 public:
  Sample(ColorModel model, ColorRange range, int bits, std::array<int, 3> codes) {
    frame_.width = frame_.height = 1;
    frame_.model = model;
    frame_.range = range;
    frame_.plane_count = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      bytes_[2 * i] = static_cast<std::uint8_t>(codes[i]);
      bytes_[2 * i + 1] = static_cast<std::uint8_t>(codes[i] >> 8);
      frame_.components[i] = {.offset_bytes = static_cast<std::uint8_t>(2 * i), .step_bytes = 6};
      frame_.components[i].bits = static_cast<std::uint8_t>(bits);
    }
    frame_.planes[0] = {bytes_.data(), 6};
  }
  void expect(double red, double green, double blue, double error = 1e-12) const {
    const auto shares = ColorShares(frame_).at(0, 0);
    EXPECT_NEAR(shares[0], red, error);
    EXPECT_NEAR(shares[1], green, error);
    EXPECT_NEAR(shares[2], blue, error);
  }

 private:
  std::array<std::uint8_t, 6> bytes_{};
  Frame frame_;
};

// ITU-R BT.709-6, 3.4: limited codes of n bits are those of 8 bits times 2^(n - 8).
TEST(ColorShares, WhiteIsOneAndBlackIsZeroAtAnyNumberOfBits) {
  for (const int bits : {8, 10, 12}) {
    const int unit = 1 << (bits - 8), most = (1 << bits) - 1, middle = 128 * unit;
    Sample(ColorModel::Yuv, ColorRange::Unspecified, bits, {235 * unit, middle, middle}).expect(1, 1, 1);
    Sample(ColorModel::Yuv, ColorRange::Limited, bits, {16 * unit, middle, middle}).expect(0, 0, 0);
    Sample(ColorModel::Yuv, ColorRange::Full, bits, {most, middle, middle}).expect(1, 1, 1);
    Sample(ColorModel::Rgb, ColorRange::Limited, bits, {most, 0, most}).expect(1, 0, 1);
    Sample(ColorModel::Gray, ColorRange::Unspecified, bits, {most, 0, 0}).expect(1, 1, 1);
    Sample(ColorModel::Gray, ColorRange::Limited, bits, {16 * unit, 0, 0}).expect(0, 0, 0);
  }
}

// BT.601 by its definition: Y = .299 R + .587 G + .114 B, Cr = .5 (R - Y)/(1 - .299).
TEST(ColorShares, ARedThatIsCodedComesBack) {
  const double y = 0.299, cb = -0.5 * y / (1 - 0.114), cr = 0.5;
  // 12 bits: the codes are rounded by less than .5/3504.
  const auto code = [](double share, double range, double zero) {
    return static_cast<int>(share * range + zero + 0.5);
  };
  const Sample red(ColorModel::Yuv, ColorRange::Limited, 12,
                   {code(y, 3504, 256), code(cb, 3584, 2048), code(cr, 3584, 2048)});
  red.expect(1, 0, 0, 1e-3);
}

}  // namespace
}  // namespace relievo
