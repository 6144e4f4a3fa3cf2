// SPDX-License-Identifier: Apache-2.0
// A table from SDL's scancodes, which are USB usages (HID Usage Tables, 10 and 15), to Linux key codes as in the
// kernel's hid-input.c.
#include "drivers/egl/window_keys.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "hal/key_signs.h"

namespace relievo {
namespace {

struct KeyPair {
  SDL_Scancode scancode;
  std::uint16_t code;
};

constexpr KeyPair kKeys[] = {
    {SDL_SCANCODE_A, KEY_A},
    {SDL_SCANCODE_B, KEY_B},
    {SDL_SCANCODE_C, KEY_C},
    {SDL_SCANCODE_D, KEY_D},
    {SDL_SCANCODE_E, KEY_E},
    {SDL_SCANCODE_F, KEY_F},
    {SDL_SCANCODE_G, KEY_G},
    {SDL_SCANCODE_H, KEY_H},
    {SDL_SCANCODE_I, KEY_I},
    {SDL_SCANCODE_J, KEY_J},
    {SDL_SCANCODE_K, KEY_K},
    {SDL_SCANCODE_L, KEY_L},
    {SDL_SCANCODE_M, KEY_M},
    {SDL_SCANCODE_N, KEY_N},
    {SDL_SCANCODE_O, KEY_O},
    {SDL_SCANCODE_P, KEY_P},
    {SDL_SCANCODE_Q, KEY_Q},
    {SDL_SCANCODE_R, KEY_R},
    {SDL_SCANCODE_S, KEY_S},
    {SDL_SCANCODE_T, KEY_T},
    {SDL_SCANCODE_U, KEY_U},
    {SDL_SCANCODE_V, KEY_V},
    {SDL_SCANCODE_W, KEY_W},
    {SDL_SCANCODE_X, KEY_X},
    {SDL_SCANCODE_Y, KEY_Y},
    {SDL_SCANCODE_Z, KEY_Z},
    {SDL_SCANCODE_1, KEY_1},
    {SDL_SCANCODE_2, KEY_2},
    {SDL_SCANCODE_3, KEY_3},
    {SDL_SCANCODE_4, KEY_4},
    {SDL_SCANCODE_5, KEY_5},
    {SDL_SCANCODE_6, KEY_6},
    {SDL_SCANCODE_7, KEY_7},
    {SDL_SCANCODE_8, KEY_8},
    {SDL_SCANCODE_9, KEY_9},
    {SDL_SCANCODE_0, KEY_0},
    {SDL_SCANCODE_RETURN, KEY_ENTER},
    {SDL_SCANCODE_ESCAPE, KEY_ESC},
    {SDL_SCANCODE_BACKSPACE, KEY_BACKSPACE},
    {SDL_SCANCODE_TAB, KEY_TAB},
    {SDL_SCANCODE_SPACE, KEY_SPACE},
    {SDL_SCANCODE_MINUS, KEY_MINUS},
    {SDL_SCANCODE_EQUALS, KEY_EQUAL},
    {SDL_SCANCODE_LEFTBRACKET, KEY_LEFTBRACE},
    {SDL_SCANCODE_RIGHTBRACKET, KEY_RIGHTBRACE},
    {SDL_SCANCODE_BACKSLASH, KEY_BACKSLASH},
    {SDL_SCANCODE_SEMICOLON, KEY_SEMICOLON},
    {SDL_SCANCODE_APOSTROPHE, KEY_APOSTROPHE},
    {SDL_SCANCODE_GRAVE, KEY_GRAVE},
    {SDL_SCANCODE_COMMA, KEY_COMMA},
    {SDL_SCANCODE_PERIOD, KEY_DOT},
    {SDL_SCANCODE_SLASH, KEY_SLASH},
    {SDL_SCANCODE_CAPSLOCK, KEY_CAPSLOCK},
    {SDL_SCANCODE_F1, KEY_F1},
    {SDL_SCANCODE_F2, KEY_F2},
    {SDL_SCANCODE_F3, KEY_F3},
    {SDL_SCANCODE_F4, KEY_F4},
    {SDL_SCANCODE_F5, KEY_F5},
    {SDL_SCANCODE_F6, KEY_F6},
    {SDL_SCANCODE_F7, KEY_F7},
    {SDL_SCANCODE_F8, KEY_F8},
    {SDL_SCANCODE_F9, KEY_F9},
    {SDL_SCANCODE_F10, KEY_F10},
    {SDL_SCANCODE_F11, KEY_F11},
    {SDL_SCANCODE_F12, KEY_F12},
    {SDL_SCANCODE_PRINTSCREEN, KEY_SYSRQ},
    {SDL_SCANCODE_SCROLLLOCK, KEY_SCROLLLOCK},
    {SDL_SCANCODE_PAUSE, KEY_PAUSE},
    {SDL_SCANCODE_INSERT, KEY_INSERT},
    {SDL_SCANCODE_HOME, KEY_HOME},
    {SDL_SCANCODE_PAGEUP, KEY_PAGEUP},
    {SDL_SCANCODE_DELETE, KEY_DELETE},
    {SDL_SCANCODE_END, KEY_END},
    {SDL_SCANCODE_PAGEDOWN, KEY_PAGEDOWN},
    {SDL_SCANCODE_RIGHT, KEY_RIGHT},
    {SDL_SCANCODE_LEFT, KEY_LEFT},
    {SDL_SCANCODE_DOWN, KEY_DOWN},
    {SDL_SCANCODE_UP, KEY_UP},
    {SDL_SCANCODE_NUMLOCKCLEAR, KEY_NUMLOCK},
    {SDL_SCANCODE_KP_DIVIDE, KEY_KPSLASH},
    {SDL_SCANCODE_KP_MULTIPLY, KEY_KPASTERISK},
    {SDL_SCANCODE_KP_MINUS, KEY_KPMINUS},
    {SDL_SCANCODE_KP_PLUS, KEY_KPPLUS},
    {SDL_SCANCODE_KP_ENTER, KEY_KPENTER},
    {SDL_SCANCODE_KP_0, KEY_KP0},
    {SDL_SCANCODE_KP_1, KEY_KP1},
    {SDL_SCANCODE_KP_2, KEY_KP2},
    {SDL_SCANCODE_KP_3, KEY_KP3},
    {SDL_SCANCODE_KP_4, KEY_KP4},
    {SDL_SCANCODE_KP_5, KEY_KP5},
    {SDL_SCANCODE_KP_6, KEY_KP6},
    {SDL_SCANCODE_KP_7, KEY_KP7},
    {SDL_SCANCODE_KP_8, KEY_KP8},
    {SDL_SCANCODE_KP_9, KEY_KP9},
    {SDL_SCANCODE_KP_PERIOD, KEY_KPDOT},
    {SDL_SCANCODE_NONUSBACKSLASH, KEY_102ND},
    {SDL_SCANCODE_APPLICATION, KEY_COMPOSE},
    {SDL_SCANCODE_POWER, KEY_POWER},
    {SDL_SCANCODE_MENU, KEY_MENU},
    {SDL_SCANCODE_STOP, KEY_STOP},
    {SDL_SCANCODE_MUTE, KEY_MUTE},
    {SDL_SCANCODE_VOLUMEUP, KEY_VOLUMEUP},
    {SDL_SCANCODE_VOLUMEDOWN, KEY_VOLUMEDOWN},
    {SDL_SCANCODE_SELECT, KEY_SELECT},
    {SDL_SCANCODE_LCTRL, KEY_LEFTCTRL},
    {SDL_SCANCODE_LSHIFT, KEY_LEFTSHIFT},
    {SDL_SCANCODE_LALT, KEY_LEFTALT},
    {SDL_SCANCODE_LGUI, KEY_LEFTMETA},
    {SDL_SCANCODE_RCTRL, KEY_RIGHTCTRL},
    {SDL_SCANCODE_RSHIFT, KEY_RIGHTSHIFT},
    {SDL_SCANCODE_RALT, KEY_RIGHTALT},
    {SDL_SCANCODE_RGUI, KEY_RIGHTMETA},
    {SDL_SCANCODE_AUDIONEXT, KEY_NEXTSONG},
    {SDL_SCANCODE_AUDIOPREV, KEY_PREVIOUSSONG},
    {SDL_SCANCODE_AUDIOSTOP, KEY_STOPCD},
    {SDL_SCANCODE_AUDIOPLAY, KEY_PLAYPAUSE},
    {SDL_SCANCODE_AUDIOMUTE, KEY_MUTE},
    {SDL_SCANCODE_AUDIOREWIND, KEY_REWIND},
    {SDL_SCANCODE_AUDIOFASTFORWARD, KEY_FASTFORWARD},
    {SDL_SCANCODE_AC_BACK, KEY_BACK},
    {SDL_SCANCODE_AC_FORWARD, KEY_FORWARD},
    {SDL_SCANCODE_AC_HOME, KEY_HOMEPAGE},
    {SDL_SCANCODE_EJECT, KEY_EJECTCD},
    {SDL_SCANCODE_SLEEP, KEY_SLEEP},
};

// What Shift makes of these in the USA: the table is asked where SDL tells no text, as with Ctrl, or over SDL 3.
constexpr std::pair<char, char> kShifted[] = {{'1', '!'}, {'2', '@'}, {'3', '#'}, {'4', '$'}, {'5', '%'}, {'6', '^'},
                                              {'7', '&'}, {'8', '*'}, {'/', '?'}, {',', '<'}, {'.', '>'}};

// The first code point of UTF-8.
int firstOf(std::string_view text) noexcept {
  const auto at = [text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
  const auto next = [at](std::size_t i) { return at(i) & 0x3f; };
  if (at(0) < 0x80) return at(0);
  if (at(0) < 0xe0) return (at(0) & 0x1f) << 6 | next(1);
  if (at(0) < 0xf0) return (at(0) & 0x0f) << 12 | next(1) << 6 | next(2);
  return (at(0) & 0x07) << 18 | next(1) << 12 | next(2) << 6 | next(3);
}

int signOf(const SDL_Keysym& key, std::string_view typed) noexcept {
  if (!typed.empty()) return firstOf(typed);
  if ((key.mod & KMOD_SHIFT) == 0) return key.sym;
  const auto* const found = std::ranges::find(kShifted, key.sym, &std::pair<char, char>::first);
  return found == std::end(kShifted) ? key.sym : found->second;
}

std::optional<std::uint16_t> codeOf(int scancode) noexcept {
  for (const KeyPair& key : kKeys) {
    if (key.scancode == scancode) return key.code;
  }
  return std::nullopt;
}

// A letter or sign that no key of the USA has. Scripts without Latin letters are typed on the keys of the USA.
bool isOtherLatin(int sign) noexcept {
  constexpr int kLatin = 0xa0, kIpa = 0x250, kPunctuation = 0x2000, kCjk = 0x2e80;
  return (sign >= kLatin && sign < kIpa) || (sign >= kPunctuation && sign < kCjk);
}

// Where a keyboard has letters and signs. One without a sign there only adds an accent to the next letter.
bool isForSigns(SDL_Scancode scancode) noexcept {
  return scancode == SDL_SCANCODE_NONUSBACKSLASH || (scancode >= SDL_SCANCODE_A && scancode <= SDL_SCANCODE_0) ||
         (scancode >= SDL_SCANCODE_MINUS && scancode <= SDL_SCANCODE_SLASH);
}

// SDL's scancodes of the letters are in the order of the alphabet, and so are its symbols.
int positionInUsa(const SDL_Keysym& key) noexcept {
  const bool letter = key.sym >= SDLK_a && key.sym <= SDLK_z;
  return letter ? SDL_SCANCODE_A + (key.sym - SDLK_a) : key.scancode;
}

}  // namespace

std::optional<std::uint16_t> linuxKey(const SDL_Keysym& key, std::string_view typed) noexcept {
  const bool has_no_sign = (key.sym & SDLK_SCANCODE_MASK) != 0;  // or is on the keypad
  const int sign = has_no_sign && !isForSigns(key.scancode) ? 0 : signOf(key, typed);
  const bool untold =
      typed.empty() && (key.mod & KMOD_RALT) != 0 && isForSigns(key.scancode);  // what AltGr makes of it
  if (untold || isOtherLatin(sign) || (has_no_sign && sign == key.sym)) return KEY_UNKNOWN;
  if (const auto code = keyOfSign(sign)) return code;
  const bool shifted_digit = sign >= '1' && sign <= '8' && (key.mod & KMOD_SHIFT) != 0;
  if (shifted_digit) return static_cast<std::uint16_t>(KEY_NUMERIC_1 + (sign - '1'));
  return codeOf(positionInUsa(key));
}

}  // namespace relievo
