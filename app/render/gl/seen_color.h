// SPDX-License-Identifier: Apache-2.0
// Converts a colour picture to RGBA on the CPU, with no more samples than are visible.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "hal/media/frame.h"

namespace relievo {

// Each pixel is the mean of a block of samples. Chroma with fewer samples than luma is interpolated linearly between
// the middles of its samples, as GL does. Where GL draws on the CPU, one pass here takes a tenth of its time.
class SeenColor {
 public:
  // Samples averaged per pixel in one direction: the largest factor up to 16, a product of 2 and 3, that leaves at
  // least `shown` pixels.
  [[nodiscard]] static int factorFor(int samples, int shown) noexcept;

  // `frame` has a format that ColorPicture takes. With codes of 8 bits (the top ones of wider codes) as fractions of
  // 255, a pixel is to_rgb x components + bias. If the size is no multiple of `samples` (across, down), the rest beyond
  // the last whole block is dropped.
  void make(const Frame& frame, glm::ivec2 samples, const glm::mat3& to_rgb, const glm::vec3& bias);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  // Row by row from the top.
  [[nodiscard]] std::span<const std::uint8_t> rgba() const noexcept { return rgba_; }
  [[nodiscard]] std::span<std::uint8_t> rgba() noexcept { return rgba_; }

 private:
  using Values = std::vector<std::int16_t>;  // codes x 64
  void makeRow(const Frame& frame, std::size_t component, int row, glm::ivec2 samples, Values& values);
  void addRow(const Frame& frame, std::size_t component, int row, int weight);
  [[nodiscard]] const std::uint8_t* bytesOf(const Frame& frame, std::size_t component, int row, int count);

  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> rgba_;
  std::vector<std::uint8_t> bytes_;  // of a row whose samples are not adjacent bytes
  std::vector<std::uint16_t> sums_;  // of rows
  Values wider_;
  std::array<Values, 3> rows_;
};

}  // namespace relievo
