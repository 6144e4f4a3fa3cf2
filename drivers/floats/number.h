// SPDX-License-Identifier: Apache-2.0
// Decodes the numbers of a file: half to double floats and integers, in either byte order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace relievo {

struct NumberType {
  char kind = 'f';  // f: floating point of 2, 4 or 8 bytes; i: signed, u: unsigned, of 1, 2, 4 or 8
  int bytes = 4;
  bool swapped = false;  // high bytes first
};

// IEEE 754 binary16.
[[nodiscard]] inline float halfToFloat(std::uint16_t half) noexcept {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000) << 16;
  const std::uint32_t exponent = (half >> 10) & 0x1f, mantissa = half & 0x3ff;
  if (exponent == 0) {
    const float small = static_cast<float>(mantissa) * 0x1p-24F;
    return sign != 0 ? -small : small;
  }
  const std::uint32_t wide = exponent == 0x1f ? 0xff : exponent + 112;
  return std::bit_cast<float>(sign | wide << 23 | mantissa << 13);
}

template <class T>
[[nodiscard]] float numberAs(const std::uint8_t* at) noexcept {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<float>(value);
}

// The number whose bytes begin at `at`; there is no alignment.
[[nodiscard]] inline float numberAt(const std::uint8_t* at, const NumberType& type) noexcept {
  std::uint8_t swapped[8];
  if (type.swapped) {
    std::reverse_copy(at, at + type.bytes, swapped);
    at = swapped;
  }
  const bool is_signed = type.kind == 'i';
  if (type.kind == 'f' && type.bytes == 2) {
    std::uint16_t half;
    std::memcpy(&half, at, sizeof half);
    return halfToFloat(half);
  }
  if (type.kind == 'f') return type.bytes == 4 ? numberAs<float>(at) : numberAs<double>(at);
  switch (type.bytes) {
    case 1:
      return is_signed ? numberAs<std::int8_t>(at) : numberAs<std::uint8_t>(at);
    case 2:
      return is_signed ? numberAs<std::int16_t>(at) : numberAs<std::uint16_t>(at);
    case 4:
      return is_signed ? numberAs<std::int32_t>(at) : numberAs<std::uint32_t>(at);
    default:
      return is_signed ? numberAs<std::int64_t>(at) : numberAs<std::uint64_t>(at);
  }
}

}  // namespace relievo
