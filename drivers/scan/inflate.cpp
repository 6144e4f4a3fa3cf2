// SPDX-License-Identifier: Apache-2.0
#include "drivers/scan/inflate.h"

#include <algorithm>
#include <utility>

namespace relievo::scan {
namespace {

constexpr std::size_t kInput = 1u << 14;
constexpr int kEndOfBlock = 256, kMostLengths = 286, kMostDistances = 30;

// RFC 1951, 3.2.5: the least length or distance of a symbol, and how many bits are added to it.
constexpr std::array<std::uint16_t, 29> kLengthBase{3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                                    31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr std::array<std::uint8_t, 29> kLengthBits{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                                   2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};

std::uint32_t distanceBase(int symbol) noexcept {
  return symbol < 4 ? static_cast<std::uint32_t>(symbol) + 1
                    : (2u + (static_cast<std::uint32_t>(symbol) & 1)) << (symbol / 2 - 1) | 1u;
}
int distanceBits(int symbol) noexcept {
  return symbol < 4 ? 0 : symbol / 2 - 1;
}

}  // namespace

bool Inflater::Codes::build(std::span<const std::uint8_t> lengths) {
  count.fill(0);
  quick.fill(0);
  for (const std::uint8_t length : lengths) ++count[length];
  count[0] = 0;
  int free = 1;  // codes of the length that no shorter code begins
  std::array<std::uint16_t, kLongest + 2> place{};
  std::array<std::uint32_t, kLongest + 2> code{};
  for (std::size_t length = 1; length <= kLongest; ++length) {
    free = 2 * free - count[length];
    if (free < 0) return false;
    place[length + 1] = static_cast<std::uint16_t>(place[length] + count[length]);
    code[length + 1] = (code[length] + count[length]) << 1;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const std::uint8_t length = lengths[i];
    if (length == 0) continue;
    symbols[place[length]++] = static_cast<std::uint16_t>(i);
    std::uint32_t ahead = code[length]++, reversed = 0;
    if (length > kQuick) continue;
    for (int bit = 0; bit < length; ++bit, ahead >>= 1) reversed = reversed << 1 | (ahead & 1);
    for (; reversed < quick.size(); reversed += 1u << length)
      quick[reversed] = static_cast<std::uint16_t>(i << 4 | length);
  }
  return true;
}

Inflater::Inflater(AnsweredFile file, std::uint64_t begin, std::uint64_t end)
    : file_(std::move(file)), at_(begin), end_(end), window_(kWindow) {}

// Beyond the end there are zeros.
void Inflater::fill() {
  constexpr int kFull = 56;
  while (held_bits_ <= kFull) {
    if (input_at_ == input_.size() && at_ < end_) {
      input_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kInput, end_ - at_)));
      input_.resize(file_.read(at_, input_).value_or(0));
      input_at_ = 0;
      at_ = input_.empty() ? end_ : at_ + input_.size();
    }
    if (input_at_ == input_.size()) return;
    held_ |= std::uint64_t{input_[input_at_++]} << held_bits_;
    held_bits_ += 8;
  }
}

std::uint32_t Inflater::bits(int count) {
  if (held_bits_ < count) fill();
  if (held_bits_ < count) fail();
  const auto value = static_cast<std::uint32_t>(held_ & ((std::uint64_t{1} << count) - 1));
  held_ >>= count;
  held_bits_ = std::max(0, held_bits_ - count);
  return value;
}

int Inflater::symbol(const Codes& codes) {
  if (held_bits_ < Codes::kLongest) fill();
  if (const std::uint16_t found = codes.quick[held_ & (codes.quick.size() - 1)]; found != 0) {
    static_cast<void>(bits(found & 15));
    return found >> 4;
  }
  std::uint32_t code = 0, first = 0, place = 0;
  for (std::size_t length = 1; length <= Codes::kLongest; ++length) {
    code |= bits(1);
    const std::uint32_t count = codes.count[length];
    if (code < first + count) return codes.symbols[place + code - first];
    place += count;
    first = (first + count) << 1;
    code <<= 1;
  }
  fail();
  return kEndOfBlock;
}

void Inflater::readHeader() {
  constexpr std::size_t kOfFixed[] = {144, 256, 280, 288};
  if (last_) {
    state_ = State::Ended;
    return;
  }
  last_ = bits(1) == 1;
  const std::uint32_t kind = bits(2);
  state_ = State::Coded;
  if (kind == 0) {
    static_cast<void>(bits(held_bits_ % 8));
    const std::uint32_t length = bits(16), complement = bits(16);
    if ((length ^ complement) != 0xffff) fail();
    state_ = State::Stored;
    left_ = length;
  } else if (kind == 1) {
    std::array<std::uint8_t, 288> lengths{};
    for (std::size_t i = 0; i < lengths.size(); ++i)
      lengths[i] = i < kOfFixed[0] ? 8 : i < kOfFixed[1] ? 9 : i < kOfFixed[2] ? 7 : 8;
    std::array<std::uint8_t, kMostDistances> distances{};
    distances.fill(5);
    if (!lengths_.build(lengths) || !distances_.build(distances)) fail();
  } else if (kind == 2) {
    readLengths();
  } else {
    fail();
  }
}

// The lengths of both codes are coded themselves (RFC 1951, 3.2.7).
void Inflater::readLengths() {
  constexpr std::array<std::uint8_t, 19> kOrder{16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
  constexpr int kRepeat = 16, kZeros = 17;
  const std::size_t of_lengths = bits(5) + 257, of_distances = bits(5) + 1, of_codes = bits(4) + 4;
  if (of_lengths > kMostLengths || of_distances > kMostDistances) return fail();
  std::array<std::uint8_t, 19> own{};
  for (std::size_t i = 0; i < of_codes; ++i) own[kOrder[i]] = static_cast<std::uint8_t>(bits(3));
  if (!lengths_.build(own)) return fail();
  std::array<std::uint8_t, kMostLengths + kMostDistances> lengths{};
  for (std::size_t i = 0; i < of_lengths + of_distances && !damaged_;) {
    const int next = symbol(lengths_);
    if (next < kRepeat) {
      lengths[i++] = static_cast<std::uint8_t>(next);
      continue;
    }
    if (next > kZeros + 1 || (next == kRepeat && i == 0)) return fail();
    const std::uint8_t value = next == kRepeat ? lengths[i - 1] : 0;
    const std::size_t times = next == kRepeat ? 3 + bits(2) : next == kZeros ? 3 + bits(3) : 11 + bits(7);
    if (i + times > of_lengths + of_distances) return fail();
    std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(i), times, value);
    i += times;
  }
  const std::span<const std::uint8_t> all(lengths);
  if (!lengths_.build(all.first(of_lengths)) || !distances_.build(all.subspan(of_lengths, of_distances))) fail();
}

void Inflater::put(std::uint8_t byte) {
  window_[window_at_] = byte;
  window_at_ = (window_at_ + 1) % kWindow;
  ++unpacked_;
  out_[out_at_++] = byte;
}

void Inflater::readCode() {
  const int next = symbol(lengths_);
  if (next < kEndOfBlock) return put(static_cast<std::uint8_t>(next));
  if (next == kEndOfBlock) {
    state_ = State::Header;
    return;
  }
  const auto length = static_cast<std::size_t>(next - kEndOfBlock - 1);
  if (length >= kLengthBase.size()) return fail();
  left_ = kLengthBase[length] + bits(kLengthBits[length]);
  const int far = symbol(distances_);
  if (far >= kMostDistances) return fail();
  distance_ = distanceBase(far) + bits(distanceBits(far));
  if (distance_ > unpacked_ || distance_ > kWindow) fail();
}

std::size_t Inflater::read(std::span<std::uint8_t> out) {
  out_ = out;
  out_at_ = 0;
  while (out_at_ < out_.size() && !damaged_ && state_ != State::Ended) {
    if (state_ == State::Header) {
      readHeader();
    } else if (state_ == State::Stored) {
      if (left_ == 0) state_ = State::Header;
      else if (const auto byte = static_cast<std::uint8_t>(bits(8)); --left_, !damaged_) put(byte);
    } else if (left_ > 0) {
      put(window_[(window_at_ + kWindow - distance_) % kWindow]);
      --left_;
    } else {
      readCode();
    }
  }
  return out_at_;
}

}  // namespace relievo::scan
