// SPDX-License-Identifier: Apache-2.0
// Unpacks a stream of DEFLATE (RFC 1951) piece by piece.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/files/answered_file.h"

namespace relievo::scan {

// A copy goes on from the same place by itself, so that it can serve as a mark to return to.
class Inflater {
 public:
  // The stream lies in `file` from `begin` to `end`, without zlib's head.
  Inflater(AnsweredFile file, std::uint64_t begin, std::uint64_t end);

  // Fills `out`; returns how many bytes were unpacked: fewer where the stream ends or is damaged.
  [[nodiscard]] std::size_t read(std::span<std::uint8_t> out);
  [[nodiscard]] bool damaged() const noexcept { return damaged_; }

 private:
  // Canonical codes: how many there are of each length, and their symbols in order; short codes are looked up.
  struct Codes {
    static constexpr int kLongest = 15, kQuick = 9;
    std::array<std::uint16_t, kLongest + 1> count{};
    std::array<std::uint16_t, 288> symbols{};
    std::array<std::uint16_t, 1 << kQuick> quick{};  // symbol << 4 | length; 0: a longer code

    bool build(std::span<const std::uint8_t> lengths);
  };
  enum class State : std::uint8_t { Header, Stored, Coded, Ended };

  std::uint32_t bits(int count);
  int symbol(const Codes& codes);
  void fill();
  void readHeader();
  void readLengths();
  void readCode();
  void put(std::uint8_t byte);
  void fail() { damaged_ = true; }

  static constexpr std::size_t kWindow = 1u << 15;
  AnsweredFile file_;
  std::uint64_t at_, end_;
  std::vector<std::uint8_t> input_;
  std::size_t input_at_ = 0;
  std::uint64_t held_ = 0;  // bits that were taken from the input, the next one lowest
  int held_bits_ = 0;
  State state_ = State::Header;
  bool last_ = false, damaged_ = false;
  std::uint32_t left_ = 0, distance_ = 0;  // of a stored block, or of a repetition
  Codes lengths_, distances_;
  std::vector<std::uint8_t> window_;
  std::size_t window_at_ = 0;
  std::uint64_t unpacked_ = 0;
  std::span<std::uint8_t> out_;
  std::size_t out_at_ = 0;
};

}  // namespace relievo::scan
