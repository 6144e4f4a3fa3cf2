// SPDX-License-Identifier: Apache-2.0
// The key table. CEC keys come as the codes that the kernel's rc-cec map gives them; sets differ in which of two codes
// for the same word they send, so both are here.
#include "app/player/key_table.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <array>
#include <utility>

namespace relievo {
namespace {

struct Binding {
  std::uint16_t code;
  const char* name;
  PlayerCommand command;
  bool repeats = false;
};

#define RELIEVO_BIND(key, ...)                  \
  Binding {                                     \
    KEY_##key, #key, PlayerCommand::__VA_ARGS__ \
  }
constexpr std::array kBindings{
    RELIEVO_BIND(PLAY, Play),
    RELIEVO_BIND(PLAYCD, Play),
    RELIEVO_BIND(PAUSE, Pause),
    RELIEVO_BIND(PAUSECD, Pause),
    RELIEVO_BIND(PLAYPAUSE, PlayPause),
    RELIEVO_BIND(OK, PlayPause),
    RELIEVO_BIND(ENTER, PlayPause),
    RELIEVO_BIND(SELECT, PlayPause),
    RELIEVO_BIND(SPACE, PlayPause),
    RELIEVO_BIND(RIGHT, SeekForward, true),
    RELIEVO_BIND(FASTFORWARD, SeekForward, true),
    RELIEVO_BIND(LEFT, SeekBackward, true),
    RELIEVO_BIND(REWIND, SeekBackward, true),
    RELIEVO_BIND(3D_MODE, NextLayout),
    RELIEVO_BIND(TAB, NextLayout),
    RELIEVO_BIND(S, NextLayout),
    RELIEVO_BIND(BLUE, SwapEyes),
    RELIEVO_BIND(E, SwapEyes),
    RELIEVO_BIND(UP, DeeperPicture, true),
    RELIEVO_BIND(DOWN, FlatterPicture, true),
    RELIEVO_BIND(PAGEUP, ScreenForward, true),
    RELIEVO_BIND(CHANNELUP, ScreenForward, true),
    RELIEVO_BIND(PAGEDOWN, ScreenBackward, true),
    RELIEVO_BIND(CHANNELDOWN, ScreenBackward, true),
    RELIEVO_BIND(INFO, Info),
    RELIEVO_BIND(I, Info),
    RELIEVO_BIND(STOP, Stop),
    RELIEVO_BIND(STOPCD, Stop),
    RELIEVO_BIND(BACK, Stop),
    RELIEVO_BIND(EXIT, Stop),
    RELIEVO_BIND(ESC, Stop),
    RELIEVO_BIND(POWER, Stop),
};
#undef RELIEVO_BIND

constexpr std::array kMeanings{
    std::pair{PlayerCommand::Play, "play"},
    std::pair{PlayerCommand::Pause, "pause"},
    std::pair{PlayerCommand::PlayPause, "pause, or go on"},
    std::pair{PlayerCommand::SeekForward, "10 s forward"},
    std::pair{PlayerCommand::SeekBackward, "10 s back"},
    std::pair{PlayerCommand::NextLayout, "the next way to show stereo"},
    std::pair{PlayerCommand::SwapEyes, "left eye right, right eye left"},
    std::pair{PlayerCommand::DeeperPicture, "more depth for the eyes"},
    std::pair{PlayerCommand::FlatterPicture, "less depth"},
    std::pair{PlayerCommand::ScreenForward, "the scene comes out of the screen"},
    std::pair{PlayerCommand::ScreenBackward, "the scene goes back"},
    std::pair{PlayerCommand::Info, "what is going on, as text on the screen, or no more"},
    std::pair{PlayerCommand::Stop, "end"},
};

}  // namespace

std::optional<PlayerCommand> commandOf(const KeyEvent& key) noexcept {
  if (key.action == KeyEvent::Action::Release) return std::nullopt;
  for (const Binding& binding : kBindings) {
    if (binding.code != key.code) continue;
    if (key.action == KeyEvent::Action::Repeat && !binding.repeats) return std::nullopt;
    return binding.command;
  }
  return std::nullopt;
}

std::string keyHelp() {
  constexpr std::size_t kColumn = 36;  // of the meanings
  std::string text;
  for (const auto& [command, meaning] : kMeanings) {
    std::string line = " ";
    for (const Binding& binding : kBindings) {
      if (binding.command == command) line += std::string(" ") + binding.name;
    }
    line.resize(std::max(kColumn, line.size() + 2), ' ');
    text += line + meaning + "\n";
  }
  return text;
}

}  // namespace relievo
