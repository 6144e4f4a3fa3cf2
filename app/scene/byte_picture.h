// SPDX-License-Identifier: Apache-2.0
// A picture of bytes that owns its memory, for image processing. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace relievo {

// `Parts` defines the bytes of a pixel and their number, Parts::kCount. Row by row, pixel by pixel, without gaps.
template <class Parts>
struct BytePicture {
  int cols = 0, rows = 0;
  std::vector<std::uint8_t> bytes;

  BytePicture() = default;
  BytePicture(int width, int height) : cols(width), rows(height), bytes(Parts::kCount * size()) {}

  // In pixels.
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows);
  }
  [[nodiscard]] std::size_t indexOf(int c, int r) const noexcept {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c);
  }
  // The first byte of a pixel, by its place or its index.
  [[nodiscard]] const std::uint8_t* pixel(int c, int r) const noexcept { return pixel(indexOf(c, r)); }
  [[nodiscard]] const std::uint8_t* pixel(std::size_t index) const noexcept {
    return bytes.data() + Parts::kCount * index;
  }
  [[nodiscard]] std::uint8_t* pixel(std::size_t index) noexcept { return bytes.data() + Parts::kCount * index; }
  // The value of a pixel; for pictures of one byte a pixel.
  [[nodiscard]] int at(int c, int r) const noexcept
    requires(Parts::kCount == 1)
  {
    return bytes[indexOf(c, r)];
  }
};

}  // namespace relievo
