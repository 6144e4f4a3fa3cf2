// SPDX-License-Identifier: Apache-2.0
// A scene of textured boards as two eyes see it, with the exact disparity of every point of the left view.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "hal/media/frame.h"

namespace relievo::test {

// Smooth noise around 0, a hash on each point of a lattice.
inline double smoothNoise(double x, double y, std::uint32_t seed) {
  const auto hash = [seed](std::int64_t i, std::int64_t j) {
    auto h =
        static_cast<std::uint32_t>(i) * 0x9E3779B1U ^ static_cast<std::uint32_t>(j) * 0x85EBCA77U ^ seed * 0xC2B2AE3DU;
    h = (h ^ h >> 15) * 0x2C1B3C6DU;
    h = (h ^ h >> 12) * 0x297A2D39U;
    return static_cast<double>((h ^ h >> 15) & 0xffff) / 65535 - 0.5;
  };
  const double i = std::floor(x), j = std::floor(y), u = x - i, v = y - j;
  const double a = u * u * (3 - 2 * u), b = v * v * (3 - 2 * v);
  const auto at = [&](int di, int dj) {
    return hash(static_cast<std::int64_t>(i) + di, static_cast<std::int64_t>(j) + dj);
  };
  return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
}

// A board's place in the left view, in pixels; its disparity changes from row to row alone.
struct Board {
  double left = 0, top = 0, right = 0, bottom = 0;
  double disparity = 0, per_row = 0;
  std::array<double, 3> color{128, 128, 128};

  [[nodiscard]] double at(double y) const { return disparity + per_row * y; }
  [[nodiscard]] bool holds(double x, double y) const { return x >= left && x < right && y >= top && y < bottom; }
};

// How the right eye's camera differs from a perfect one.
struct RightEye {
  double down = 0;     // pixels that its picture lies too low
  double degrees = 0;  // that its picture is turned clockwise
  double gain = 1, offset = 0;
};

struct TwoViews {
  int cols = 320, rows = 200;
  std::vector<Board> boards;  // the first lies farthest and fills everything

  [[nodiscard]] const Board& seenByLeft(double x, double y) const {
    const auto found = std::find_if(boards.rbegin(), boards.rend() - 1, [&](const Board& b) { return b.holds(x, y); });
    return *found;
  }
  [[nodiscard]] double disparity(int c, int r) const { return seenByLeft(c, r).at(r); }

  [[nodiscard]] Frame left() const {
    return picture([&](double x, double y, double* rgb) { paint(seenByLeft(x, y), x, y, rgb); });
  }
  // The same view with errors of its own, as another encoder leaves them: a grain of so many levels.
  [[nodiscard]] Frame leftWithGrain(double levels) const {
    return picture([&](double x, double y, double* rgb) {
      paint(seenByLeft(x, y), x, y, rgb);
      for (int i = 0; i < 3; ++i) rgb[i] += levels * smoothNoise(x, y, 999);
    });
  }
  [[nodiscard]] Frame right(const RightEye& eye = {}) const {
    const double angle = eye.degrees * 3.14159265358979 / 180, cx = 0.5 * (cols - 1), cy = 0.5 * (rows - 1);
    return picture([&](double c, double r, double* rgb) {
      const double dx = c - cx, dy = r - cy - eye.down;
      const double x = cx + std::cos(angle) * dx + std::sin(angle) * dy,
                   y = cy - std::sin(angle) * dx + std::cos(angle) * dy;
      const auto seen =
          std::find_if(boards.rbegin(), boards.rend() - 1, [&](const Board& b) { return b.holds(x + b.at(y), y); });
      paint(*seen, x + seen->at(y), y, rgb);
      for (int i = 0; i < 3; ++i) rgb[i] = eye.gain * rgb[i] + eye.offset;
    });
  }

 private:
  void paint(const Board& board, double x, double y, double* rgb) const {
    const auto seed = static_cast<std::uint32_t>(&board - boards.data()) + 1;
    const double fine = smoothNoise(x / 2.5, y / 2.5, seed) + smoothNoise(x / 7, y / 7, seed + 50);
    for (std::uint32_t i = 0; i < 3; ++i) {
      rgb[i] = board.color[i] + 45 * fine + 30 * smoothNoise(x / 20, y / 20, seed + 100 * (i + 1));
    }
  }
  template <class Paint>
  [[nodiscard]] Frame picture(Paint&& paint_at) const {
    auto bytes = std::make_shared<std::vector<std::uint8_t>>();
    bytes->reserve(std::size_t{3} * static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        double rgb[3];
        paint_at(c, r, rgb);
        for (const double value : rgb) bytes->push_back(static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0)));
      }
    }
    Frame frame;
    frame.width = cols;
    frame.height = rows;
    frame.model = ColorModel::Rgb;
    frame.range = ColorRange::Full;
    frame.plane_count = 1;
    frame.planes[0] = {bytes->data(), std::ptrdiff_t{3} * cols};
    for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = 0, .offset_bytes = i, .step_bytes = 3};
    frame.owner = bytes;
    return frame;
  }
};

// A slanted back wall behind the screen, a board in it and one before it.
inline TwoViews boards(int cols = 320, int rows = 200) {
  const double w = cols, h = rows;
  return {.cols = cols,
          .rows = rows,
          .boards = {{0, 0, w, h, -8, 0.02, {110, 120, 90}},
                     {0.1 * w, 0.5 * h, 0.4 * w, 0.9 * h, 0, 0, {170, 80, 70}},
                     {0.55 * w, 0.2 * h, 0.8 * w, 0.75 * h, 12.5, 0, {70, 100, 180}}}};
}

// Five pixels before the screen, of 320 columns.
inline TwoViews titleInTheBlack() {
  return {.boards = {{0, 0, 320, 200, 0, 0, {-200, -200, -200}}, {110, 80, 210, 115, 5, 0, {190, 190, 190}}}};
}

// Up to two levels brighter here and there, each view in other places, as a codec leaves what is black.
inline Frame withGrain(Frame frame, unsigned seed) {
  std::mt19937 random(seed);
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(
      frame.planes[0].data, frame.planes[0].data + frame.planes[0].stride_bytes * frame.height);
  for (std::uint8_t& byte : *bytes)
    byte = static_cast<std::uint8_t>(std::min(int{byte} + static_cast<int>(random() % 3), 255));
  frame.planes[0].data = bytes->data();
  frame.owner = bytes;
  return frame;
}

}  // namespace relievo::test
