// SPDX-License-Identifier: Apache-2.0
// Tables of labels; a letter, a digit or a function key is its own.
#include "app/player/control/key_label.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <string_view>

#include "hal/key_names.h"
#include "hal/key_signs.h"

namespace relievo {
namespace {

struct Label {
  std::uint16_t code;
  std::string_view text;
};

// Keys whose sign is hard to see, and those without one.
constexpr Label kOnKeyboards[] = {
    {KEY_SPACE, "Space"},    {KEY_ESC, "Esc"},
    {KEY_ENTER, "Enter"},    {KEY_KPENTER, "Enter"},
    {KEY_TAB, "Tab"},        {KEY_BACKSPACE, "Backspace"},
    {KEY_RIGHT, "Right"},    {KEY_LEFT, "Left"},
    {KEY_UP, "Up"},          {KEY_DOWN, "Down"},
    {KEY_HOME, "Home"},      {KEY_END, "End"},
    {KEY_PAGEUP, "Page Up"}, {KEY_PAGEDOWN, "Page Down"},
    {KEY_INSERT, "Insert"},  {KEY_DELETE, "Delete"},
    {KEY_PAUSE, "Pause"},    {KEY_CAPSLOCK, "Caps Lock"},
    {KEY_SYSRQ, "Print"},    {KEY_COMPOSE, "Menu"},
    {KEY_DOT, ". (dot)"},    {KEY_COMMA, ", (comma)"},
    {KEY_KPMINUS, "-"},      {KEY_KPSLASH, "/"},
};
constexpr Label kOnRemotes[] = {
    {KEY_OK, "OK"},
    {KEY_SELECT, "OK"},
    {KEY_UP, "Up"},
    {KEY_DOWN, "Down"},
    {KEY_LEFT, "Left"},
    {KEY_RIGHT, "Right"},
    {KEY_BACK, "Back"},
    {KEY_EXIT, "Exit"},
    {KEY_POWER, "Power"},
    {KEY_STOP, "Stop"},
    {KEY_STOPCD, "Stop"},
    {KEY_PLAY, "Play"},
    {KEY_PLAYCD, "Play"},
    {KEY_PAUSE, "Pause"},
    {KEY_PAUSECD, "Pause"},
    {KEY_PLAYPAUSE, "Play/Pause"},
    {KEY_FASTFORWARD, "Fast Forward"},
    {KEY_FORWARD, "Forward"},
    {KEY_REWIND, "Rewind"},
    {KEY_SLOW, "Slow"},
    {KEY_NEXT, "Next"},
    {KEY_NEXTSONG, "Next"},
    {KEY_PREVIOUS, "Previous"},
    {KEY_PREVIOUSSONG, "Previous"},
    {KEY_CHANNELUP, "Channel +"},
    {KEY_CHANNELDOWN, "Channel -"},
    {KEY_VOLUMEUP, "Volume +"},
    {KEY_VOLUMEDOWN, "Volume -"},
    {KEY_MUTE, "Mute"},
    {KEY_RED, "Red"},
    {KEY_GREEN, "Green"},
    {KEY_YELLOW, "Yellow"},
    {KEY_BLUE, "Blue"},
    {KEY_3D_MODE, "3D"},
    {KEY_SUBTITLE, "Subtitle"},
    {KEY_AUDIO, "Audio"},
    {KEY_LANGUAGE, "Language"},
    {KEY_ZOOM, "Zoom"},
    {KEY_INFO, "Info"},
    {KEY_HELP, "Help"},
    {KEY_MENU, "Menu"},
};
constexpr Label kOnPads[] = {
    {BTN_SOUTH, "Pad A or Cross"},
    {BTN_EAST, "Pad B or Circle"},
    {BTN_NORTH, "Pad X or Triangle"},
    {BTN_WEST, "Pad Y or Square"},
    {BTN_TL, "Pad LB or L1"},
    {BTN_TR, "Pad RB or R1"},
    {BTN_SELECT, "Pad Select"},
    {BTN_START, "Pad Start"},
    {BTN_MODE, "Pad Guide"},
    {BTN_THUMBR, "Pad right stick pressed"},
    {BTN_DPAD_UP, "Pad Up"},
    {BTN_DPAD_DOWN, "Pad Down"},
    {BTN_DPAD_LEFT, "Pad Left"},
    {BTN_DPAD_RIGHT, "Pad Right"},
    {KEY_VOLUMEUP, "Pad right stick up"},
    {KEY_VOLUMEDOWN, "Pad right stick down"},
};

std::string_view find(std::span<const Label> labels, std::uint16_t code) noexcept {
  const auto label = std::ranges::find(labels, code, &Label::code);
  return label == labels.end() ? std::string_view{} : label->text;
}

bool isDigit(std::uint16_t code) noexcept {
  return code >= KEY_NUMERIC_0 && code <= KEY_NUMERIC_9;
}

// "OK", "Channel +", "Red"; for a key that only keyboards have, its keyboard label. A key without a label is called by
// its name, "Favorites".
std::string remoteLabel(std::uint16_t code) {
  if (isDigit(code)) return std::to_string(code - KEY_NUMERIC_0);
  if (const auto label = find(kOnRemotes, code); !label.empty()) return std::string(label);
  if (std::string label = keyboardLabel(code); !label.empty()) return label;
  std::string name = keyName(code);
  for (std::size_t i = 1; i < name.size(); ++i) {
    name[i] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  return name;
}

}  // namespace

std::string keyboardLabel(std::uint16_t code) {
  if (const auto label = find(kOnKeyboards, code); !label.empty()) return std::string(label);
  if (const char sign = signOfKey(code); sign != '\0') return {sign};
  if (const std::uint16_t alone = withoutShiftAndCtrl(code); alone != code) {
    return ((code & kWithCtrl) != 0 ? "Ctrl+" : "Shift+") + keyboardLabel(alone);
  }
  std::string name = keyName(code);
  const bool function = name.size() > 1 && name.size() <= 3 && name[0] == 'F' && std::isdigit(name[1]) != 0;
  if (name.size() != 1) return function ? name : "";
  name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

std::string padLabel(std::uint16_t code) {
  return std::string(find(kOnPads, code));
}

bool isOnRemotes(std::uint16_t code) noexcept {
  if (isPadButton(code)) return false;
  return isDigit(code) || !find(kOnRemotes, code).empty() || keyboardLabel(code).empty();
}

std::vector<std::pair<std::string, std::string>> mouseRows(bool in_list, bool touches) {
  if (in_list) return {{"Click", "play that film"}, {"Wheel", "up and down the list"}, {"Drop a film here", "play it"}};
  std::vector<std::pair<std::string, std::string>> rows;
  if (touches) {
    rows = {{"Hold the mouse button", "touch the film there"}, {"Wheel", "the finger away from you, or nearer"}};
  }
  rows.emplace_back(touches ? "Wheel over the bar" : "Wheel", "louder, or quieter");
  rows.emplace_back("Click or drag on the bar", "to that time");
  rows.emplace_back("Double click", "full screen on or off");
  rows.emplace_back("Right click", "pause or continue");
  rows.emplace_back("Drop a film here", "play it");
  rows.emplace_back("Drop subtitles here", "show them with the film");
  return rows;
}

std::string keyLabel(std::uint16_t code, KeyBoard held) {
  const bool pad = held == KeyBoard::Pad || isPadButton(code);
  const std::string label = pad ? padLabel(code) : held == KeyBoard::Keyboard ? keyboardLabel(code) : "";
  return label.empty() ? remoteLabel(code) : label;
}

}  // namespace relievo
