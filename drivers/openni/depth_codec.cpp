// SPDX-License-Identifier: Apache-2.0
// The format is that of OpenNI 2's XnStreamCompression.
#include "drivers/openni/depth_codec.h"

#include <algorithm>

#include "platform/files/byte_reader.h"

namespace relievo::openni {
namespace {

constexpr unsigned kNoStep = 6;  // half byte of a zero difference: the difference is 6 minus the half byte
constexpr unsigned kLargestHalf = 12;
constexpr unsigned kPadding = 0xd;  // the second half of the last byte
constexpr unsigned kRepeat = 0xe;   // first half byte; the second says how often two samples repeat the value
constexpr unsigned kMore = 0xf;     // a larger step, or a value, follows
constexpr unsigned kIsStep = 0x80, kNoLargeStep = 192;

// Writes decoded values in order; with a table, each value is an index into the table.
class Samples {
 public:
  Samples(std::span<std::uint16_t> out, std::span<const std::uint8_t> table) noexcept : out_(out), table_(table) {}
  // False if there is no room, or the table has no such place.
  bool put(std::uint16_t value, std::size_t times = 1) noexcept {
    if (times > out_.size() - count_) return false;
    if (!table_.empty()) {
      if (value >= table_.size() / 2) return false;
      value = ByteReader(table_.subspan(std::size_t{value} * 2)).value<std::uint16_t>();
    }
    std::fill_n(out_.begin() + static_cast<std::ptrdiff_t>(count_), times, value);
    count_ += times;
    return true;
  }
  [[nodiscard]] bool full() const noexcept { return count_ == out_.size(); }

 private:
  std::span<std::uint16_t> out_;
  std::span<const std::uint8_t> table_;
  std::size_t count_ = 0;
};

std::uint16_t fallen(std::uint16_t value, unsigned step, unsigned none) noexcept {
  return static_cast<std::uint16_t>(value + none - step);
}

// A byte with a step, or two with a value.
std::uint16_t takeMore(ByteReader& packed, std::uint16_t before) noexcept {
  const unsigned first = packed.value<std::uint8_t>();
  if ((first & kIsStep) != 0) return fallen(before, first, kNoLargeStep);
  return static_cast<std::uint16_t>(first << 8 | packed.value<std::uint8_t>());
}

bool unpack(ByteReader packed, Samples samples) noexcept {
  auto value = packed.value<std::uint16_t>();
  if (!packed.ok() || !samples.put(value)) return false;
  while (packed.left() > 0) {
    const unsigned byte = packed.value<std::uint8_t>();
    const unsigned first = byte >> 4, second = byte & 0xf;
    if (first == kRepeat) {
      if (!samples.put(value, std::size_t{2} * second)) return false;
      continue;
    }
    if (first > kLargestHalf && byte != 0xff) return false;
    if (first <= kLargestHalf) {
      value = fallen(value, first, kNoStep);
      if (!samples.put(value)) return false;
      if (second == kPadding) continue;
    }
    if (second == kMore) {
      value = takeMore(packed, value);
    } else if (second <= kLargestHalf) {
      value = fallen(value, second, kNoStep);
    } else {
      return false;
    }
    if (!packed.ok() || !samples.put(value)) return false;
  }
  return samples.full();
}

}  // namespace

bool unpack16z(std::span<const std::uint8_t> packed, std::span<std::uint16_t> samples) noexcept {
  return unpack(ByteReader(packed), Samples(samples, {}));
}

bool unpack16zTable(std::span<const std::uint8_t> packed, std::span<std::uint16_t> samples) noexcept {
  ByteReader reader(packed);
  const auto values = reader.value<std::uint16_t>();
  const auto table = reader.take(std::size_t{values} * 2);
  if (table.empty()) return false;
  return unpack(ByteReader(packed.subspan(reader.position())), Samples(samples, table));
}

}  // namespace relievo::openni
