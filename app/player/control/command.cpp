// SPDX-License-Identifier: Apache-2.0
// The table of the verbs, and their words both ways.
#include "app/player/control/command.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "app/player/screen/stereo_word.h"
#include "platform/print.h"

namespace relievo {
namespace {

// Step: a number with its sign (its meaning: see stepMeaning); Time: also without, or with %; Level: also without;
// Track: a number from 1 on, or off; Row: a whole number, with its sign or without, or last. OnOff, Layout, Shape and
// Track may be left away.
enum class Operand : std::uint8_t { None, Step, Time, Url, OnOff, Layout, Level, Track, Shape, Row };

struct Entry {
  PlayerVerb verb;
  const char* word;
  Operand operand;
  const char* meaning;  // of a Step or a Time: what follows the number
  bool repeats = false;
};

// SeekBy, SeekTo and SeekShare share a word: the number's form tells them apart.
constexpr std::array kEntries{
    Entry{PlayerVerb::Play, "play", Operand::None, "play"},
    Entry{PlayerVerb::Pause, "pause", Operand::None, "pause"},
    Entry{PlayerVerb::PlayPause, "play-pause", Operand::None, "pause, or go on"},
    Entry{PlayerVerb::Step, "step", Operand::None, "the next picture, and stand", true},
    Entry{PlayerVerb::StepBack, "step-back", Operand::None, "the picture before, and stand", true},
    Entry{PlayerVerb::Faster, "faster", Operand::None,
          "faster, up to 16 times; from 2 times on by key frames, without touch"},
    Entry{PlayerVerb::Slower, "slower", Operand::None, "slower, down to 1/8, with touch"},
    Entry{PlayerVerb::NormalSpeed, "normal-speed", Operand::None, "the usual speed again"},
    Entry{PlayerVerb::SeekBy, "seek", Operand::Time, "s", true},
    Entry{PlayerVerb::SeekTo, "seek", Operand::Time, "s"},
    Entry{PlayerVerb::SeekShare, "seek", Operand::Time, "%"},
    Entry{PlayerVerb::Next, "next", Operand::None, "the next film of the list"},
    Entry{PlayerVerb::Previous, "previous", Operand::None,
          "this film from the beginning; within its first 3 s, the previous film"},
    Entry{PlayerVerb::Loop, "loop", Operand::OnOff, "begin again at the end, or no longer"},
    Entry{PlayerVerb::Open, "open", Operand::Url, "another film"},
    Entry{PlayerVerb::SelectBy, "select", Operand::Row, "", true},
    Entry{PlayerVerb::SelectTo, "select", Operand::Row, ""},
    Entry{PlayerVerb::Choose, "choose", Operand::None, "play the selected film"},
    Entry{PlayerVerb::Back, "back", Operand::None, "to the list of films, or end the film"},
    Entry{PlayerVerb::Escape, "escape", Operand::None, "out of this page or of full screen, then to the list"},
    Entry{PlayerVerb::Stop, "stop", Operand::None, "end the film"},
    Entry{PlayerVerb::Quit, "quit", Operand::None, "end the program"},
    Entry{PlayerVerb::Layout, "layout", Operand::Layout, "the next way to show 3D: side by side, .."},
    Entry{PlayerVerb::FullScreen, "full-screen", Operand::OnOff, "the whole screen, or a window again"},
    Entry{PlayerVerb::SwapEyes, "swap-eyes", Operand::None, "left eye right, right eye left"},
    Entry{PlayerVerb::DepthBy, "depth", Operand::Step, "", true},
    Entry{PlayerVerb::ScreenBy, "screen", Operand::Step, "", true},
    Entry{PlayerVerb::ZoomBy, "zoom", Operand::Step, "", true},
    Entry{PlayerVerb::Aspect, "aspect", Operand::Shape, "another shape of the picture"},
    Entry{PlayerVerb::Info, "info", Operand::None, "the bar with title and times, or no more"},
    Entry{PlayerVerb::Statistics, "statistics", Operand::None, "statistics, or no more"},
    Entry{PlayerVerb::Keys, "keys", Operand::None, "these keys, or no more"},
    Entry{PlayerVerb::Screenshot, "screenshot", Operand::None, "save the picture as a PNG"},
    Entry{PlayerVerb::VolumeBy, "volume", Operand::Level, "% louder", true},
    Entry{PlayerVerb::VolumeTo, "volume", Operand::Level, "% volume"},
    Entry{PlayerVerb::Mute, "mute", Operand::OnOff, "sound off, or on again"},
    Entry{PlayerVerb::AudioTrack, "audio", Operand::Track, "the next sound track"},
    Entry{PlayerVerb::AudioDelayBy, "audio-delay", Operand::Step, "sound", true},
    Entry{PlayerVerb::SubtitleTrack, "subtitles", Operand::Track, "the next subtitles, or none"},
    Entry{PlayerVerb::ShowSubtitles, "show-subtitles", Operand::OnOff, "subtitles on or off"},
    Entry{PlayerVerb::SubtitleDelayBy, "subtitle-delay", Operand::Step, "subtitles", true},
    Entry{PlayerVerb::SubtitleSizeBy, "subtitle-size", Operand::Step, "subtitles", true},
    Entry{PlayerVerb::ChapterBy, "chapter", Operand::Step, "chapter"},
    Entry{PlayerVerb::LoopAB, "ab-loop", Operand::None, "repeat from here; again: to here; again: no more"},
};

const Entry& entryOf(PlayerVerb verb) noexcept {
  std::size_t i = 0;
  while (i + 1 < kEntries.size() && kEntries[i].verb != verb) ++i;
  return kEntries[i];
}

// The whole text, a finite number of at most a week in seconds.
std::optional<double> numberIn(std::string_view text) {
  constexpr double kMost = 7 * 24 * 3600.0;
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;  // from_chars takes that one
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= kMost)) return std::nullopt;
  return value;
}

std::optional<PlayerCommand> timeIn(std::string_view text) {
  const bool share = text.ends_with('%');
  if (share) text.remove_suffix(1);
  const auto value = numberIn(text);
  if (!value) return std::nullopt;
  const bool relative = text.starts_with('+') || text.starts_with('-');
  if (!share) return PlayerCommand{relative ? PlayerVerb::SeekBy : PlayerVerb::SeekTo, *value};
  if (relative || *value > 100) return std::nullopt;
  return PlayerCommand{PlayerVerb::SeekShare, *value / 100};
}

// Of the audio and subtitle tracks.
std::optional<PlayerCommand> trackIn(PlayerVerb verb, std::string_view text) {
  constexpr double kMostTracks = 100;
  if (text.empty()) return PlayerCommand{verb};
  if (text == "off" && verb == PlayerVerb::SubtitleTrack) return PlayerCommand{verb, -1};
  const auto number = numberIn(text);
  const bool good = number && *number >= 1 && *number <= kMostTracks && *number == std::floor(*number);
  return good ? std::optional(PlayerCommand{verb, *number}) : std::nullopt;
}

std::optional<PlayerCommand> levelIn(std::string_view text) {
  const auto value = numberIn(text);
  if (!value) return std::nullopt;
  const bool relative = text.starts_with('+') || text.starts_with('-');
  return PlayerCommand{relative ? PlayerVerb::VolumeBy : PlayerVerb::VolumeTo, *value};
}

// Of the list of films.
std::optional<PlayerCommand> rowIn(std::string_view text) {
  constexpr double kMostRows = 1e6;
  if (text == "last") return PlayerCommand{PlayerVerb::SelectTo};
  const auto value = numberIn(text);
  if (!value || *value != std::floor(*value) || std::abs(*value) > kMostRows) return std::nullopt;
  const bool relative = text.starts_with('+') || text.starts_with('-');
  if (!relative && *value < 1) return std::nullopt;
  return PlayerCommand{relative ? PlayerVerb::SelectBy : PlayerVerb::SelectTo, *value};
}

std::optional<PlayerCommand> withOperand(const Entry& entry, std::string_view operand) {
  switch (entry.operand) {
    case Operand::None:
      return operand.empty() ? std::optional(PlayerCommand{entry.verb}) : std::nullopt;
    case Operand::Time:
      return timeIn(operand);
    case Operand::Step: {
      const auto value = numberIn(operand);
      return value ? std::optional(PlayerCommand{entry.verb, *value}) : std::nullopt;
    }
    case Operand::Level:
      return levelIn(operand);
    case Operand::Row:
      return rowIn(operand);
    case Operand::Track:
      return trackIn(entry.verb, operand);
    case Operand::Shape:
      if (!operand.empty() && !parseAspect(operand)) return std::nullopt;
      return PlayerCommand{entry.verb, 0, std::string(operand)};
    case Operand::Url:
      return operand.empty() ? std::nullopt : std::optional(PlayerCommand{entry.verb, 0, std::string(operand)});
    case Operand::OnOff:
      if (operand == "on" || operand == "off") return PlayerCommand{entry.verb, operand == "on" ? 1.0 : -1.0};
      return operand.empty() ? std::optional(PlayerCommand{entry.verb}) : std::nullopt;
    case Operand::Layout: {
      StereoSettings any;
      const bool known = operand.empty() || parseStereo(operand, any);
      return known ? std::optional(PlayerCommand{entry.verb, 0, std::string(operand)}) : std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<PlayerCommand> parseCommand(std::string_view words) {
  const std::size_t space = words.find(' ');
  const std::string_view word = words.substr(0, space);
  const std::string_view operand = space == std::string_view::npos ? "" : words.substr(space + 1);
  if (operand.empty() && word.size() != words.size()) return std::nullopt;
  for (const Entry& entry : kEntries) {
    if (word == entry.word) return withOperand(entry, operand);
  }
  return std::nullopt;
}

std::string wordsOf(const PlayerCommand& command) {
  std::string word = entryOf(command.verb).word;
  switch (command.verb) {
    case PlayerVerb::SeekBy:
    case PlayerVerb::DepthBy:
    case PlayerVerb::ScreenBy:
    case PlayerVerb::ZoomBy:
    case PlayerVerb::VolumeBy:
    case PlayerVerb::AudioDelayBy:
    case PlayerVerb::SubtitleDelayBy:
    case PlayerVerb::SubtitleSizeBy:
    case PlayerVerb::ChapterBy:
    case PlayerVerb::SelectBy:
      return word + print(" %+.6g", command.value);
    case PlayerVerb::AudioTrack:
    case PlayerVerb::SubtitleTrack:
      if (command.value == 0) return word;
      return word + (command.value < 0 ? std::string(" off") : print(" %.0f", command.value));
    case PlayerVerb::SelectTo:
      if (command.value == 0) return word + " last";
      [[fallthrough]];
    case PlayerVerb::SeekTo:
    case PlayerVerb::VolumeTo:
      return word + print(" %.6g", command.value);
    case PlayerVerb::SeekShare:
      return word + print(" %.6g%%", 100 * command.value);
    case PlayerVerb::Loop:
    case PlayerVerb::FullScreen:
    case PlayerVerb::Mute:
    case PlayerVerb::ShowSubtitles:
      return command.value == 0 ? word : word + (command.value > 0 ? " on" : " off");
    case PlayerVerb::Open:
    case PlayerVerb::Layout:
    case PlayerVerb::Aspect:
      return command.word.empty() ? word : word + " " + command.word;
    default:
      return word;
  }
}

namespace {

const char* formOf(Operand operand) noexcept {
  constexpr std::array kForms{"",       "+X|-X",   "+S|-S|S|P%", "URL",   "[on|off]",
                              "[WORD]", "+P|-P|P", "[N|off]",    "[W:H]", "+N|-N|N|last"};
  return kForms[static_cast<std::size_t>(operand)];
}

}  // namespace

std::string commandWords() {
  std::string text;
  const char* last = "";
  for (const Entry& entry : kEntries) {
    if (entry.word == std::string_view(last)) continue;
    last = entry.word;
    const std::string form = formOf(entry.operand);
    text += (text.empty() ? "" : ", ") + std::string(entry.word) + (form.empty() ? "" : " ") + form;
  }
  return text;
}

std::string whyNoCommand(std::string_view words) {
  const std::size_t space = words.find(' ');
  const std::string word(words.substr(0, space));
  const std::string operand(space == std::string_view::npos ? "" : words.substr(space + 1));
  const auto entry = std::ranges::find(kEntries, std::string_view(word), [](const Entry& e) { return e.word; });
  if (entry == kEntries.end()) return "unknown command \"" + word + "\"; known are: " + commandWords();
  const std::string form = formOf(entry->operand);
  if (form.empty()) return "\"" + word + "\" takes no word after it, such as \"" + operand + "\"";
  const std::string wrong = operand.empty() ? ": it is missing" : ", not \"" + operand + "\"";
  return "\"" + word + "\" takes " + form + wrong;
}

namespace {

// Of a Step: what it does in either direction.
std::string stepMeaning(const PlayerCommand& command, const Entry& entry) {
  const bool up = command.value > 0;
  const double by = std::abs(command.value);
  switch (command.verb) {
    case PlayerVerb::DepthBy:
      return print("%.6g %% %s depth for the eyes", 100 * by, up ? "more" : "less");
    case PlayerVerb::ScreenBy:
      return print("the scene %.6g mm %s", by, up ? "towards you" : "away from you");
    case PlayerVerb::ZoomBy:
      return print("%.6g %% %s", 100 * by, up ? "larger, cut at its edges" : "smaller again");
    case PlayerVerb::AudioDelayBy:
    case PlayerVerb::SubtitleDelayBy:
      return print("%s %.6g s %s", entry.meaning, by, up ? "later" : "earlier");
    case PlayerVerb::SubtitleSizeBy:
      return print("subtitles %.6g %% %s", 100 * by, up ? "larger" : "smaller");
    default:
      return print("%+.6g %s", command.value, entry.meaning);
  }
}

}  // namespace

std::string meaningOf(const PlayerCommand& command) {
  const Entry& entry = entryOf(command.verb);
  if (command.verb == PlayerVerb::SeekBy) {
    return print("%.6g s %s", std::abs(command.value), command.value < 0 ? "back" : "forward");
  }
  if (command.verb == PlayerVerb::SeekTo) return print("to %.6g s", command.value);
  if (command.verb == PlayerVerb::SeekShare && command.value == 0) return "to the beginning";
  if (command.verb == PlayerVerb::SeekShare) return print("to %.6g %% of the film", 100 * command.value);
  if (command.verb == PlayerVerb::ChapterBy && std::abs(command.value) == 1) {
    return command.value < 0 ? "this chapter from its beginning, or the one before" : "the next chapter";
  }
  if (command.verb == PlayerVerb::SelectBy) {
    const double films = std::abs(command.value);
    const char* const where = command.value < 0 ? "up" : "down";
    return films == 1 ? print("one film %s", where) : print("%.0f films %s", films, where);
  }
  if (command.verb == PlayerVerb::SelectTo) {
    return command.value == 0   ? "the last film"
           : command.value == 1 ? "the first film"
                                : print("film %.0f", command.value);
  }
  if (command.verb == PlayerVerb::VolumeBy)
    return print("%.6g %% %s", std::abs(command.value), command.value < 0 ? "quieter" : "louder");
  if (command.verb == PlayerVerb::VolumeTo) return print("%.6g %s", command.value, entry.meaning);
  if (entry.operand == Operand::Track && command.value > 0) return print("%s %.0f", entry.word, command.value);
  if (entry.operand == Operand::Track && command.value < 0) return "no subtitles";
  if (command.verb == PlayerVerb::Mute && command.value != 0) return command.value > 0 ? "sound off" : "sound on";
  if (command.verb == PlayerVerb::ShowSubtitles && command.value != 0) {
    return command.value > 0 ? "subtitles on" : "subtitles off";
  }
  if (command.verb == PlayerVerb::Aspect && !command.word.empty()) return "show the picture as " + command.word;
  if (entry.operand == Operand::Step) return stepMeaning(command, entry);
  if (command.verb == PlayerVerb::Loop && command.value != 0) {
    return command.value > 0 ? "begin again at the end" : "do not restart at the end";
  }
  if (command.verb == PlayerVerb::FullScreen && command.value != 0) {
    return command.value > 0 ? "the whole screen" : "out of full screen";
  }
  if (command.verb == PlayerVerb::Layout && !command.word.empty()) return "show stereo as " + command.word;
  return entry.meaning;
}

bool needsFilm(PlayerVerb verb) noexcept {
  constexpr std::array kFree{PlayerVerb::Open,       PlayerVerb::SelectBy, PlayerVerb::SelectTo, PlayerVerb::Choose,
                             PlayerVerb::Back,       PlayerVerb::Escape,   PlayerVerb::Stop,     PlayerVerb::Quit,
                             PlayerVerb::FullScreen, PlayerVerb::Layout,   PlayerVerb::Keys,     PlayerVerb::VolumeBy,
                             PlayerVerb::VolumeTo,   PlayerVerb::Mute,     PlayerVerb::Loop,     PlayerVerb::SwapEyes};
  return std::ranges::find(kFree, verb) == kFree.end();
}

bool repeats(PlayerVerb verb) noexcept {
  return entryOf(verb).repeats;
}

}  // namespace relievo
