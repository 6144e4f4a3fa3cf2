// SPDX-License-Identifier: Apache-2.0
// The built-in film: a ball that rolls on a wall, under the finger.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/mock/mock.h"
#include "drivers/mock/mock_packet.h"

namespace relievo {
namespace {

constexpr int kWidth = 160, kHeight = 90, kFrames = 90;
constexpr double kRadius = 30;  // samples

// The ball's height over the wall, 0 to 1.
double ballAt(int frame, double col, double row) {
  const double x = col - kWidth / 2.0 - 20 * std::sin(2 * std::numbers::pi * frame / kFrames);
  const double y = row - kHeight / 2.0;
  return std::sqrt(std::max(0.0, 1 - (x * x + y * y) / (kRadius * kRadius)));
}

std::uint16_t depthAt(int frame, int /*component*/, int col, int row) {
  return static_cast<std::uint16_t>(8000 + std::lround(50000 * ballAt(frame, col, row)));
}

// Luma is brighter with height; chroma differs between ball and wall.
std::uint16_t colorAt(int frame, int component, int col, int row) {
  if (component == 0) return static_cast<std::uint16_t>(60 + std::lround(150 * ballAt(frame, col, row)));
  const bool ball = ballAt(frame, 2 * col, 2 * row) > 0;
  return static_cast<std::uint16_t>(component == 1 ? (ball ? 90 : 140) : (ball ? 180 : 120));
}

}  // namespace

MockMediaProfile mockFilm() {
  MockTrack color;
  color.width = kWidth, color.height = kHeight;
  color.frames = kFrames;
  color.model = ColorModel::Yuv;
  color.range = ColorRange::Limited;
  color.sample = colorAt;
  MockTrack depth = color;
  depth.model = ColorModel::Gray;
  depth.range = ColorRange::Full;
  depth.bits = 16;
  depth.sample = depthAt;
  depth.tags = {{"TITLE", "depth"}};
  return {.tracks = {color, depth}};
}

bool isMock(const StreamInfo& stream) noexcept {
  return stream.codec == kMockCodec && stream.native != nullptr;
}

}  // namespace relievo
