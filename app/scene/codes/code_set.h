// SPDX-License-Identifier: Apache-2.0
// The depth codes that mean "no reading": a few codes or ranges of codes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "platform/realtime.h"

namespace relievo {

// At most four ranges of codes, both ends included. Trivially copyable; usable from any thread.
class CodeSet {
 public:
  struct Range {
    std::uint32_t low = 0, high = 0;
    bool operator==(const Range&) const = default;
  };
  static constexpr int kMostRanges = 4;
  static constexpr std::uint32_t kHighestCode = 0xffff;

  constexpr CodeSet() noexcept = default;
  // One code.
  constexpr CodeSet(std::uint32_t code) noexcept : CodeSet(Range{code, code}) {}  // NOLINT(*-explicit-*)
  constexpr explicit CodeSet(Range range) noexcept : ranges_{range}, count_(1) {}

  // Parses "0", "0+65535", "0+2000-2047", "none". Nullopt for other text and for more than four ranges.
  [[nodiscard]] static std::optional<CodeSet> parse(std::string_view text) noexcept;
  // Parses "7", "1-2047".
  [[nodiscard]] static std::optional<Range> parseRange(std::string_view text) noexcept;
  // The form that `parse` reads.
  [[nodiscard]] std::string text() const;

  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] bool contains(std::uint32_t code) const RELIEVO_RT {
    for (int i = 0; i < count_; ++i) {
      if (code - ranges_[i].low <= ranges_[i].high - ranges_[i].low) return true;
    }
    return false;
  }
  // The highest code of the set; 0 if it is empty.
  [[nodiscard]] std::uint32_t highest() const noexcept;

  bool operator==(const CodeSet&) const = default;

 private:
  std::array<Range, kMostRanges> ranges_{};
  int count_ = 0;
};

}  // namespace relievo
