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

// A point of the ball: its place from the middle and its height over the wall, in radii. The height is 0 beside the
// ball.
struct BallPoint {
  double right = 0, down = 0, height = 0;
};
BallPoint ballAt(int frame, double col, double row) {
  const double x = (col - kWidth / 2.0 - 20 * std::sin(2 * std::numbers::pi * frame / kFrames)) / kRadius;
  const double y = (row - kHeight / 2.0) / kRadius;
  return {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
}

std::uint16_t depthAt(int frame, int /*component*/, int col, int row) {
  return static_cast<std::uint16_t>(8000 + std::lround(50000 * ballAt(frame, col, row).height));
}

// The ball is lit from the upper left and has no texture of its own; chroma differs between ball and wall.
std::uint16_t colorAt(int frame, int component, int col, int row) {
  if (component == 0) {
    const BallPoint point = ballAt(frame, col, row);
    const double light = point.height > 0 ? -0.6 * point.right - 0.6 * point.down + 0.53 * point.height : 0;
    return static_cast<std::uint16_t>(60 + std::lround(150 * std::max(0.0, light)));
  }
  const bool ball = ballAt(frame, 2 * col, 2 * row).height > 0;
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
  depth.tags = {{"TITLE", "depth"}, {"DEPTH_LAW", "linear"}, {"DEPTH_POLARITY", "near-high"}};
  return {.tracks = {color, depth}};
}

bool isMock(const StreamInfo& stream) noexcept {
  return stream.codec == kMockCodec && stream.native != nullptr;
}

}  // namespace relievo
