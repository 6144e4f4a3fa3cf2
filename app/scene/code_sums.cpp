// SPDX-License-Identifier: Apache-2.0
// Several codes are added at once where they lie side by side.
#include "app/scene/code_sums.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace relievo {
namespace {

std::uint64_t eightBytes(const std::uint8_t* p) RELIEVO_RT {
  std::uint64_t bytes;
  std::memcpy(&bytes, p, sizeof bytes);
  return bytes;
}

// The sum of `count` lanes of a row that starts at `p`, kLanes of them in eight bytes, by adding neighbouring lanes
// first: `add` takes eight bytes. The last eight overlap those before; what was added already is shifted out.
template <int kLanes, class Add>
void eachEightBytes(const std::uint8_t* p, int count, Add&& add) RELIEVO_RT {
  constexpr int kBits = 64 / kLanes;
  for (; count >= kLanes; count -= kLanes, p += 8) add(eightBytes(p));
  if (count > 0) add(eightBytes(p - (kLanes - count) * (kBits / 8)) >> (kBits * (kLanes - count)));
}

// Samples of plain codes, in memory one after the other. kInWords: how many of a row make it worth to add several at
// once; 0 where the machine's byte order does not allow it.
constexpr bool kLittle = std::endian::native == std::endian::little;
struct Byte {
  static constexpr int kBytes = 1, kInWords = kLittle ? 8 : 0;
  static std::uint32_t code(const std::uint8_t* s, std::uint32_t) RELIEVO_RT { return s[0]; }
  static std::uint32_t sumOfRow(const std::uint8_t* row, int count, std::uint32_t) RELIEVO_RT {
    constexpr std::uint64_t kEven = 0x00ff00ff00ff00ff, kOnes = 0x0001000100010001;
    constexpr int kMost = 256;  // of four sums of 16 bits each, together
    std::uint32_t sum = 0;
    for (; count > 0; count -= kMost, row += kMost) {
      std::uint64_t sums = 0;
      const auto add = [&](std::uint64_t x) RELIEVO_RT { sums += (x & kEven) + (x >> 8 & kEven); };
      if (count < 8) {
        for (int c = 0; c < count; ++c) sums += row[c];
      } else {
        eachEightBytes<8>(row, std::min(count, kMost), add);
      }
      sum += static_cast<std::uint32_t>(sums * kOnes >> 48);
    }
    return sum;
  }
};
struct Word {
  static constexpr int kBytes = 2, kInWords = kLittle ? 4 : 0;
  static std::uint32_t code(const std::uint8_t* s, std::uint32_t mask) RELIEVO_RT {
    return (static_cast<std::uint32_t>(s[0]) | static_cast<std::uint32_t>(s[1]) << 8) & mask;
  }
  static std::uint32_t sumOfRow(const std::uint8_t* row, int count, std::uint32_t mask) RELIEVO_RT {
    const std::uint64_t even = mask | std::uint64_t{mask} << 32;
    std::uint64_t sums = 0;
    eachEightBytes<4>(row, count, [&](std::uint64_t x) RELIEVO_RT { sums += (x & even) + (x >> 16 & even); });
    return static_cast<std::uint32_t>(sums) + static_cast<std::uint32_t>(sums >> 32);
  }
};

// kAcross 0: the width is known only at run time.
template <class Sample, int kAcross>
std::uint32_t sumOfRows(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT {
  const int across = kAcross > 0 ? kAcross : block.across, down = block.down;
  const std::ptrdiff_t step = block.step_bytes, stride = block.stride_bytes;
  std::uint32_t sum = 0;
  if (Sample::kInWords && step == Sample::kBytes && across >= Sample::kInWords) {
    for (int r = 0; r < down; ++r) sum += Sample::sumOfRow(block.first + r * stride, across, mask);
    return sum;
  }
  for (int r = 0; r < down; ++r) {
    for (int c = 0; c < across; ++c) sum += Sample::code(block.first + r * stride + c * step, mask);
  }
  return sum;
}

// With the row length known at compile time this takes half the instructions.
template <class Sample>
std::uint32_t sumOf(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT {
  switch (block.across) {
    case 2:
      return sumOfRows<Sample, 2>(block, mask);
    case 3:
      return sumOfRows<Sample, 3>(block, mask);
    case 4:
      return sumOfRows<Sample, 4>(block, mask);
    case 5:
      return sumOfRows<Sample, 5>(block, mask);
    case 6:
      return sumOfRows<Sample, 6>(block, mask);
    default:
      return sumOfRows<Sample, 0>(block, mask);
  }
}

}  // namespace

std::uint32_t sumOfBytes(const CodeBlock& block) RELIEVO_RT {
  return sumOf<Byte>(block, 0xff);
}

std::uint32_t sumOfWords(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT {
  return sumOf<Word>(block, mask);
}

}  // namespace relievo
