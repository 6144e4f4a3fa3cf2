// SPDX-License-Identifier: Apache-2.0
// The usual keys. CEC keys come as the codes that the kernel's rc-cec map gives them.
#include "app/player/control/key_table.h"

namespace relievo {
namespace {

// A keyboard's keys are mpv's where both players do the same, and Kodi's where mpv has others; a remote control's are
// Kodi's.
constexpr std::string_view kUsual = R"([always]
# a keyboard
SPACE = "play-pause"
P = "play-pause"
SHIFT_P = "info"
F = "full-screen"
F11 = "full-screen"
BACKSLASH = "full-screen"
ESC = "escape"
Q = "quit"
CTRL_W = "quit"
RIGHT = "seek +5"
LEFT = "seek -5"
UP = "seek +60"
DOWN = "seek -60"
SHIFT_RIGHT = "seek +1"
SHIFT_LEFT = "seek -1"
SHIFT_UP = "seek +5"
SHIFT_DOWN = "seek -5"
SHIFT_PAGEUP = "seek +600"
SHIFT_PAGEDOWN = "seek -600"
HOME = "seek 0%"
DOT = "step"
COMMA = "step-back"
LEFTBRACE = "slower"
RIGHTBRACE = "faster"
BACKSPACE = "normal-speed"
PAGEUP = "chapter +1"
PAGEDOWN = "chapter -1"
SHIFT_2 = "chapter +1"
SHIFT_1 = "chapter -1"
L = "ab-loop"
SHIFT_L = "loop"
N = "next"
B = "previous"
0 = "volume +5"
9 = "volume -5"
EQUAL = "volume +5"
MINUS = "volume -5"
KPPLUS = "volume +5"
KPMINUS = "volume -5"
KPASTERISK = "volume +5"
KPSLASH = "volume -5"
M = "mute"
F8 = "mute"
V = "show-subtitles"
T = "show-subtitles"
J = "subtitles"
SHIFT_J = "subtitles previous"
Z = "subtitle-delay -0.1"
X = "subtitle-delay +0.1"
SHIFT_Z = "subtitle-delay +0.1"
SHIFT_G = "subtitle-size +0.1"
SHIFT_F = "subtitle-size -0.1"
NUMERIC_POUND = "audio"
CTRL_EQUAL = "audio-delay +0.1"
CTRL_MINUS = "audio-delay -0.1"
CTRL_KPPLUS = "audio-delay +0.1"
CTRL_KPMINUS = "audio-delay -0.1"
S = "screenshot"
W = "zoom -0.1"
SHIFT_W = "zoom +0.1"
E = "zoom +0.1"
A = "aspect"
R = "rotate +90"
O = "info"
I = "statistics"
H = "keys"
F1 = "keys"
QUESTION = "keys"

# depth and eyes
TAB = "layout"
3D_MODE = "layout"
Y = "swap-eyes"
BLUE = { press = "layout", hold = "swap-eyes" }
F2 = "depth -0.1"
GREEN = "depth -0.1"
F3 = "depth +0.1"
YELLOW = "depth +0.1"
F4 = "screen -2"
F5 = "screen +2"

# a remote control
PLAY = "play"
PAUSE = "pause"
PLAYPAUSE = "play-pause"
OK = { press = "play-pause", hold = "info" }
STOP = "stop"
BACK = "back"
POWER = "stop"
FORWARD = "seek +10"
REWIND = "seek -10"
FASTFORWARD = "faster"
SLOW = "slower"
NEXT = "next"
CHANNELUP = "next"
PREVIOUS = "previous"
CHANNELDOWN = "previous"
RED = "loop"
VOLUMEUP = "volume +5"
VOLUMEDOWN = "volume -5"
MUTE = "mute"
SUBTITLE = "subtitles"
AUDIO = "audio"
LANGUAGE = "audio"
ZOOM = "full-screen"
INFO = "info"
MENU = "keys"
HELP = "keys"
NUMERIC_0 = "seek 0%"
NUMERIC_1 = "seek 10%"
NUMERIC_2 = "seek 20%"
NUMERIC_3 = "seek 30%"
NUMERIC_4 = "seek 40%"
NUMERIC_5 = "seek 50%"
NUMERIC_6 = "seek 60%"
NUMERIC_7 = "seek 70%"
NUMERIC_8 = "seek 80%"
NUMERIC_9 = "seek 90%"

# a gamepad; rows not given here are those of OK (BTN_SOUTH), BACK (BTN_EAST), MENU (BTN_START), INFO (BTN_SELECT), of
# the arrows (BTN_DPAD_UP, ..), and of VOLUMEUP and VOLUMEDOWN (the second stick)
BTN_NORTH = { press = "subtitles", hold = "audio" }
BTN_WEST = { press = "layout", hold = "full-screen" }
BTN_TL = "chapter -1"
BTN_TR = "chapter +1"
BTN_THUMBR = "mute"
BTN_MODE = { hold = "quit" }

[browsing]
UP = "select -1"
DOWN = "select +1"
PAGEUP = "select -5"
PAGEDOWN = "select +5"
BTN_TL = "select -5"
BTN_TR = "select +5"
BTN_WEST = "full-screen"
HOME = "select 1"
END = "select last"
OK = "choose"
RIGHT = "choose"
SPACE = "choose"
PLAY = "choose"
PLAYPAUSE = "choose"
LEFT = ""
STOP = ""

[paused]
FASTFORWARD = "step"
SLOW = "step"
)";

}  // namespace

std::string_view KeyTable::usualText() noexcept {
  return kUsual;
}

}  // namespace relievo
