// SPDX-License-Identifier: Apache-2.0
// Adds several codes at once if they are adjacent.
#include "app/scene/code_sums.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace relievo {
namespace {

struct Byte {
  using Pair = std::uint16_t;
  using Pairs = std::uint16_t __attribute__((vector_size(16)));
  static constexpr int kBytes = 1;
  static std::uint32_t code(const std::uint8_t* s, std::uint32_t) RELIEVO_RT { return s[0]; }
};
struct Word {
  using Pair = std::uint32_t;
  using Pairs = std::uint32_t __attribute__((vector_size(16)));
  static constexpr int kBytes = 2;
  static std::uint32_t code(const std::uint8_t* s, std::uint32_t mask) RELIEVO_RT {
    return (static_cast<std::uint32_t>(s[0]) | static_cast<std::uint32_t>(s[1]) << 8) & mask;
  }
};

// 16 bytes of a row at a time, by a vector extension that GCC and clang share: each lane has two neighbouring codes and
// takes their sum. The last 16 bytes of a row overlap those before; what was added already is masked out.
template <class Sample>
class Lanes {
 public:
  static constexpr int kOfVector = 16 / Sample::kBytes;
  static constexpr int kFewest = kOfVector / 2;  // codes of a row
  // As many codes a row, all rows together, as the lanes can take.
  static constexpr int kMost = (Sample::kBytes == 1 ? 128 : 32768) * kOfVector;

  Lanes(int across, std::uint32_t mask) RELIEVO_RT : bytes_(across* Sample::kBytes), whole_(bytes_ & ~15) {
    static constexpr std::array<std::uint8_t, 32> kEnd = [] {
      std::array<std::uint8_t, 32> bytes{};
      std::fill(bytes.begin() + 16, bytes.end(), std::uint8_t{0xff});
      return bytes;
    }();
    keep_ = Vector{} + static_cast<Pair>(mask | mask << kShift);
    keep_end_ = keep_ & load(kEnd.data() + bytes_ - whole_);
  }
  void addRow(const std::uint8_t* row) RELIEVO_RT {
    constexpr bool kWholeBytes = Sample::kBytes == 1;  // each bit of a vector counts
    for (std::ptrdiff_t at = 0; at < whole_; at += 16) add(kWholeBytes ? load(row + at) : load(row + at) & keep_);
    if (whole_ < bytes_) add(load(row + bytes_ - 16) & keep_end_);
  }
  // A row of under 16 bytes, and of 8 or more: its last eight, without those that are among its first eight.
  void addShortRow(const std::uint8_t* row) RELIEVO_RT {
    add(std::bit_cast<Vector>(Halves{eightBytes(row + bytes_ - 8), eightBytes(row)}) & keep_end_);
  }
  [[nodiscard]] bool shortRows() const RELIEVO_RT { return whole_ == 0; }
  [[nodiscard]] std::uint32_t total() const RELIEVO_RT {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < 16 / sizeof(Pair); ++i) sum += sums_[i];
    return sum;
  }

 private:
  using Pair = Sample::Pair;
  using Vector = Sample::Pairs;
  static constexpr int kShift = 8 * Sample::kBytes;
  using Halves = std::uint64_t __attribute__((vector_size(16)));
  static std::uint64_t eightBytes(const std::uint8_t* p) RELIEVO_RT {
    std::uint64_t bytes;
    std::memcpy(&bytes, p, sizeof bytes);
    return bytes;
  }
  static Vector load(const std::uint8_t* p) RELIEVO_RT {
    Vector v;
    std::memcpy(&v, p, sizeof v);
    return v;
  }
  void add(const Vector& codes) RELIEVO_RT {
    constexpr auto kLow = static_cast<Pair>((std::uint64_t{1} << kShift) - 1);
    sums_ += (codes & kLow) + (codes >> kShift);
  }

  std::ptrdiff_t bytes_, whole_;  // of a row; of them, in whole vectors
  Vector sums_{}, keep_, keep_end_;
};

template <class Sample>
std::uint32_t sumOfLanes(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT {
  Lanes<Sample> lanes(block.across, mask);
  const std::uint8_t* row = block.first;
  if (lanes.shortRows()) {
    for (int r = 0; r < block.down; ++r, row += block.stride_bytes) lanes.addShortRow(row);
  } else {
    for (int r = 0; r < block.down; ++r, row += block.stride_bytes) lanes.addRow(row);
  }
  return lanes.total();
}

// The same for any size: in parts that the lanes can take.
template <class Sample>
std::uint32_t sumOfParts(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT {
  std::uint32_t sum = 0;
  CodeBlock part = block;
  for (int c = 0; c < block.across; c += part.across) {
    const int left = block.across - c;
    // The last part has no fewer codes than the lanes need.
    part.across = left > Lanes<Sample>::kMost / 2 ? Lanes<Sample>::kMost / 4 : left;
    for (int r = 0; r < block.down; r += part.down) {
      part.down = std::min(block.down - r, Lanes<Sample>::kMost / (part.across + Lanes<Sample>::kOfVector));
      part.first = block.first + c * Sample::kBytes + r * block.stride_bytes;
      sum += sumOfLanes<Sample>(part, mask);
    }
  }
  return sum;
}

// kAcross 0: the width is known only at run time.
template <class Sample, int kAcross>
std::uint32_t sumOfRows(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT {
  const int across = kAcross > 0 ? kAcross : block.across;
  std::uint32_t sum = 0;
  for (int r = 0; r < block.down; ++r) {
    const std::uint8_t* row = block.first + r * block.stride_bytes;
    for (int c = 0; c < across; ++c) sum += Sample::code(row + c * block.step_bytes, mask);
  }
  return sum;
}

template <class Sample>
std::uint32_t sumOf(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT {
  constexpr bool kLittle = std::endian::native == std::endian::little;
  if (kLittle && block.step_bytes == Sample::kBytes && block.across >= Lanes<Sample>::kFewest) {
    const bool fits = block.down * (block.across + std::int64_t{Lanes<Sample>::kOfVector}) <= Lanes<Sample>::kMost;
    return fits ? sumOfLanes<Sample>(block, mask) : sumOfParts<Sample>(block, mask);
  }
  switch (block.across) {  // with the row length known at compile time this takes half the instructions
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
