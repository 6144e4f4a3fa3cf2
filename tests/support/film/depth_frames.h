// SPDX-License-Identifier: Apache-2.0
// Depth frames and surface windows made of numbers, for tests that need no file.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "hal/media/frame.h"

namespace relievo::test {

// A gray frame of `bits` bits; code(c, r) is cut to them.
template <class Code>
Frame makeGrayFrame(int cols, int rows, int bits, MediaTime time, Code&& code) {
  const std::size_t bytes = bits > 8 ? 2 : 1;
  auto samples = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(cols) * rows * bytes);
  std::uint8_t* out = samples->data();
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const auto value = static_cast<std::uint32_t>(code(c, r));
      *out++ = static_cast<std::uint8_t>(value & 0xff);
      if (bytes == 2) *out++ = static_cast<std::uint8_t>(value >> 8);
    }
  }
  Frame frame;
  frame.pts = time;
  frame.width = cols;
  frame.height = rows;
  frame.model = ColorModel::Gray;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.components[0] = {.step_bytes = static_cast<std::uint8_t>(bytes), .bits = static_cast<std::uint8_t>(bits)};
  frame.planes[0] = {samples->data(), static_cast<std::ptrdiff_t>(cols * bytes)};
  frame.owner = samples;
  return frame;
}

// 16-bit frame whose heights follow height(x_mm, y_mm) in a volume, to within the code's step (0.0006 mm of 40), and
// end at its bounds.
template <class Height>
Frame makeReliefFrame(int cols, int rows, const DisplayVolume& volume, MediaTime time, Height&& height) {
  const GridMapping grid(volume, cols, rows);
  return makeGrayFrame(cols, rows, 16, time, [&](int c, int r) {
    const double z = height(grid.x(c), grid.y(r));
    return static_cast<std::uint32_t>(std::clamp(z / volume.depth_mm, 0.0, 1.0) * 65535.0 + 0.5);
  });
}

inline TimedSurface surfaceOf(const Frame& frame, const DisplayVolume& volume,
                              const DepthCalibration& calibration = {.bits = 16}) {
  return {HeightField::make(frame, calibration, volume).value(), frame.pts, frame.owner};
}

inline SurfaceWindow makeWindow(std::span<const Frame> frames, const DisplayVolume& volume,
                                const DepthCalibration& calibration = {.bits = 16}) {
  SurfaceWindow window;
  for (const Frame& frame : frames) {
    window.frames[static_cast<std::size_t>(window.count++)] = surfaceOf(frame, volume, calibration);
  }
  return window;
}

// `count` frames of height(x_mm, y_mm, t_s), a period apart, the first at time 0.
template <class Height>
std::vector<Frame> makeReliefFilm(int count, double period_s, int cols, int rows, const DisplayVolume& volume,
                                  Height&& height) {
  std::vector<Frame> frames;
  for (int k = 0; k < count; ++k) {
    frames.push_back(makeReliefFrame(cols, rows, volume, mediaTime(k * period_s),
                                     [&](double x, double y) { return height(x, y, k * period_s); }));
  }
  return frames;
}

}  // namespace relievo::test
