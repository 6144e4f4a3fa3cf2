// SPDX-License-Identifier: Apache-2.0
// Tables of the escape sequences and characters that terminals send for keys.
#include "drivers/terminal/terminal_keys.h"

#include <linux/input-event-codes.h>

#include <algorithm>

#include "hal/key_names.h"

namespace relievo {
namespace {

struct Sequence {
  std::string_view bytes;  // after the escape and its [ or O
  std::uint16_t code;
};
constexpr Sequence kSequences[] = {
    {"A", KEY_UP},   {"B", KEY_DOWN},  {"C", KEY_RIGHT}, {"D", KEY_LEFT},    {"H", KEY_HOME},
    {"F", KEY_END},  {"1~", KEY_HOME}, {"4~", KEY_END},  {"5~", KEY_PAGEUP}, {"6~", KEY_PAGEDOWN},
    {"P", KEY_F1},   {"Q", KEY_F2},    {"R", KEY_F3},    {"S", KEY_F4},      {"11~", KEY_F1},
    {"12~", KEY_F2}, {"13~", KEY_F3},  {"14~", KEY_F4},  {"15~", KEY_F5},    {"17~", KEY_F6},
    {"[A", KEY_F1},  {"[B", KEY_F2},   {"[C", KEY_F3},   {"[D", KEY_F4},     {"[E", KEY_F5},
};
struct Character {
  char character;
  std::uint16_t code;
};
constexpr Character kCharacters[] = {
    {' ', KEY_SPACE},          {'\r', KEY_ENTER},     {'\n', KEY_ENTER},     {'\t', KEY_TAB},
    {'\x7f', KEY_BACKSPACE},   {'.', KEY_DOT},        {',', KEY_COMMA},      {'-', KEY_MINUS},
    {'=', KEY_EQUAL},          {'/', KEY_SLASH},      {'[', KEY_LEFTBRACE},  {']', KEY_RIGHTBRACE},
    {'#', KEY_NUMERIC_POUND},  {'?', KEY_QUESTION},   {'<', KEY_PREVIOUS},   {'>', KEY_NEXT},
    {'+', KEY_KPPLUS},         {'*', KEY_KPASTERISK}, {'\b', KEY_BACKSPACE}, {'!', KEY_1 | kWithShift},
    {'@', KEY_2 | kWithShift},
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

}  // namespace

std::optional<std::uint16_t> takeTerminalKey(std::string_view& bytes) noexcept {
  const char first = bytes.front();
  bytes.remove_prefix(1);
  if (first == '\x1b') {
    if (bytes.empty() || (bytes.front() != '[' && bytes.front() != 'O')) return KEY_ESC;
    bytes.remove_prefix(1);
    const auto* const known = std::ranges::find(kSequences, takeSequence(bytes), &Sequence::bytes);
    return known == std::end(kSequences) ? std::nullopt : std::optional(known->code);
  }
  const auto* const known = std::ranges::find(kCharacters, first, &Character::character);
  if (known != std::end(kCharacters)) return known->code;
  const bool capital = first >= 'A' && first <= 'Z';
  const bool named = capital || (first >= '0' && first <= '9') || (first >= 'a' && first <= 'z');
  if (!named) return std::nullopt;
  const auto code = keyCode({&first, 1});
  return code && capital ? std::optional<std::uint16_t>(*code | kWithShift) : code;
}

}  // namespace relievo
