// SPDX-License-Identifier: Apache-2.0
// The window is a product of two, along the rows and down the columns: means of all places at once.
#include "app/lab/detail/picture_quality.h"

#include <array>
#include <cmath>
#include <limits>

namespace relievo {
namespace {

constexpr int kTaps = 11, kReach = kTaps / 2;
constexpr double kSigma = 1.5;
constexpr float kPeak = 255, kC1 = (0.01F * kPeak) * (0.01F * kPeak), kC2 = (0.03F * kPeak) * (0.03F * kPeak);

using Plane = std::vector<float>;

std::array<float, kTaps> gaussian() {
  std::array<double, kTaps> weights{};
  double sum = 0;
  for (int k = 0; k < kTaps; ++k) {
    const double away = (k - kReach) / kSigma;
    sum += weights[k] = std::exp(-0.5 * away * away);
  }
  std::array<float, kTaps> normal{};
  for (int k = 0; k < kTaps; ++k) normal[k] = static_cast<float>(weights[k] / sum);
  return normal;
}

Plane lumaOf(const DrawnPicture& picture) {
  Plane luma(picture.rgba.size() / 4);
  const std::uint8_t* rgba = picture.rgba.data();
  for (std::size_t i = 0; i < luma.size(); ++i, rgba += 4) {
    luma[i] = 0.2126F * static_cast<float>(rgba[0]) + 0.7152F * static_cast<float>(rgba[1]) +
              0.0722F * static_cast<float>(rgba[2]);
  }
  return luma;
}

// out[i] = sum of weights[k] in[i + k step]; the sums lie at the window's first corner.
void weigh(const Plane& in, std::size_t step, const std::array<float, kTaps>& weights, Plane& out) {
  const std::size_t count = in.size() - (kTaps - 1) * step;
  for (std::size_t i = 0; i < count; ++i) out[i] = weights[0] * in[i];
  for (std::size_t k = 1; k < kTaps; ++k) {
    const float* shifted = in.data() + k * step;
    for (std::size_t i = 0; i < count; ++i) out[i] += weights[k] * shifted[i];
  }
}

// The mean of a product of two planes in the window whose first corner is the pixel.
class WindowMeans {
 public:
  explicit WindowMeans(int width) : width_(width) {}
  template <class Value>
  [[nodiscard]] Plane operator()(std::size_t size, Value&& value) {
    product_.resize(size);
    across_.assign(size, 0);
    for (std::size_t i = 0; i < size; ++i) product_[i] = value(i);
    weigh(product_, 1, weights_, across_);
    Plane mean(size);
    weigh(across_, static_cast<std::size_t>(width_), weights_, mean);
    return mean;
  }

 private:
  int width_;
  std::array<float, kTaps> weights_ = gaussian();
  Plane product_, across_;
};

}  // namespace

DrawnPicture averagedDown(const DrawnPicture& picture, int factor) {
  DrawnPicture small{picture.width / factor, picture.height / factor, {}};
  small.rgba.reserve(static_cast<std::size_t>(small.width) * small.height * 4);
  const std::size_t row_bytes = static_cast<std::size_t>(picture.width) * 4;
  const int share = factor * factor;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      const std::uint8_t* corner = picture.rgba.data() + static_cast<std::size_t>(y) * factor * row_bytes +
                                   static_cast<std::size_t>(x) * factor * 4;
      for (int c = 0; c < 4; ++c) {
        int sum = 0;
        for (int j = 0; j < factor; ++j) {
          for (int i = 0; i < factor; ++i) sum += corner[static_cast<std::size_t>(j) * row_bytes + 4 * i + c];
        }
        small.rgba.push_back(static_cast<std::uint8_t>((sum + share / 2) / share));
      }
    }
  }
  return small;
}

PictureDifference differenceOf(const DrawnPicture& picture, const DrawnPicture& reference) {
  const std::size_t size = reference.rgba.size() / 4;
  PictureDifference result{Plane(size), Plane(size, std::numeric_limits<float>::quiet_NaN())};
  for (std::size_t i = 0; i < size; ++i) {
    float sum = 0;
    for (std::size_t c = 4 * i; c < 4 * i + 3; ++c) {
      const auto off = static_cast<float>(picture.rgba[c] - reference.rgba[c]);
      sum += off * off;
    }
    result.squared[i] = sum / 3;
  }
  if (reference.width < kTaps || reference.height < kTaps) return result;

  const Plane x = lumaOf(picture), y = lumaOf(reference);
  WindowMeans means(reference.width);
  const Plane mean_x = means(size, [&](std::size_t i) { return x[i]; });
  const Plane mean_y = means(size, [&](std::size_t i) { return y[i]; });
  const Plane square_x = means(size, [&](std::size_t i) { return x[i] * x[i]; });
  const Plane square_y = means(size, [&](std::size_t i) { return y[i] * y[i]; });
  const Plane product = means(size, [&](std::size_t i) { return x[i] * y[i]; });
  const auto width = static_cast<std::size_t>(reference.width);
  for (int r = 0; r + kTaps <= reference.height; ++r) {
    const std::size_t row = static_cast<std::size_t>(r) * width;
    for (std::size_t i = row; i < row + width - (kTaps - 1); ++i) {
      const float xx = mean_x[i] * mean_x[i], yy = mean_y[i] * mean_y[i], xy = mean_x[i] * mean_y[i];
      const float luminance = (2 * xy + kC1) / (xx + yy + kC1);
      const float structure = (2 * (product[i] - xy) + kC2) / (square_x[i] - xx + square_y[i] - yy + kC2);
      result.similarity[i + kReach * (width + 1)] = luminance * structure;
    }
  }
  return result;
}

void PictureError::add(const PictureDifference& difference, std::span<const std::uint8_t> counted) {
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (counted[i] == 0) continue;
    squared_ += static_cast<double>(difference.squared[i]);
    ++pixels_;
    if (std::isnan(difference.similarity[i])) continue;
    similarity_ += static_cast<double>(difference.similarity[i]);
    ++windows_;
  }
}

double PictureError::psnrDb() const {
  return 10 *
         std::log10(static_cast<double>(kPeak) * static_cast<double>(kPeak) * static_cast<double>(pixels_) / squared_);
}

double PictureError::similarity() const {
  return similarity_ / static_cast<double>(windows_);
}

}  // namespace relievo
