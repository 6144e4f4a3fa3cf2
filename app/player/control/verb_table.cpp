// SPDX-License-Identifier: Apache-2.0
#include "app/player/control/verb_table.h"

#include <algorithm>
#include <array>

namespace relievo {
namespace {

constexpr std::array kEntries{
    VerbEntry{PlayerVerb::Play, "play", Operand::None, "play"},
    VerbEntry{PlayerVerb::Pause, "pause", Operand::None, "pause"},
    VerbEntry{PlayerVerb::PlayPause, "play-pause", Operand::None, "pause or continue"},
    VerbEntry{PlayerVerb::Step, "step", Operand::None, "the next picture, paused", true},
    VerbEntry{PlayerVerb::StepBack, "step-back", Operand::None, "the previous picture, paused", true},
    VerbEntry{PlayerVerb::Faster, "faster", Operand::None, "faster, up to 16 times; from 2 times on without touch"},
    VerbEntry{PlayerVerb::Slower, "slower", Operand::None, "slower, down to 1/8, with touch"},
    VerbEntry{PlayerVerb::NormalSpeed, "normal-speed", Operand::None, "the usual speed again"},
    VerbEntry{PlayerVerb::SeekBy, "seek", Operand::Time, "s", true},
    VerbEntry{PlayerVerb::SeekTo, "seek", Operand::Time, "s"},
    VerbEntry{PlayerVerb::SeekShare, "seek", Operand::Time, "%"},
    VerbEntry{PlayerVerb::Next, "next", Operand::None, "the next film of the list"},
    VerbEntry{PlayerVerb::Previous, "previous", Operand::None,
              "this film from the beginning; within its first 3 s, the previous film"},
    VerbEntry{PlayerVerb::Loop, "loop", Operand::OnOff, "repeat at the end, on or off"},
    VerbEntry{PlayerVerb::Open, "open", Operand::Url, "another film"},
    VerbEntry{PlayerVerb::SelectBy, "select", Operand::Row, "", true},
    VerbEntry{PlayerVerb::SelectTo, "select", Operand::Row, ""},
    VerbEntry{PlayerVerb::Choose, "choose", Operand::None, "play the selected film"},
    VerbEntry{PlayerVerb::Back, "back", Operand::None, "to the list of films, or end the film"},
    VerbEntry{PlayerVerb::Escape, "escape", Operand::None, "leave this page or full screen, then to the list"},
    VerbEntry{PlayerVerb::Stop, "stop", Operand::None, "end the film"},
    VerbEntry{PlayerVerb::Quit, "quit", Operand::None, "end the program"},
    VerbEntry{PlayerVerb::Layout, "layout", Operand::Layout, "the next way to show 3D: side by side, .."},
    VerbEntry{PlayerVerb::FullScreen, "full-screen", Operand::OnOff, "full screen on or off"},
    VerbEntry{PlayerVerb::SwapEyes, "swap-eyes", Operand::None, "left eye right, right eye left"},
    VerbEntry{PlayerVerb::DepthBy, "depth", Operand::Step, "", true},
    VerbEntry{PlayerVerb::ScreenBy, "screen", Operand::Step, "", true},
    VerbEntry{PlayerVerb::ZoomBy, "zoom", Operand::Step, "", true},
    VerbEntry{PlayerVerb::Aspect, "aspect", Operand::Shape, "another shape of the picture"},
    VerbEntry{PlayerVerb::RotateBy, "rotate", Operand::Turn, ""},
    VerbEntry{PlayerVerb::Info, "info", Operand::None, "show or hide the bar with title and times"},
    VerbEntry{PlayerVerb::Statistics, "statistics", Operand::None, "show or hide statistics"},
    VerbEntry{PlayerVerb::Keys, "keys", Operand::None, "show or hide these keys"},
    VerbEntry{PlayerVerb::Screenshot, "screenshot", Operand::None, "save the picture as a PNG"},
    VerbEntry{PlayerVerb::VolumeBy, "volume", Operand::Level, "% louder", true},
    VerbEntry{PlayerVerb::VolumeTo, "volume", Operand::Level, "% volume"},
    VerbEntry{PlayerVerb::Mute, "mute", Operand::OnOff, "sound on or off"},
    VerbEntry{PlayerVerb::AudioTrack, "audio", Operand::Track, "the next sound track"},
    VerbEntry{PlayerVerb::AudioDelayBy, "audio-delay", Operand::Step, "sound", true},
    VerbEntry{PlayerVerb::SubtitleTrack, "subtitles", Operand::TrackOrOff, "the next subtitles, or none"},
    VerbEntry{PlayerVerb::ShowSubtitles, "show-subtitles", Operand::OnOff, "subtitles on or off"},
    VerbEntry{PlayerVerb::SubtitleDelayBy, "subtitle-delay", Operand::Step, "subtitles", true},
    VerbEntry{PlayerVerb::SubtitleSizeBy, "subtitle-size", Operand::Step, "subtitles", true},
    VerbEntry{PlayerVerb::ChapterBy, "chapter", Operand::Step, "chapter"},
    VerbEntry{PlayerVerb::LoopAB, "ab-loop", Operand::None, "repeat from here; again: to here; again: off"},
};

}  // namespace

std::span<const VerbEntry> verbTable() noexcept {
  return kEntries;
}

const VerbEntry& entryOf(PlayerVerb verb) noexcept {
  std::size_t i = 0;
  while (i + 1 < kEntries.size() && kEntries[i].verb != verb) ++i;
  return kEntries[i];
}

bool repeats(PlayerVerb verb) noexcept {
  return entryOf(verb).repeats;
}

bool needsFilm(PlayerVerb verb) noexcept {
  constexpr std::array kFree{PlayerVerb::Open,       PlayerVerb::SelectBy, PlayerVerb::SelectTo, PlayerVerb::Choose,
                             PlayerVerb::Back,       PlayerVerb::Escape,   PlayerVerb::Stop,     PlayerVerb::Quit,
                             PlayerVerb::FullScreen, PlayerVerb::Layout,   PlayerVerb::Keys,     PlayerVerb::VolumeBy,
                             PlayerVerb::VolumeTo,   PlayerVerb::Mute,     PlayerVerb::Loop,     PlayerVerb::SwapEyes};
  return std::ranges::find(kFree, verb) == kFree.end();
}

}  // namespace relievo
