// SPDX-License-Identifier: Apache-2.0
// The text that the player shows over the picture, and for how long. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/player/screen/screen_facts.h"
#include "app/player/screen/screen_list.h"
#include "platform/clock.h"

namespace relievo {

// A word of the bar to click, and what a click does.
struct ScreenButton {
  PlayerVerb verb = PlayerVerb::PlayPause;
  std::string word;
  bool operator==(const ScreenButton&) const = default;
};

// The bar under the picture. Times are shares of the film's length, from 0 to 1.
struct ScreenBar {
  std::string title;
  std::string times;   // "1:23 / 1:02:05   4x"
  std::string status;  // "3D: sbs   touch: Novint Falcon"
  double position = 0, buffered = 0;
  bool has_length = false;
  std::vector<double> chapters;
  std::optional<double> loop_from, loop_to;
  std::optional<double> pointed;  // under the mouse
  std::string pointed_time;       // the time there
  std::vector<ScreenButton> buttons;
  std::optional<PlayerVerb> pointed_button;  // likewise
  bool operator==(const ScreenBar&) const = default;
};

// The value that a key has changed: words, and a level between 0 and 1 if there is one.
struct ScreenNotice {
  std::string words;
  std::optional<double> level;
  bool operator==(const ScreenNotice&) const = default;
};

// A finger beside the picture, in shares from the picture's middle, right and up.
struct FingerBeside {
  double across = 0, up = 0;
  bool operator==(const FingerBeside&) const = default;
};

// Two columns: keys and their meaning, or a part of the player and its figures.
using ScreenRows = std::vector<std::pair<std::string, std::string>>;

struct ScreenContent {
  std::optional<ScreenBar> bar;
  std::array<std::optional<double>, 2> forces_n;
  std::array<std::optional<FingerBeside>, 2> fingers;
  std::optional<ScreenNotice> notice;
  std::string warning, hint;
  ScreenRows statistics, keys;
  std::size_t keys_page = 0;       // from 0 on, if the keys do not fit on one page
  std::string help_key;            // the key that shows all keys; only with keys and list
  std::string choose_key;          // the key that plays the selected film; only with the list
  std::optional<ScreenList> list;  // of films, in place of a film

  [[nodiscard]] bool empty() const { return *this == ScreenContent{}; }
  bool operator==(const ScreenContent&) const = default;
};

// "1:02:05", "0:07".
[[nodiscard]] std::string clockTime(double seconds);

// The bar is shown for some seconds after the viewer has done something, after a fault, and at the start; while the
// film is paused; and on request, until it is switched off. A notice is shown for two seconds, and so is the hint at
// the start.
class ScreenText {
 public:
  static constexpr Duration kAwake = std::chrono::seconds(4);
  static constexpr Duration kNotice = std::chrono::seconds(2);

  void wake(MonotonicTime now) noexcept { awake_until_ = now + kAwake; }
  void toggleBar() noexcept { bar_ = !bar_; }
  void toggleStatistics() noexcept { statistics_ = !statistics_; }
  // Shows these keys, then their further pages, then hides them.
  void turnKeys(ScreenRows keys, std::size_t pages);
  // To another of these pages, no further than the first and the last.
  void turnPage(int by) noexcept;
  void hideKeys() noexcept { keys_.clear(); }
  // The keys that show all keys, and that play the selected film of the list.
  void setKeyNames(std::string help, std::string choose);
  [[nodiscard]] bool showsKeys() const noexcept { return !keys_.empty(); }
  [[nodiscard]] bool showsWarning(MonotonicTime now) const noexcept { return now < told_until_; }
  // Shows why something does not work.
  void tell(std::string why, MonotonicTime now);
  void forgetWarning() noexcept { told_until_ = {}; }
  void forgetWarning(const std::string& why) noexcept {
    if (why_ == why) told_until_ = {};
  }
  // Shows the effect of a key.
  void notice(ScreenNotice notice, MonotonicTime now);
  // The words of the notice that is shown now.
  [[nodiscard]] std::string noticed(MonotonicTime now) const { return now < noticed_until_ ? notice_.words : ""; }
  void hint(std::string words, MonotonicTime now);
  // The list of films, shown only with warnings, notices and keys; nullopt: a film is shown.
  void setList(std::optional<ScreenList> list) { list_ = std::move(list); }
  [[nodiscard]] bool hasList() const noexcept { return list_.has_value(); }
  // The mouse is over this place of the bar, 0 to 1, or over this button; nullopt: it is not.
  void point(std::optional<double> share, std::optional<PlayerVerb> button, MonotonicTime now);
  void setChapters(std::vector<double> starts_s) { chapters_s_ = std::move(starts_s); }

  [[nodiscard]] bool showsBar(const ScreenFacts& facts, MonotonicTime now) const noexcept;
  [[nodiscard]] bool showsStatistics() const noexcept { return statistics_; }
  // Values are rounded, so that the content changes only when something visible does. `statistics` is included if
  // requested; only a notice is shown together with the keys.
  [[nodiscard]] ScreenContent content(const ScreenFacts& facts, const ScreenRows& statistics, MonotonicTime now) const;

 private:
  [[nodiscard]] ScreenBar bar(const ScreenFacts& facts, MonotonicTime now) const;

  bool bar_ = false, statistics_ = false;
  ScreenRows keys_;
  std::size_t keys_page_ = 0, keys_pages_ = 0;
  std::string help_key_, choose_key_;
  MonotonicTime awake_until_;
  std::string why_, hint_;
  ScreenNotice notice_;
  MonotonicTime told_until_, noticed_until_, hinted_until_, pointed_until_;
  std::optional<double> pointed_;
  std::optional<PlayerVerb> pointed_button_;
  std::vector<double> chapters_s_;
  std::optional<ScreenList> list_;
};

}  // namespace relievo
