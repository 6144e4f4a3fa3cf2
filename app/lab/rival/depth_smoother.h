// SPDX-License-Identifier: Apache-2.0
// A Gaussian blur of whole depth pictures, optimised as by someone who smooths every frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/scene/display_volume.h"
#include "app/scene/height_field.h"

namespace relievo {

// Blurs pictures of one size and reuses its memory between them.
//
// - The kernel is separable, a Gaussian of `sigma_mm` in both directions, cut off at 3.5 standard deviations. Where a
//   standard deviation spans six samples or more, the mean of a block of samples is taken first, so that three samples
//   or more are left in it; the kernel is the narrower by the block's own variance. So a fine picture costs little more
//   than reading it. The picture that comes out is the smaller by whole factors; it covers the same volume.
// - Of the third order the kernel is 2 g - g * g (twicing). It leaves parabolas as they are, in either direction; a
//   Gaussian g flattens them.
// - Holes do not affect heights: the mean is over the samples that are not holes (normalised convolution). If these
//   have less than half of the weight, the result is a hole, as in HeightField::meanHeight.
// - Beyond the border the outermost samples are repeated.
class DepthSmoother {
 public:
  enum class Order : std::uint8_t { First, Third };
  DepthSmoother(const HeightField& like, double sigma_mm, Order order = Order::First);

  [[nodiscard]] int cols() const { return across_.size; }
  [[nodiscard]] int rows() const { return down_.size; }

  // Writes codes of 16 bits over the volume's depth, near high; `kHole` at holes only. `field` has the size of `like`,
  // `out` holds cols x rows. Returns whether there is a hole.
  static constexpr std::uint16_t kHole = 0;
  bool smooth(const HeightField& field, std::span<std::uint16_t> out);

  // The samples at the same distance before and after the kernel's centre.
  struct Pair {
    const float *before, *after;
  };

 private:
  // One direction: how many samples are averaged into one, how many remain, and the kernel from its centre outwards.
  struct Axis {
    Axis(int samples, double pitch_mm, double sigma_mm, Order order);
    int factor = 1, size = 0;
    std::vector<float> taps;
    [[nodiscard]] int radius() const { return static_cast<int>(taps.size()) - 1; }
  };
  bool readLine(const HeightField& field, int row);
  void addBlocks(std::vector<float>& line) const;
  void blurAcross(std::vector<float>& line, float* out);
  void blurDown(const std::vector<float>& picture, int row, float* out);
  [[nodiscard]] bool holesNear(int row) const;

  Axis across_, down_;
  std::size_t stride_;                             // of the blurred lines, in floats
  std::vector<int> columns_;                       // of the samples of a line
  std::vector<float> samples_, has_height_;        // of the rows that make a line; 1 or 0
  std::vector<float> heights_, shares_;            // means over blocks of the two above, with a border at both ends
  std::vector<float> height_lines_, share_lines_;  // blurred across
  std::vector<float> height_out_, share_out_;      // one line, blurred down as well
  std::vector<std::uint8_t> holed_;                // lines whose shares are not all 1
  std::vector<Pair> pairs_;
};

}  // namespace relievo
