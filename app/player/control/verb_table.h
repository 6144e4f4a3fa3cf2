// SPDX-License-Identifier: Apache-2.0
// The table of command verbs: the word of each, its operand, and its meaning.
#pragma once

#include <cstdint>
#include <span>

#include "app/player/control/command.h"

namespace relievo {

// The operand after a verb's word. Step: a number with its sign; Time: also without a sign, or with %; Level: also
// without a sign; Track: a number from 1 on, or previous; TrackOrOff: also off; Row: a whole number, with or without a
// sign, or last; Turn: degrees, a multiple of 90, with or without a sign. OnOff, Layout, Shape, Track and TrackOrOff
// may be omitted.
enum class Operand : std::uint8_t { None, Step, Time, Url, OnOff, Layout, Level, Track, TrackOrOff, Shape, Row, Turn };

struct VerbEntry {
  PlayerVerb verb;
  const char* word;
  Operand operand;
  const char* meaning;  // for a Step or a Time: the words that follow the number
  bool repeats = false;
};

// In the order in which they are listed. SeekBy, SeekTo and SeekShare share a word: the number's form tells them apart.
[[nodiscard]] std::span<const VerbEntry> verbTable() noexcept;
[[nodiscard]] const VerbEntry& entryOf(PlayerVerb verb) noexcept;

}  // namespace relievo
