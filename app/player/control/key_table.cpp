// SPDX-License-Identifier: Apache-2.0
// The usual keys, and the reader of tables. CEC keys come as the codes that the kernel's rc-cec map gives them.
#include "app/player/control/key_table.h"

#include <linux/input-event-codes.h>

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <vector>

#include "hal/key_names.h"
#include "platform/print.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

// A keyboard's keys are mpv's where both players do the same, a remote control's are Kodi's.
constexpr std::string_view kUsual = R"([always]
# a keyboard
SPACE = "play-pause"
P = "play-pause"
F = "full-screen"
F11 = "full-screen"
ESC = "escape"
Q = "quit"
RIGHT = "seek +5"
LEFT = "seek -5"
UP = "seek +60"
DOWN = "seek -60"
HOME = "seek 0%"
DOT = "step"
COMMA = "step-back"
LEFTBRACE = "slower"
RIGHTBRACE = "faster"
BACKSPACE = "normal-speed"
PAGEUP = "chapter +1"
PAGEDOWN = "chapter -1"
L = "ab-loop"
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
V = "show-subtitles"
J = "subtitles"
Z = "subtitle-delay -0.1"
X = "subtitle-delay +0.1"
NUMERIC_POUND = "audio"
S = "screenshot"
W = "zoom -0.1"
E = "zoom +0.1"
A = "aspect"
O = "info"
I = "statistics"
H = "keys"
F1 = "keys"
QUESTION = "keys"

# depth and eyes
TAB = "layout"
3D_MODE = "layout"
Y = "swap-eyes"
BLUE = "swap-eyes"
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

[browsing]
UP = "select -1"
DOWN = "select +1"
PAGEUP = "select -5"
PAGEDOWN = "select +5"
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

struct Twin {
  std::uint16_t code, of;
};
constexpr std::array kTwins{
    Twin{KEY_PLAYCD, KEY_PLAY}, Twin{KEY_PAUSECD, KEY_PAUSE}, Twin{KEY_STOPCD, KEY_STOP},
    Twin{KEY_ENTER, KEY_OK},    Twin{KEY_SELECT, KEY_OK},     Twin{KEY_KPENTER, KEY_OK},
    Twin{KEY_EXIT, KEY_BACK},   Twin{KEY_NEXTSONG, KEY_NEXT}, Twin{KEY_PREVIOUSSONG, KEY_PREVIOUS},
    Twin{KEY_1, KEY_NUMERIC_1}, Twin{KEY_2, KEY_NUMERIC_2},   Twin{KEY_3, KEY_NUMERIC_3},
    Twin{KEY_4, KEY_NUMERIC_4}, Twin{KEY_5, KEY_NUMERIC_5},   Twin{KEY_6, KEY_NUMERIC_6},
    Twin{KEY_7, KEY_NUMERIC_7}, Twin{KEY_8, KEY_NUMERIC_8},
};

std::uint16_t twinOf(std::uint16_t code) noexcept {
  const auto twin = std::ranges::find(kTwins, code, &Twin::code);
  return twin == kTwins.end() ? code : twin->of;
}

// The table's index for its name; nothing for what is no state.
std::optional<std::size_t> tableNamed(std::string_view word) {
  if (word == "always") return kPlayerStateCount;
  for (std::size_t i = 0; i < kPlayerStateCount; ++i) {
    if (word == name(static_cast<PlayerState>(i))) return i;
  }
  return std::nullopt;
}

class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file) {}

  Outcome<KeyTable::Binding> binding(const toml::node& node) const {
    KeyTable::Binding binding;
    if (node.is_string()) {
      if (auto read = command(node, binding.press); !read) return std::unexpected(read.error());
      return binding;
    }
    const toml::table* pair = node.as_table();
    if (pair == nullptr) return wrong(node, "", "a key has a command in quotes, or { press = \"..\", hold = \"..\" }");
    for (const auto& [word, value] : *pair) {
      const bool press = word.str() == "press";
      if (!press && word.str() != "hold") return wrong(value, std::string(word.str()), "is neither press nor hold");
      if (auto read = command(value, press ? binding.press : binding.hold); !read) {
        return std::unexpected(read.error());
      }
    }
    return binding;
  }

  [[nodiscard]] std::unexpected<Failure> wrong(const toml::node& node, const std::string& thing,
                                               const char* what) const {
    return wrong(node.source(), thing, what);
  }
  [[nodiscard]] std::unexpected<Failure> wrong(const toml::source_region& where, const std::string& thing,
                                               const char* what) const {
    const std::string place = file_ + ":" + std::to_string(where.begin.line);
    return failOn(thing.empty() ? place : place + ": " + thing, {ErrorCode::InvalidArgument, 0, what});
  }

 private:
  Outcome<void> command(const toml::node& node, std::optional<PlayerCommand>& into) const {
    const std::string words = node.value_or(std::string("?"));
    if (words.empty()) return {};
    into = parseCommand(words);
    if (into) return {};
    return wrong(node, "\"" + words + "\" is not a command; the commands are " + commandWords(), "mend this line");
  }

  const std::string& file_;
};

// The keys of each command, in the order of the commands.
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
    const auto verb = [](const auto& each) { return each.first.verb; };
    return lines_
        .emplace(std::ranges::upper_bound(lines_, command.verb, {}, verb), command, std::vector<std::string>())
        ->second;
  }
  const char* between_;
  std::vector<std::pair<PlayerCommand, std::vector<std::string>>> lines_;
};

using Rows = std::vector<std::pair<std::string, std::string>>;

// The digits from `first` on, one line each, that lead to as many tenths of the film.
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

// Several tenths share a row.
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

std::string_view KeyTable::usualText() noexcept {
  return kUsual;
}

KeyTable KeyTable::usual() {
  KeyTable table;
  static_cast<void>(table.add(kUsual, "usual keys"));
  return table;
}

Outcome<KeyTable> KeyTable::parse(std::string_view text, const std::string& file) {
  KeyTable table = usual();
  if (auto added = table.add(text, file); !added) return std::unexpected(added.error());
  return table;
}

Outcome<KeyTable> KeyTable::load(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Settings, "the key table cannot be read; check its path");
  if (!text) return failOn(path, text.error());
  return parse(*text, path);
}

Outcome<void> KeyTable::add(std::string_view text, const std::string& file) {
  const Reader reader(file);
  toml::table parsed;
  try {
    parsed = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    return reader.wrong(error.source(), "", "not valid TOML; a line is KEY = \"command\" under [always] or a state");
  }
  for (const auto& [table_word, node] : parsed) {
    const auto table = tableNamed(table_word.str());
    if (!table || !node.is_table()) {
      return reader.wrong(table_word.source(), std::string(table_word.str()),
                          "is not a state; tables are [always], [playing], [paused], [idle], ..");
    }
    for (const auto& [key_word, row] : *node.as_table()) {
      const std::string word(key_word.str());
      const auto code = keyCode(word);
      if (!code) {
        const std::string nearest(nearestKeyName(word));
        return reader.wrong(row, nearest.empty() ? word : print("%s (%s?)", word.c_str(), nearest.c_str()),
                            "is not the name of a key; relievo play --help lists the names");
      }
      auto binding = reader.binding(row);
      if (!binding) return std::unexpected(binding.error());
      tables_[*table][*code] = std::move(*binding);
    }
  }
  return {};
}

const KeyTable::Binding* KeyTable::row(std::size_t table, std::uint16_t code) const noexcept {
  const auto found = tables_[table].find(code);
  return found == tables_[table].end() ? nullptr : &found->second;
}

const KeyTable::Binding* KeyTable::find(PlayerState state, std::uint16_t code) const noexcept {
  for (const std::uint16_t known : {code, twinOf(code)}) {
    for (const std::size_t table : {static_cast<std::size_t>(state), kAlways}) {
      if (const Binding* binding = row(table, known)) return binding->press || binding->hold ? binding : nullptr;
    }
  }
  return nullptr;
}

// The code itself, and its twins without a row of their own.
std::vector<std::uint16_t> KeyTable::codesOf(PlayerState state, std::uint16_t code) const {
  std::vector<std::uint16_t> codes{code};
  for (const Twin& twin : kTwins) {
    if (twin.of == code && find(state, twin.code) == find(state, code)) codes.push_back(twin.code);
  }
  return codes;
}

Rows KeyTable::rowsIn(PlayerState state, KeyBoard held) const {
  const auto isHeld = [held](std::uint16_t code) {
    return held == KeyBoard::Keyboard ? !keyboardLabel(code).empty() : isOnRemotes(code);
  };
  CommandKeys own(", "), other(", ");
  for (const std::size_t t : {static_cast<std::size_t>(state), kAlways}) {
    for (const auto& [code, binding] : tables_[t]) {
      if (find(state, code) != &binding) continue;  // the state's own row holds
      if (state == PlayerState::Browsing && binding.press && needsFilm(binding.press->verb)) continue;
      for (const std::uint16_t each : codesOf(state, code)) {
        CommandKeys& keys = isHeld(each) ? own : other;
        keys.put(binding.press, keyLabel(each, held));
        keys.put(binding.hold, keyLabel(each, held) + " (held)");
      }
    }
  }
  if (held == KeyBoard::Keyboard) return rowsOf(own.lines());
  Rows rows = rowsOf(own.lines());  // a box may have a keyboard, too
  for (const auto& [command, keys] : other.lines()) {
    if (!own.has(command)) rows.emplace_back(keys, meaningOf(command));
  }
  return rows;
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

std::optional<PlayerCommand> KeyReader::take(const KeyEvent& key, PlayerState state) {
  using Action = KeyEvent::Action;
  if (key.action == Action::Release) {
    if (!pending_ || pending_->code != key.code) return std::nullopt;
    return std::exchange(pending_, std::nullopt)->binding.press;
  }
  const KeyTable::Binding* binding = table_.find(state, key.code);
  if (key.action == Action::Press) {
    pending_.reset();
    if (binding == nullptr) return std::nullopt;
    if (!binding->hold) return binding->press;
    pending_ = Pending{key.code, key.time, *binding};
    return std::nullopt;
  }
  const bool again = binding != nullptr && !binding->hold && binding->press && repeats(binding->press->verb);
  return again ? binding->press : std::nullopt;
}

std::optional<PlayerCommand> KeyReader::held(MonotonicTime now) {
  if (!pending_ || now < pending_->since + kHold) return std::nullopt;
  return std::exchange(pending_, std::nullopt)->binding.hold;
}

}  // namespace relievo
