// SPDX-License-Identifier: Apache-2.0
// Which key of a remote control, a keyboard, a gamepad or CEC gives which command, in which state.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/player/control/command.h"
#include "app/player/control/key_label.h"
#include "app/player/state_table.h"
#include "hal/remote_input.h"
#include "platform/failure.h"

namespace relievo {

// Tables of keys in TOML, named after the player's states; a key that a state does not list is looked up in [always]:
//
//   [always]
//   OK = { press = "play-pause", hold = "info" }   # hold: for 0.6 s
//   RIGHT = "seek +10"
//   [paused]
//   RIGHT = "step"
//   BLUE = ""                                      # means nothing
//   SHIFT_G = "subtitle-size +0.1"                 # with Shift or Ctrl; without such a row, as the key alone
//
// Keys by their names in linux/input-event-codes.h, without KEY_; commands in the words of
// app/player/control/command.h. Of two codes that remotes send for one word (PLAYCD for PLAY, ENTER and SELECT for OK,
// EXIT for BACK, ..) one row is enough; so it is for a gamepad's button that does what a remote's key does.
class KeyTable {
 public:
  struct Binding {
    std::optional<PlayerCommand> press, hold;
  };

  // The text of the usual table, as a start for a file of one's own.
  [[nodiscard]] static std::string_view usualText() noexcept;
  [[nodiscard]] static KeyTable usual();
  // The usual table with its rows replaced by those of `text`. InvalidArgument names the line of `file`.
  [[nodiscard]] static Outcome<KeyTable> parse(std::string_view text, const std::string& file);
  // NotFound when the file cannot be read.
  [[nodiscard]] static Outcome<KeyTable> load(const std::string& path);

  // Null for a key that means nothing in that state.
  [[nodiscard]] const Binding* find(PlayerState state, std::uint16_t code) const noexcept;
  // The meaning of the viewer's keys in a state: a row for each command, in plain words.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> rowsIn(PlayerState state, KeyBoard held) const;
  // The key for this command, with its label: one key of a keyboard or a gamepad, or all of a remote control; empty:
  // none.
  [[nodiscard]] std::string keyFor(PlayerVerb verb, PlayerState state, KeyBoard held) const;
  // For the help: a line for each command, with its keys' names.
  [[nodiscard]] std::string help() const;

 private:
  Outcome<void> add(std::string_view text, const std::string& file);
  [[nodiscard]] std::vector<std::uint16_t> codesOf(PlayerState state, std::uint16_t code) const;
  [[nodiscard]] const Binding* row(std::size_t table, std::uint16_t code) const noexcept;

  static constexpr std::size_t kAlways = kPlayerStateCount;  // after one of each state
  std::array<std::map<std::uint16_t, Binding>, kPlayerStateCount + 1> tables_;
};

// Converts key events to commands. Pure; times must not go back.
class KeyReader {
 public:
  static constexpr Duration kHold = std::chrono::milliseconds(600);

  explicit KeyReader(KeyTable table) : table_(std::move(table)) {}
  // Returns the command of a key: on release if holding it has another meaning, else on press.
  [[nodiscard]] std::optional<PlayerCommand> take(const KeyEvent& key, PlayerState state);
  // The second meaning of a key that has been held long enough, once.
  [[nodiscard]] std::optional<PlayerCommand> held(MonotonicTime now);

 private:
  struct Pending {
    std::uint16_t code;
    MonotonicTime since;
    KeyTable::Binding binding;  // of the state in which it was pressed
  };
  KeyTable table_;
  std::optional<Pending> pending_;
  std::uint16_t held_ = 0;  // bits of Shift and Ctrl
};

}  // namespace relievo
