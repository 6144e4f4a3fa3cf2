// SPDX-License-Identifier: Apache-2.0
#include "hal/key_signs.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <iterator>

#include "hal/key_names.h"

namespace relievo {
namespace {

struct KeySign {
  char sign;
  std::uint16_t code;
};
constexpr KeySign kSigns[] = {
    {'#', KEY_NUMERIC_POUND},
    {'?', KEY_QUESTION},
    {'<', KEY_PREVIOUS},
    {'>', KEY_NEXT},
    {'+', KEY_KPPLUS},
    {'*', KEY_KPASTERISK},
    {'!', KEY_1 | kWithShift},
    {'@', KEY_2 | kWithShift},
    {'$', KEY_4 | kWithShift},
    {'%', KEY_5 | kWithShift},
    {'^', KEY_6 | kWithShift},
    {'&', KEY_7 | kWithShift},
    {'(', KEY_9 | kWithShift},
    {')', KEY_0 | kWithShift},
    {'-', KEY_MINUS},
    {'_', KEY_MINUS | kWithShift},
    {'=', KEY_EQUAL},
    {'[', KEY_LEFTBRACE},
    {'{', KEY_LEFTBRACE | kWithShift},
    {']', KEY_RIGHTBRACE},
    {'}', KEY_RIGHTBRACE | kWithShift},
    {'\\', KEY_BACKSLASH},
    {'|', KEY_BACKSLASH | kWithShift},
    {';', KEY_SEMICOLON},
    {':', KEY_SEMICOLON | kWithShift},
    {'\'', KEY_APOSTROPHE},
    {'"', KEY_APOSTROPHE | kWithShift},
    {'`', KEY_GRAVE},
    {'~', KEY_GRAVE | kWithShift},
    {',', KEY_COMMA},
    {'.', KEY_DOT},
    {'/', KEY_SLASH},
};

}  // namespace

std::optional<std::uint16_t> keyOfSign(int sign) noexcept {
  const auto* const found = std::ranges::find(kSigns, sign, &KeySign::sign);
  return found == std::end(kSigns) ? std::nullopt : std::optional(found->code);
}

char signOfKey(std::uint16_t code) noexcept {
  const auto* const found = std::ranges::find(kSigns, code, &KeySign::code);
  return found == std::end(kSigns) ? '\0' : found->sign;
}

}  // namespace relievo
