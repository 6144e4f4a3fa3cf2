// SPDX-License-Identifier: Apache-2.0
// Tables of the escape sequences and characters that terminals send for keys.
#include "drivers/terminal/terminal_keys.h"

#include <linux/input-event-codes.h>

#include <algorithm>

#include "hal/key_names.h"
#include "hal/key_signs.h"

namespace relievo {
namespace {

struct Sequence {
  std::string_view bytes;  // after the escape and its [ or O
  std::uint16_t code;
};
constexpr Sequence kSequences[] = {
    {"A", KEY_UP},    {"B", KEY_DOWN},  {"C", KEY_RIGHT},   {"D", KEY_LEFT},      {"H", KEY_HOME}, {"F", KEY_END},
    {"1~", KEY_HOME}, {"4~", KEY_END},  {"5~", KEY_PAGEUP}, {"6~", KEY_PAGEDOWN}, {"P", KEY_F1},   {"Q", KEY_F2},
    {"R", KEY_F3},    {"S", KEY_F4},    {"11~", KEY_F1},    {"12~", KEY_F2},      {"13~", KEY_F3}, {"14~", KEY_F4},
    {"15~", KEY_F5},  {"17~", KEY_F6},  {"18~", KEY_F7},    {"19~", KEY_F8},      {"20~", KEY_F9}, {"21~", KEY_F10},
    {"23~", KEY_F11}, {"24~", KEY_F12}, {"[A", KEY_F1},     {"[B", KEY_F2},       {"[C", KEY_F3},  {"[D", KEY_F4},
    {"[E", KEY_F5},
};
struct Character {
  char character;
  std::uint16_t code;
};
constexpr Character kCharacters[] = {
    {' ', KEY_SPACE},        {'\r', KEY_ENTER},     {'\n', KEY_ENTER},           {'\t', KEY_TAB},
    {'\x7f', KEY_BACKSPACE}, {'\b', KEY_BACKSPACE}, {'\x17', KEY_W | kWithCtrl},
};

// The final byte of a sequence is its first one at or above '@', after the second [ that the kernel's console sends.
std::string_view takeSequence(std::string_view& bytes) noexcept {
  const auto last =
      std::find_if(bytes.begin() + (bytes.starts_with('[') ? 1 : 0), bytes.end(), [](char c) { return c >= '@'; });
  const auto length = static_cast<std::size_t>(last - bytes.begin()) + (last == bytes.end() ? 0 : 1);
  const std::string_view sequence = bytes.substr(0, length);
  bytes.remove_prefix(length);
  return sequence;
}

// "1;2C" is Shift and "C", "5;2~" is Shift and "5~": xterm's modifiers, 1 + Shift (1) + Alt (2) + Ctrl (4). None with
// Alt.
std::optional<std::uint16_t> keyOfSequence(std::string_view sequence) noexcept {
  const std::size_t semicolon = sequence.find(';');
  const bool modified = semicolon != std::string_view::npos;
  const std::string_view number = sequence.substr(0, semicolon);
  const std::string_view rest = modified ? sequence.substr(semicolon + 1) : "";
  if (modified && (rest.empty() || rest.size() > 2)) return std::nullopt;
  const int modifiers = rest.size() == 2 && rest[0] > '1' ? rest[0] - '1' : 0;
  constexpr int kShift = 1, kCtrl = 4;
  if ((modifiers & ~(kShift | kCtrl)) != 0) return std::nullopt;
  const auto* const known = std::ranges::find_if(kSequences, [&](const Sequence& each) {
    if (!modified) return each.bytes == sequence;
    if (!rest.ends_with('~')) return each.bytes == rest.substr(rest.size() - 1);
    return each.bytes.ends_with('~') && each.bytes.substr(0, each.bytes.size() - 1) == number;
  });
  if (known == std::end(kSequences)) return std::nullopt;
  return static_cast<std::uint16_t>(known->code | ((modifiers & kShift) != 0 ? kWithShift : 0) |
                                    ((modifiers & kCtrl) != 0 ? kWithCtrl : 0));
}

}  // namespace

std::optional<std::uint16_t> takeTerminalKey(std::string_view& bytes) noexcept {
  const char first = bytes.front();
  bytes.remove_prefix(1);
  if (first == '\x1b') {
    if (bytes.empty() || (bytes.front() != '[' && bytes.front() != 'O')) return KEY_ESC;
    bytes.remove_prefix(1);
    return keyOfSequence(takeSequence(bytes));
  }
  const auto* const known = std::ranges::find(kCharacters, first, &Character::character);
  if (known != std::end(kCharacters)) return known->code;
  if (const auto sign = keyOfSign(first)) return sign;
  const bool capital = first >= 'A' && first <= 'Z';
  const bool named = capital || (first >= '0' && first <= '9') || (first >= 'a' && first <= 'z');
  if (!named) return std::nullopt;
  const auto code = keyCode({&first, 1});
  return code && capital ? std::optional<std::uint16_t>(*code | kWithShift) : code;
}

}  // namespace relievo
