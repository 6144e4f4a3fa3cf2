// SPDX-License-Identifier: Apache-2.0
// Drawn pictures, and how far one is from what it should be: PSNR, and the structural similarity of Wang et al.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace relievo {

// 8 bits a channel; row 0 is the top one. Alpha is ignored.
struct DrawnPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

// Each pixel is the mean of `factor` x `factor`; the sides are multiples of that.
[[nodiscard]] DrawnPicture averagedDown(const DrawnPicture& picture, int factor);

// Pixel by pixel, row by row.
struct PictureDifference {
  std::vector<float> squared;     // mean of the squared differences of R, G and B
  std::vector<float> similarity;  // SSIM of the window around it; not a number where the window leaves the picture
};

// Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image quality assessment: from error visibility to structural
// similarity", IEEE Trans. Image Processing 13 (2004), equation 13, with what section III-C says: luma (here of
// BT.709), a Gaussian window of 11 x 11 with a standard deviation of 1.5, K1 = 0.01, K2 = 0.03, L = 255. Two pictures
// of one size.
[[nodiscard]] PictureDifference differenceOf(const DrawnPicture& picture, const DrawnPicture& reference);

// Over the pixels of any number of pictures.
class PictureError {
 public:
  // Pixels where `counted` is 0 are left out; it is as long as the picture has pixels.
  void add(const PictureDifference& difference, std::span<const std::uint8_t> counted);

  [[nodiscard]] double psnrDb() const;      // infinite if all pixels are equal
  [[nodiscard]] double similarity() const;  // the mean SSIM: 1 for the same pictures
  [[nodiscard]] std::size_t pixels() const { return pixels_; }

 private:
  double squared_ = 0, similarity_ = 0;
  std::size_t pixels_ = 0, windows_ = 0;
};

}  // namespace relievo
