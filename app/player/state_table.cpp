// SPDX-License-Identifier: Apache-2.0
// Every transition of the player, and nothing else.
#include "app/player/state_table.h"

#include <array>
#include <map>
#include <utility>

namespace relievo {
namespace {

using S = PlayerState;
using E = PlayerEvent;

struct Transition {
  S from;
  E on;
  S to;
};

constexpr std::array kTransitions{
    Transition{S::Boot, E::Ready, S::Idle},
    Transition{S::Boot, E::Fail, S::Fault},

    Transition{S::Idle, E::Open, S::Opening},
    Transition{S::Idle, E::Browse, S::Browsing},
    Transition{S::Idle, E::Fail, S::Fault},  // of the display

    Transition{S::Browsing, E::Open, S::Opening},
    Transition{S::Browsing, E::Stop, S::Idle},
    Transition{S::Browsing, E::Fail, S::Fault},

    Transition{S::Opening, E::Open, S::Opening},  // another one, or the first of a list
    Transition{S::Opening, E::Opened, S::Buffering},
    Transition{S::Opening, E::Play, S::Opening},   // heard: plays when filled
    Transition{S::Opening, E::Pause, S::Opening},  // accepted: paused once filled
    Transition{S::Opening, E::Seek, S::Opening},   // heard: begins there
    Transition{S::Opening, E::Stop, S::Idle},
    Transition{S::Opening, E::Fail, S::Fault},

    Transition{S::Buffering, E::Open, S::Opening},
    Transition{S::Buffering, E::Filled, S::Playing},
    Transition{S::Buffering, E::FilledHeld, S::Paused},
    Transition{S::Buffering, E::Play, S::Buffering},   // heard: plays when filled
    Transition{S::Buffering, E::Pause, S::Buffering},  // accepted: paused once filled
    Transition{S::Buffering, E::Rate, S::Buffering},   // heard
    Transition{S::Buffering, E::Seek, S::Seeking},
    Transition{S::Buffering, E::EndOfFilm, S::Ended},  // sought to beyond the end
    Transition{S::Buffering, E::Stop, S::Idle},
    Transition{S::Buffering, E::Fail, S::Fault},

    Transition{S::Playing, E::Open, S::Opening},
    Transition{S::Playing, E::Pause, S::Paused},
    Transition{S::Playing, E::Step, S::Paused},
    Transition{S::Playing, E::Rate, S::Playing},
    Transition{S::Playing, E::Seek, S::Seeking},
    Transition{S::Playing, E::Starved, S::Buffering},
    Transition{S::Playing, E::EndOfFilm, S::Ended},
    Transition{S::Playing, E::Stop, S::Idle},
    Transition{S::Playing, E::Fail, S::Fault},

    Transition{S::Paused, E::Open, S::Opening},
    Transition{S::Paused, E::Play, S::Playing},
    Transition{S::Paused, E::Step, S::Paused},
    Transition{S::Paused, E::Rate, S::Paused},
    Transition{S::Paused, E::Seek, S::Seeking},
    Transition{S::Paused, E::Stop, S::Idle},
    Transition{S::Paused, E::Fail, S::Fault},

    Transition{S::Seeking, E::Open, S::Opening},
    Transition{S::Seeking, E::Sought, S::Buffering},
    Transition{S::Seeking, E::Seek, S::Seeking},  // heard: the newest target holds
    Transition{S::Seeking, E::Play, S::Seeking},
    Transition{S::Seeking, E::Pause, S::Seeking},
    Transition{S::Seeking, E::Rate, S::Seeking},
    Transition{S::Seeking, E::Stop, S::Idle},
    Transition{S::Seeking, E::Fail, S::Fault},

    Transition{S::Ended, E::Open, S::Opening},
    Transition{S::Ended, E::Loop, S::Seeking},
    Transition{S::Ended, E::Stop, S::Idle},
    Transition{S::Ended, E::Fail, S::Fault},

    Transition{S::Fault, E::Open, S::Opening},
    Transition{S::Fault, E::Stop, S::Idle},
};

constexpr bool hasOneRowPerPair() {
  for (std::size_t i = 0; i < kTransitions.size(); ++i) {
    for (std::size_t k = i + 1; k < kTransitions.size(); ++k) {
      if (kTransitions[i].from == kTransitions[k].from && kTransitions[i].on == kTransitions[k].on) return false;
    }
  }
  return true;
}
static_assert(hasOneRowPerPair());

constexpr std::array<const char*, kPlayerStateCount> kNames{"boot",    "idle",   "browsing", "opening", "buffering",
                                                            "playing", "paused", "seeking",  "ended",   "fault"};
constexpr std::array<const char*, kPlayerEventCount> kEventNames{
    "ready", "browse", "open",   "opened",  "filled",      "filled, held", "play", "pause", "step",
    "rate",  "seek",   "sought", "starved", "end of film", "loop",         "stop", "fail"};

}  // namespace

std::optional<PlayerState> nextState(PlayerState state, PlayerEvent event) noexcept {
  for (const Transition& t : kTransitions) {
    if (t.from == state && t.on == event) return t.to;
  }
  return std::nullopt;
}

const char* name(PlayerState state) noexcept {
  return kNames[static_cast<std::size_t>(state)];
}

const char* name(PlayerEvent event) noexcept {
  return kEventNames[static_cast<std::size_t>(event)];
}

// An arrow for each pair of states, with all events that lead along it.
std::string stateGraph() {
  std::map<std::pair<S, S>, std::string> arrows;
  for (const Transition& t : kTransitions) {
    std::string& label = arrows[{t.from, t.to}];
    label += (label.empty() ? "" : "\\n") + std::string(name(t.on));
  }
  std::string graph = "digraph player {\n  node [shape=box, style=rounded]\n  boot [style=\"rounded,bold\"]\n";
  for (const auto& [ends, label] : arrows) {
    graph += std::string("  ") + name(ends.first) + " -> " + name(ends.second) + " [label=\"" + label + "\"]\n";
  }
  return graph + "}\n";
}

}  // namespace relievo
