// SPDX-License-Identifier: Apache-2.0
// Each pixel is the mean of a few samples of its part of the frame.
#include "app/player/browse/poster.h"

#include <algorithm>
#include <cmath>

#include "app/media/reading/picture_look.h"
#include "app/scene/sdr_color.h"

namespace relievo {
namespace {

constexpr int kTaps = 3;  // samples across and down a pixel

glm::dvec3 meanOf(const Frame& frame, int x, int y, int cols, int rows) noexcept {
  glm::dvec3 sum(0);
  for (int j = 0; j < kTaps; ++j) {
    const auto r = static_cast<int>((y + (j + 0.5) / kTaps) * frame.height / rows);
    for (int i = 0; i < kTaps; ++i) {
      const auto c = static_cast<int>((x + (i + 0.5) / kTaps) * frame.width / cols);
      const PictureColor color = colorAt(frame, std::min(c, frame.width - 1), std::min(r, frame.height - 1));
      sum += glm::dvec3(color.red, color.green, color.blue);
    }
  }
  constexpr double kShare = 1.0 / (kTaps * kTaps);
  return sum * kShare;
}

std::uint8_t byteOf(double share) noexcept {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

TextPicture posterOf(const Frame& frame) {
  TextPicture poster;
  if (frame.empty() || frame.width < 1 || frame.height < 1) return poster;
  const double width = frame.width * std::max(frame.sample_aspect, 1e-3);
  const double scale = std::min(Poster::kMostCols / width, static_cast<double>(Poster::kMostRows) / frame.height);
  poster.cols = poster.width = std::clamp(static_cast<int>(std::lround(width * scale)), 1, Poster::kMostCols);
  poster.rows = poster.height = std::clamp(static_cast<int>(std::lround(frame.height * scale)), 1, Poster::kMostRows);
  poster.rgba.reserve(std::size_t{4} * static_cast<std::size_t>(poster.cols) * static_cast<std::size_t>(poster.rows));
  for (int y = 0; y < poster.rows; ++y) {
    for (int x = 0; x < poster.cols; ++x) {
      const glm::dvec3 color = asSdr(meanOf(frame, x, y, poster.cols, poster.rows), frame.transfer, frame.primaries);
      poster.rgba.insert(poster.rgba.end(), {byteOf(color.r), byteOf(color.g), byteOf(color.b), 255});
    }
  }
  return poster;
}

}  // namespace relievo
