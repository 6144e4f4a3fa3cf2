// SPDX-License-Identifier: Apache-2.0
// The header of a npy file (numpy.lib.format): the type of its numbers, their order, and the array's shape.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/floats/number.h"

namespace relievo::npy {

constexpr std::size_t kLongestHeader = 4096;  // NumPy writes 128 bytes, and accepts no more than 10,000

constexpr std::uint64_t kMostPictureBytes = 300'000'000;  // as the files of other pictures of floats

struct Header {
  NumberType type;
  bool fortran = false;   // the first index is the fastest
  std::size_t begin = 0;  // of the numbers in the file
  std::uint64_t pictures = 1, rows = 0, cols = 0, components = 1;
  [[nodiscard]] std::uint64_t pictureBytes() const noexcept {
    return rows * cols * components * static_cast<std::uint64_t>(type.bytes);
  }
};

[[nodiscard]] bool isNpy(std::span<const std::uint8_t> begin) noexcept;
// The header's dictionary, as far as `begin` has it; empty if it is no npy header.
[[nodiscard]] std::string_view headerText(std::span<const std::uint8_t> begin) noexcept;
// `begin`: the file's first kLongestHeader bytes, or the whole file. Nullopt if it is no npy header, if the numbers are
// of another type, if the array has another shape, or if its pictures have more samples than
// VideoDecoder::kMostSamples or more than 300 MB.
[[nodiscard]] std::optional<Header> parseHeader(std::span<const std::uint8_t> begin);

}  // namespace relievo::npy
