// SPDX-License-Identifier: Apache-2.0
// The key table in plain words: a row for each command, for the screen and for the help.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "app/player/control/key_table.h"
#include "hal/key_names.h"
#include "platform/print.h"

namespace relievo {
namespace {

// The keys of each command, in the order of the commands, small steps first.
class CommandKeys {
 public:
  explicit CommandKeys(const char* between) : between_(between) {}

  void put(const std::optional<PlayerCommand>& command, const std::string& key) {
    if (!command) return;
    std::vector<std::string>& keys = keysOf(*command);
    if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  }
  [[nodiscard]] std::vector<std::pair<PlayerCommand, std::string>> lines() const {
    std::vector<std::pair<PlayerCommand, std::string>> lines;
    for (const auto& [command, keys] : lines_) {
      std::string text;
      for (const std::string& key : keys) text += (text.empty() ? "" : between_) + key;
      lines.emplace_back(command, text);
    }
    return lines;
  }
  [[nodiscard]] bool has(const PlayerCommand& command) const {
    return std::ranges::find(lines_, command, [](const auto& each) { return each.first; }) != lines_.end();
  }

 private:
  std::vector<std::string>& keysOf(const PlayerCommand& command) {
    const auto line = std::ranges::find(lines_, command, [](const auto& each) { return each.first; });
    if (line != lines_.end()) return line->second;
    const auto order = [](const PlayerCommand& c) {
      const double step = c.verb == PlayerVerb::SelectTo ? 0 : c.value;  // else a film's place, not how far to go
      return std::tuple(c.verb, std::abs(step), step);
    };
    const auto after =
        std::ranges::upper_bound(lines_, order(command), {}, [&order](const auto& each) { return order(each.first); });
    return lines_.emplace(after, command, std::vector<std::string>())->second;
  }
  const char* between_;
  std::vector<std::pair<PlayerCommand, std::vector<std::string>>> lines_;
};

bool isOn(KeyBoard held, std::uint16_t code) {
  if (held == KeyBoard::Pad) return !padLabel(code).empty();
  return held == KeyBoard::Keyboard ? !keyboardLabel(code).empty() : isOnRemotes(code);
}

using Rows = std::vector<std::pair<std::string, std::string>>;

// The digits from `first` on, one line each, that seek to as many tenths of the film.
std::size_t tenths(const std::vector<std::pair<PlayerCommand, std::string>>& lines, std::size_t first) {
  std::size_t count = 0;
  for (; first + count < lines.size(); ++count) {
    const auto& [command, keys] = lines[first + count];
    const std::size_t digit = static_cast<std::size_t>(lines[first].second[0] - '0') + count;
    const bool good = command.verb == PlayerVerb::SeekShare && keys == std::to_string(digit) && digit >= 1 &&
                      digit <= 9 && std::abs(command.value - 0.1 * static_cast<double>(digit)) < 1e-9;
    if (!good) break;
  }
  return count;
}

// Makes the rows of the key page. The keys that seek to 10 %, 20 %, .. of the film share one row.
Rows rowsOf(const std::vector<std::pair<PlayerCommand, std::string>>& lines) {
  Rows rows;
  for (std::size_t i = 0; i < lines.size();) {
    const auto& [command, keys] = lines[i];
    const std::size_t count = tenths(lines, i);
    if (count < 3) {
      rows.emplace_back(keys, meaningOf(command));
      ++i;
      continue;
    }
    rows.emplace_back(keys + " .. " + lines[i + count - 1].second,
                      print("to %s0 %% .. %s0 %% of the film", keys.c_str(), lines[i + count - 1].second.c_str()));
    i += count;
  }
  return rows;
}

}  // namespace

Rows KeyTable::rowsIn(PlayerState state, KeyBoard held) const {
  CommandKeys own(", "), other(", ");
  for (const std::size_t t : {static_cast<std::size_t>(state), kAlways}) {
    for (const auto& [code, binding] : tables_[t]) {
      if (find(state, code) != &binding) continue;  // the state's own row holds
      if (state == PlayerState::Browsing && binding.press && needsFilm(binding.press->verb)) continue;
      for (const std::uint16_t each : codesOf(state, code)) {
        if (held != KeyBoard::Pad && isPadButton(each)) continue;
        CommandKeys& keys = isOn(held, each) ? own : other;
        keys.put(binding.press, keyLabel(each, held));
        keys.put(binding.hold, keyLabel(each, held) + " (held)");
      }
    }
  }
  if (held != KeyBoard::Remote) return rowsOf(own.lines());
  Rows rows = rowsOf(own.lines());  // a box may have a keyboard, too
  for (const auto& [command, keys] : other.lines()) {
    if (!own.has(command)) rows.emplace_back(keys, meaningOf(command));
  }
  return rows;
}

std::string KeyTable::keyFor(PlayerVerb verb, PlayerState state, KeyBoard held) const {
  std::string keys;
  for (const std::size_t t : {static_cast<std::size_t>(state), kAlways}) {
    for (const auto& [code, binding] : tables_[t]) {
      const bool does = find(state, code) == &binding && binding.press && binding.press->verb == verb;
      if (!does) continue;
      for (const std::uint16_t each : codesOf(state, code)) {
        if (!isOn(held, each)) continue;
        if (held != KeyBoard::Remote) return keyLabel(each, held);
        keys += (keys.empty() ? "" : " or ") + keyLabel(each, held);
      }
    }
  }
  return keys;
}

std::string KeyTable::help() const {
  constexpr std::size_t kColumn = 30;  // of the meanings
  CommandKeys lines(" ");
  for (std::size_t t = 0; t <= kPlayerStateCount; ++t) {
    const std::string when = t == kAlways ? "" : print(" (%s)", name(static_cast<PlayerState>(t)));
    for (const auto& [code, binding] : tables_[t]) {
      const std::string key(keyName(code));
      lines.put(binding.press, key + when);
      lines.put(binding.hold, print("%s (held)%s", key.c_str(), when.c_str()));
    }
  }
  std::string text;
  for (const auto& [command, keys] : lines.lines()) {
    std::string line = "  " + keys;
    line.resize(std::max(kColumn, line.size() + 2), ' ');
    text += line + meaningOf(command) + "\n";
  }
  return text;
}

}  // namespace relievo
