// SPDX-License-Identifier: Apache-2.0
// The table of the verbs: each one's word, what stands after it, and what it means.
#pragma once

#include <cstdint>
#include <span>

#include "app/player/control/command.h"

namespace relievo {

// What stands after a verb's word. Step: a number with its sign; Time: also without, or with %; Level: also without;
// Track: a number from 1 on, or off; Row: a whole number, with its sign or without, or last. OnOff, Layout, Shape and
// Track may be left away.
enum class Operand : std::uint8_t { None, Step, Time, Url, OnOff, Layout, Level, Track, Shape, Row };

struct VerbEntry {
  PlayerVerb verb;
  const char* word;
  Operand operand;
  const char* meaning;  // of a Step or a Time: what follows the number
  bool repeats = false;
};

// In the order in which they are listed. SeekBy, SeekTo and SeekShare share a word: the number's form tells them apart.
[[nodiscard]] std::span<const VerbEntry> verbTable() noexcept;
[[nodiscard]] const VerbEntry& entryOf(PlayerVerb verb) noexcept;

}  // namespace relievo
