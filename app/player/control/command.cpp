// SPDX-License-Identifier: Apache-2.0
// Commands from words and back to them.
#include "app/player/control/command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/player/control/verb_table.h"
#include "app/player/screen/stereo_word.h"
#include "platform/text/near_words.h"
#include "platform/text/number_in.h"

namespace relievo {
namespace {

// The whole text, a finite number of at most a week in seconds.
std::optional<double> quantityIn(std::string_view text) {
  constexpr double kMost = 7 * 24 * 3600.0;
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;  // from_chars takes that one
  }
  const auto value = numberIn<double>(text);
  return value && std::abs(*value) <= kMost ? value : std::nullopt;
}

std::optional<PlayerCommand> timeIn(std::string_view text) {
  const bool share = text.ends_with('%');
  if (share) text.remove_suffix(1);
  const auto value = quantityIn(text);
  if (!value) return std::nullopt;
  const bool relative = text.starts_with('+') || text.starts_with('-');
  if (!share) return PlayerCommand{relative ? PlayerVerb::SeekBy : PlayerVerb::SeekTo, *value};
  if (relative || *value > 100) return std::nullopt;
  return PlayerCommand{PlayerVerb::SeekShare, *value / 100};
}

// The command for a track of sound or subtitles: the next one, "previous", "off", or a number.
std::optional<PlayerCommand> trackIn(const VerbEntry& entry, std::string_view text) {
  constexpr double kMostTracks = 100;
  if (text.empty()) return PlayerCommand{entry.verb};
  if (text == "previous") return PlayerCommand{entry.verb, kPreviousTrack};
  if (text == "off" && entry.operand == Operand::TrackOrOff) return PlayerCommand{entry.verb, -1};
  const auto number = quantityIn(text);
  const bool good = number && *number >= 1 && *number <= kMostTracks && *number == std::floor(*number);
  return good ? std::optional(PlayerCommand{entry.verb, *number}) : std::nullopt;
}

std::optional<PlayerCommand> levelIn(std::string_view text) {
  const auto value = quantityIn(text);
  if (!value) return std::nullopt;
  const bool relative = text.starts_with('+') || text.starts_with('-');
  return PlayerCommand{relative ? PlayerVerb::VolumeBy : PlayerVerb::VolumeTo, *value};
}

// Of the list of films.
std::optional<PlayerCommand> rowIn(std::string_view text) {
  constexpr double kMostRows = 1e6;
  if (text == "last") return PlayerCommand{PlayerVerb::SelectTo};
  const auto value = quantityIn(text);
  if (!value || *value != std::floor(*value) || std::abs(*value) > kMostRows) return std::nullopt;
  const bool relative = text.starts_with('+') || text.starts_with('-');
  if (!relative && *value < 1) return std::nullopt;
  return PlayerCommand{relative ? PlayerVerb::SelectBy : PlayerVerb::SelectTo, *value};
}

std::optional<PlayerCommand> withOperand(const VerbEntry& entry, std::string_view operand) {
  switch (entry.operand) {
    case Operand::None:
      return operand.empty() ? std::optional(PlayerCommand{entry.verb}) : std::nullopt;
    case Operand::Time:
      return timeIn(operand);
    case Operand::Step: {
      const auto value = quantityIn(operand);
      return value ? std::optional(PlayerCommand{entry.verb, *value}) : std::nullopt;
    }
    case Operand::Turn: {
      const auto value = quantityIn(operand);
      const bool good = value && (std::abs(*value) == 90 || std::abs(*value) == 180 || std::abs(*value) == 270);
      return good ? std::optional(PlayerCommand{entry.verb, *value}) : std::nullopt;
    }
    case Operand::Level:
      return levelIn(operand);
    case Operand::Row:
      return rowIn(operand);
    case Operand::Track:
    case Operand::TrackOrOff:
      return trackIn(entry, operand);
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

const char* formOf(Operand operand) noexcept {
  constexpr std::array kForms{"",        "+X|-X",        "+S|-S|S|P%",       "URL",   "[on|off]",     "[WORD]",
                              "+P|-P|P", "[N|previous]", "[N|previous|off]", "[W:H]", "+N|-N|N|last", "90|180|270"};
  return kForms[static_cast<std::size_t>(operand)];
}

}  // namespace

std::optional<PlayerCommand> parseCommand(std::string_view words) {
  const std::size_t space = words.find(' ');
  const std::string_view word = words.substr(0, space);
  const std::string_view operand = space == std::string_view::npos ? "" : words.substr(space + 1);
  if (operand.empty() && word.size() != words.size()) return std::nullopt;
  for (const VerbEntry& entry : verbTable()) {
    if (word == entry.word) return withOperand(entry, operand);
  }
  return std::nullopt;
}

std::string commandWords() {
  std::string text;
  const char* last = "";
  for (const VerbEntry& entry : verbTable()) {
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
  const auto entry = std::ranges::find(verbTable(), std::string_view(word), [](const VerbEntry& e) { return e.word; });
  if (entry == verbTable().end()) {
    std::vector<std::string> known;
    for (const VerbEntry& each : verbTable()) known.emplace_back(each.word);
    const std::string near = nearestWord(word, known);
    return "unknown command \"" + word + "\"; " + (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
           "known are: " + commandWords();
  }
  const std::string form = formOf(entry->operand);
  if (form.empty()) return "\"" + word + "\" takes no word after it, but \"" + operand + "\" was given";
  const std::string wrong = operand.empty() ? ": it is missing" : ", not \"" + operand + "\"";
  return "\"" + word + "\" takes " + form + wrong;
}

}  // namespace relievo
