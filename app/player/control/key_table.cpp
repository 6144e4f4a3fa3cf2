// SPDX-License-Identifier: Apache-2.0
// Parses key tables, and interprets keys.
#include "app/player/control/key_table.h"

#include <linux/input-event-codes.h>

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <vector>

#include "hal/key_names.h"
#include "platform/print.h"
#include "platform/text/dotted_names.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

struct Twin {
  std::uint16_t code, of;
};
constexpr std::array kTwins{
    Twin{KEY_PLAYCD, KEY_PLAY},
    Twin{KEY_PAUSECD, KEY_PAUSE},
    Twin{KEY_STOPCD, KEY_STOP},
    Twin{KEY_ENTER, KEY_OK},
    Twin{KEY_SELECT, KEY_OK},
    Twin{KEY_KPENTER, KEY_OK},
    Twin{KEY_EXIT, KEY_BACK},
    Twin{KEY_NEXTSONG, KEY_NEXT},
    Twin{KEY_PREVIOUSSONG, KEY_PREVIOUS},
    Twin{KEY_1, KEY_NUMERIC_1},
    Twin{KEY_2, KEY_NUMERIC_2},
    Twin{KEY_3, KEY_NUMERIC_3},
    Twin{KEY_4, KEY_NUMERIC_4},
    Twin{KEY_5, KEY_NUMERIC_5},
    Twin{KEY_6, KEY_NUMERIC_6},
    Twin{KEY_7, KEY_NUMERIC_7},
    Twin{KEY_8, KEY_NUMERIC_8},
    // A gamepad's, as in Kodi.
    Twin{BTN_SOUTH, KEY_OK},
    Twin{BTN_EAST, KEY_BACK},
    Twin{BTN_START, KEY_MENU},
    Twin{BTN_SELECT, KEY_INFO},
    Twin{BTN_DPAD_UP, KEY_UP},
    Twin{BTN_DPAD_DOWN, KEY_DOWN},
    Twin{BTN_DPAD_LEFT, KEY_LEFT},
    Twin{BTN_DPAD_RIGHT, KEY_RIGHT},
};

// The signs that Shift makes on a keyboard of the USA, where they have a key of their own in the table.
constexpr std::array kShiftedSigns{Twin{KEY_3, KEY_NUMERIC_POUND}, Twin{KEY_SLASH, KEY_QUESTION},
                                   Twin{KEY_COMMA, KEY_PREVIOUS}, Twin{KEY_DOT, KEY_NEXT}};

std::uint16_t signOf(std::uint16_t code) noexcept {
  const auto sign = std::ranges::find(kShiftedSigns, code ^ kWithShift, &Twin::code);
  return sign == kShiftedSigns.end() ? code : sign->of;
}

std::uint16_t twinOf(std::uint16_t code) noexcept {
  const auto twin = std::ranges::find(kTwins, code, &Twin::code);
  return twin == kTwins.end() ? code : twin->of;
}

// Shift or Ctrl; 0 for any other key.
std::uint16_t modifierOf(std::uint16_t code) noexcept {
  if (code == KEY_LEFTSHIFT || code == KEY_RIGHTSHIFT) return kWithShift;
  return code == KEY_LEFTCTRL || code == KEY_RIGHTCTRL ? kWithCtrl : 0;
}

// The table's index for its name; nullopt if it is no state.
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
    return wrong(node, whyNoCommand(words), "mend this line");
  }

  const std::string& file_;
};

}  // namespace

KeyTable KeyTable::usual() {
  KeyTable table;
  static_cast<void>(table.add(usualText(), "usual keys"));
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
  constexpr const char* kNoToml = "not valid TOML; a line is KEY = \"command\" under [always] or a state";
  if (const auto line = lineWithTooManyDots(text); line > 0) return reader.wrong({.begin = {line, 1}}, "", kNoToml);
  toml::table parsed;
  try {
    parsed = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    return reader.wrong(error.source(), "", kNoToml);
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
  const std::uint16_t alone = withoutShiftAndCtrl(code);
  const auto without_shift = static_cast<std::uint16_t>(code & ~kWithShift);          // Ctrl and + is Ctrl, Shift and =
  const bool is_sign = (code & kWithShift) != 0 && alone >= KEY_1 && alone <= KEY_0;  // "&" is not 7, nor is "(" 9
  const std::array likely{code, signOf(code), without_shift, alone, twinOf(alone)};
  for (const std::uint16_t known : std::span(likely).first(is_sign ? 2 : likely.size())) {
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

std::optional<PlayerCommand> KeyReader::take(const KeyEvent& key, PlayerState state) {
  using Action = KeyEvent::Action;
  if (const std::uint16_t modifier = modifierOf(key.code); modifier != 0) {
    held_ = key.action == Action::Release ? held_ & ~modifier : held_ | modifier;
    return std::nullopt;
  }
  if (key.action == Action::Release) {
    if (!pending_ || pending_->code != key.code) return std::nullopt;
    return std::exchange(pending_, std::nullopt)->binding.press;
  }
  const KeyTable::Binding* binding = table_.find(state, key.code | held_);
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
