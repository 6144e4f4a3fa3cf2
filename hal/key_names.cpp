// SPDX-License-Identifier: Apache-2.0
// A table of names, searched linearly, since a script is read only once.
#include "hal/key_names.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "platform/text/near_words.h"

namespace relievo {
namespace {

struct KeyName {
  std::string_view name;
  std::uint16_t code;
};

#define RELIEVO_KEY(name) {#name, KEY_##name}
#define RELIEVO_BUTTON(name) {"BTN_" #name, BTN_##name}
constexpr KeyName kKeys[] = {
    // Transport.
    RELIEVO_KEY(PLAY),
    RELIEVO_KEY(PAUSE),
    RELIEVO_KEY(PLAYPAUSE),
    RELIEVO_KEY(PLAYCD),
    RELIEVO_KEY(PAUSECD),
    RELIEVO_KEY(STOP),
    RELIEVO_KEY(STOPCD),
    RELIEVO_KEY(REWIND),
    RELIEVO_KEY(FASTFORWARD),
    RELIEVO_KEY(FORWARD),
    RELIEVO_KEY(BACK),
    RELIEVO_KEY(NEXT),
    RELIEVO_KEY(PREVIOUS),
    RELIEVO_KEY(NEXTSONG),
    RELIEVO_KEY(PREVIOUSSONG),
    RELIEVO_KEY(RECORD),
    RELIEVO_KEY(SLOW),
    RELIEVO_KEY(EJECTCD),
    RELIEVO_KEY(RESTART),
    // Menus.
    RELIEVO_KEY(OK),
    RELIEVO_KEY(SELECT),
    RELIEVO_KEY(ENTER),
    RELIEVO_KEY(ESC),
    RELIEVO_KEY(EXIT),
    RELIEVO_KEY(MENU),
    RELIEVO_KEY(HOMEPAGE),
    RELIEVO_KEY(INFO),
    RELIEVO_KEY(EPG),
    RELIEVO_KEY(TITLE),
    RELIEVO_KEY(SUBTITLE),
    RELIEVO_KEY(LANGUAGE),
    RELIEVO_KEY(AUDIO),
    RELIEVO_KEY(VIDEO),
    RELIEVO_KEY(TV),
    RELIEVO_KEY(LIST),
    RELIEVO_KEY(3D_MODE),
    RELIEVO_KEY(ZOOM),
    RELIEVO_KEY(ANGLE),
    RELIEVO_KEY(OPTION),
    RELIEVO_KEY(SETUP),
    RELIEVO_KEY(CONFIG),
    RELIEVO_KEY(HELP),
    RELIEVO_KEY(SEARCH),
    RELIEVO_KEY(RED),
    RELIEVO_KEY(GREEN),
    RELIEVO_KEY(YELLOW),
    RELIEVO_KEY(BLUE),
    RELIEVO_KEY(UP),
    RELIEVO_KEY(DOWN),
    RELIEVO_KEY(LEFT),
    RELIEVO_KEY(RIGHT),
    RELIEVO_KEY(PAGEUP),
    RELIEVO_KEY(PAGEDOWN),
    RELIEVO_KEY(HOME),
    RELIEVO_KEY(END),
    RELIEVO_KEY(CHANNELUP),
    RELIEVO_KEY(CHANNELDOWN),
    RELIEVO_KEY(CHANNEL),
    RELIEVO_KEY(FAVORITES),
    // Sound and power.
    RELIEVO_KEY(MUTE),
    RELIEVO_KEY(VOLUMEUP),
    RELIEVO_KEY(VOLUMEDOWN),
    RELIEVO_KEY(POWER),
    RELIEVO_KEY(POWER2),
    RELIEVO_KEY(SLEEP),
    RELIEVO_KEY(WAKEUP),
    RELIEVO_KEY(BRIGHTNESSUP),
    RELIEVO_KEY(BRIGHTNESSDOWN),
    // A remote's digits.
    RELIEVO_KEY(NUMERIC_0),
    RELIEVO_KEY(NUMERIC_1),
    RELIEVO_KEY(NUMERIC_2),
    RELIEVO_KEY(NUMERIC_3),
    RELIEVO_KEY(NUMERIC_4),
    RELIEVO_KEY(NUMERIC_5),
    RELIEVO_KEY(NUMERIC_6),
    RELIEVO_KEY(NUMERIC_7),
    RELIEVO_KEY(NUMERIC_8),
    RELIEVO_KEY(NUMERIC_9),
    RELIEVO_KEY(NUMERIC_STAR),
    RELIEVO_KEY(NUMERIC_POUND),
    // A gamepad.
    RELIEVO_BUTTON(SOUTH),
    RELIEVO_BUTTON(EAST),
    RELIEVO_BUTTON(NORTH),
    RELIEVO_BUTTON(WEST),
    RELIEVO_BUTTON(TL),
    RELIEVO_BUTTON(TR),
    RELIEVO_BUTTON(SELECT),
    RELIEVO_BUTTON(START),
    RELIEVO_BUTTON(MODE),
    RELIEVO_BUTTON(THUMBR),
    RELIEVO_BUTTON(DPAD_UP),
    RELIEVO_BUTTON(DPAD_DOWN),
    RELIEVO_BUTTON(DPAD_LEFT),
    RELIEVO_BUTTON(DPAD_RIGHT),
    // A keyboard.
    RELIEVO_KEY(0),
    RELIEVO_KEY(1),
    RELIEVO_KEY(2),
    RELIEVO_KEY(3),
    RELIEVO_KEY(4),
    RELIEVO_KEY(5),
    RELIEVO_KEY(6),
    RELIEVO_KEY(7),
    RELIEVO_KEY(8),
    RELIEVO_KEY(9),
    RELIEVO_KEY(A),
    RELIEVO_KEY(B),
    RELIEVO_KEY(C),
    RELIEVO_KEY(D),
    RELIEVO_KEY(E),
    RELIEVO_KEY(F),
    RELIEVO_KEY(G),
    RELIEVO_KEY(H),
    RELIEVO_KEY(I),
    RELIEVO_KEY(J),
    RELIEVO_KEY(K),
    RELIEVO_KEY(L),
    RELIEVO_KEY(M),
    RELIEVO_KEY(N),
    RELIEVO_KEY(O),
    RELIEVO_KEY(P),
    RELIEVO_KEY(Q),
    RELIEVO_KEY(R),
    RELIEVO_KEY(S),
    RELIEVO_KEY(T),
    RELIEVO_KEY(U),
    RELIEVO_KEY(V),
    RELIEVO_KEY(W),
    RELIEVO_KEY(X),
    RELIEVO_KEY(Y),
    RELIEVO_KEY(Z),
    RELIEVO_KEY(SPACE),
    RELIEVO_KEY(TAB),
    RELIEVO_KEY(BACKSPACE),
    RELIEVO_KEY(DELETE),
    RELIEVO_KEY(INSERT),
    RELIEVO_KEY(MINUS),
    RELIEVO_KEY(EQUAL),
    RELIEVO_KEY(COMMA),
    RELIEVO_KEY(DOT),
    RELIEVO_KEY(LEFTBRACE),
    RELIEVO_KEY(RIGHTBRACE),
    RELIEVO_KEY(SLASH),
    RELIEVO_KEY(BACKSLASH),
    RELIEVO_KEY(SEMICOLON),
    RELIEVO_KEY(APOSTROPHE),
    RELIEVO_KEY(GRAVE),
    RELIEVO_KEY(QUESTION),
    RELIEVO_KEY(KPENTER),
    RELIEVO_KEY(KPASTERISK),
    RELIEVO_KEY(KPSLASH),
    RELIEVO_KEY(KPPLUS),
    RELIEVO_KEY(KPMINUS),
    RELIEVO_KEY(F1),
    RELIEVO_KEY(F2),
    RELIEVO_KEY(F3),
    RELIEVO_KEY(F4),
    RELIEVO_KEY(F5),
    RELIEVO_KEY(F6),
    RELIEVO_KEY(F7),
    RELIEVO_KEY(F8),
    RELIEVO_KEY(F9),
    RELIEVO_KEY(F10),
    RELIEVO_KEY(F11),
    RELIEVO_KEY(F12),
};
#undef RELIEVO_BUTTON
#undef RELIEVO_KEY

// Compares without regard to case; `upper` is in upper case, like the table above.
bool equalInUpperCase(std::string_view word, std::string_view upper) noexcept {
  return std::equal(word.begin(), word.end(), upper.begin(), upper.end(),
                    [](char a, char b) { return std::toupper(static_cast<unsigned char>(a)) == b; });
}

std::string_view withoutPrefix(std::string_view name) noexcept {
  constexpr std::string_view kPrefix = "KEY_";
  if (equalInUpperCase(name.substr(0, kPrefix.size()), kPrefix)) name.remove_prefix(kPrefix.size());
  return name;
}

constexpr std::string_view kCtrl = "CTRL_", kShift = "SHIFT_";

// Takes the prefix off; `held` if it was there, else 0.
std::uint16_t takeHeld(std::string_view& name, std::string_view prefix, std::uint16_t held) noexcept {
  if (!equalInUpperCase(name.substr(0, prefix.size()), prefix)) return 0;
  name.remove_prefix(prefix.size());
  return held;
}

// Keeps letters and digits only, in upper case.
std::string essence(std::string_view word) {
  std::string kept;
  for (const char c : word) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      kept += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return kept;
}

}  // namespace

std::optional<std::uint16_t> keyCode(std::string_view name) noexcept {
  std::uint16_t held = takeHeld(name, kCtrl, kWithCtrl);
  held |= takeHeld(name, kShift, kWithShift);
  name = withoutPrefix(name);
  for (const KeyName& key : kKeys) {
    if (equalInUpperCase(name, key.name)) return key.code | held;
  }
  return std::nullopt;
}

std::string keyName(std::uint16_t code) {
  const auto* const key = std::ranges::find(kKeys, withoutShiftAndCtrl(code), &KeyName::code);
  if (key == std::end(kKeys)) return "";
  std::string name((code & kWithCtrl) != 0 ? kCtrl : "");
  if ((code & kWithShift) != 0) name += kShift;
  return name.append(key->name);
}

bool isPadButton(std::uint16_t code) noexcept {
  return (code >= BTN_GAMEPAD && code <= BTN_THUMBR) || (code >= BTN_DPAD_UP && code <= BTN_DPAD_RIGHT);
}

std::string_view nearestKeyName(std::string_view word) {
  const std::string wanted = essence(withoutPrefix(word));
  std::size_t least = leastDifference(wanted);
  std::string_view nearest;
  for (const KeyName& key : kKeys) {
    const std::size_t distance = editDistance(wanted, essence(key.name));
    if (distance >= least) continue;
    least = distance;
    nearest = key.name;
  }
  return nearest;
}

}  // namespace relievo
