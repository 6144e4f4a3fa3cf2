// SPDX-License-Identifier: Apache-2.0
#include "app/scene/codes/code_set.h"

#include <algorithm>

#include "platform/text/number_in.h"

namespace relievo {
namespace {

std::optional<std::uint32_t> codeOf(std::string_view text) noexcept {
  const auto code = numberIn<std::uint32_t>(text);
  return code && *code <= CodeSet::kHighestCode ? code : std::nullopt;
}

}  // namespace

std::optional<CodeSet::Range> CodeSet::parseRange(std::string_view text) noexcept {
  const std::size_t dash = text.find('-');
  const auto low = codeOf(text.substr(0, dash));
  const auto high = dash == std::string_view::npos ? low : codeOf(text.substr(dash + 1));
  if (!low || !high || *high < *low) return std::nullopt;
  return Range{*low, *high};
}

std::optional<CodeSet> CodeSet::parse(std::string_view text) noexcept {
  CodeSet set;
  if (text == "none") return set;
  while (true) {
    const std::size_t plus = text.find('+');
    const auto range = parseRange(text.substr(0, plus));
    if (!range || set.count_ == kMostRanges) return std::nullopt;
    set.ranges_[set.count_++] = *range;
    if (plus == std::string_view::npos) return set;
    text.remove_prefix(plus + 1);
  }
}

std::string CodeSet::text() const {
  if (empty()) return "none";
  std::string text;
  for (int i = 0; i < count_; ++i) {
    if (i > 0) text += '+';
    text += std::to_string(ranges_[i].low);
    if (ranges_[i].high != ranges_[i].low) text += '-' + std::to_string(ranges_[i].high);
  }
  return text;
}

std::uint32_t CodeSet::highest() const noexcept {
  std::uint32_t highest = 0;
  for (int i = 0; i < count_; ++i) highest = std::max(highest, ranges_[i].high);
  return highest;
}

}  // namespace relievo
