// SPDX-License-Identifier: Apache-2.0
// Reads the script once and returns its keys by their times.
#include "drivers/mock/scripted_remote.h"

#include <algorithm>
#include <cerrno>
#include <optional>

#include "hal/key_names.h"
#include "platform/text/number_in.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr double kLongestScriptS = 1e6;

std::string_view nextWord(std::string_view& line) {
  const auto begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return line = {};
  const auto end = std::min(line.find_first_of(kBlanks, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::optional<Duration> parseTime(std::string_view word) {
  const auto seconds = numberIn<double>(word);
  if (!seconds || !(*seconds >= 0 && *seconds <= kLongestScriptS)) return std::nullopt;
  return fromSeconds(*seconds);
}

// The rest of a line, without surrounding blanks.
std::string_view restOf(std::string_view line) {
  const auto begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kBlanks) - begin + 1);
}

// `place` names the line.
Outcome<void> addLine(std::string_view line, const std::string& place, std::vector<ScriptedKey>& keys) {
  const auto wrong = [](const std::string& thing, const char* what) {
    return failOn(thing, {ErrorCode::InvalidArgument, 0, what});
  };
  line = line.substr(0, line.find('#'));
  const std::string_view time_word = nextWord(line);
  if (time_word.empty()) return {};
  const auto at = parseTime(time_word);
  if (!at) return wrong(place, "does not begin with a time; write SECONDS KEYNAME, such as 2.0 PLAYPAUSE");
  if (!keys.empty() && *at < keys.back().at) {
    return wrong(place, "its time is before that of the line above; sort the lines by time");
  }
  std::string_view name = restOf(line);
  ScriptedKey key{.at = *at};
  if (const auto blank = name.find_last_of(kBlanks); blank != std::string_view::npos) {
    if (const auto held = parseTime(name.substr(blank + 1))) {
      key.held = *held;
      name = restOf(name.substr(0, blank));
    }
  }
  if (name.empty()) return wrong(place, "has no key; write SECONDS KEYNAME, such as 2.0 PLAYPAUSE");
  const auto code = keyCode(name);
  if (!code) {
    const std::string_view nearest = nearestKeyName(name);
    const std::string hint = nearest.empty() ? "" : " (" + std::string(nearest) + "?)";
    return wrong(place + ": " + std::string(name) + hint,
                 "is not the name of a key; relievo play --help lists the names");
  }
  key.code = *code;
  keys.push_back(key);
  return {};
}

class ScriptedRemote final : public RemoteInput {
 public:
  ScriptedRemote(const std::vector<ScriptedKey>& keys, const Clock& clock) : clock_(clock) {
    using Action = KeyEvent::Action;
    for (const ScriptedKey& key : keys) {
      has_pad_ = has_pad_ || isPadButton(key.code);
      add({key.code, Action::Press, MonotonicTime(key.at)});
      add({key.code, Action::Release, MonotonicTime(key.at + key.held)});
    }
  }
  [[nodiscard]] bool hasPad() const noexcept override { return has_pad_; }

 private:
  // Keeps the events sorted by time; at equal times in the script's order.
  void add(const KeyEvent& event) {
    events_.insert(std::ranges::upper_bound(events_, event.time, {}, &KeyEvent::time), event);
  }

  Result<void> openRemote() override {
    opened_ = clock_.now();
    next_ = 0;
    return {};
  }

  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    if (next_ == events_.size()) return std::nullopt;
    KeyEvent event = events_[next_];
    event.time = opened_ + event.time.time_since_epoch();
    if (now < event.time) return std::nullopt;
    ++next_;
    return event;
  }

  void closeRemote() noexcept override {}

  std::vector<KeyEvent> events_;  // times are relative to `open`
  const Clock& clock_;
  MonotonicTime opened_;
  bool has_pad_ = false;  // a gamepad's button is among the keys
  std::size_t next_ = 0;
};

}  // namespace

Outcome<std::vector<ScriptedKey>> parseKeyScript(std::string_view text, const std::string& script_name) {
  std::vector<ScriptedKey> keys;
  for (int number = 1; !text.empty(); ++number) {
    const auto length = std::min(text.find('\n'), text.size());
    const std::string place = script_name + ":" + std::to_string(number);
    if (auto added = addLine(text.substr(0, length), place, keys); !added) return std::unexpected(added.error());
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return keys;
}

Outcome<std::vector<ScriptedKey>> loadKeyScript(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Settings, "the key script cannot be read; check its path");
  if (!text) return failOn(path, text.error());
  return parseKeyScript(*text, path);
}

std::unique_ptr<RemoteInput> makeScriptedRemote(const std::vector<ScriptedKey>& keys, const Clock& clock) {
  return std::make_unique<ScriptedRemote>(keys, clock);
}

}  // namespace relievo
