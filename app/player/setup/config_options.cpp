// SPDX-License-Identifier: Apache-2.0
// CLI11 checks the words of a configuration like those of a command line.
#include "app/player/setup/config_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/cli/options.h"

namespace relievo {
namespace {

// Empty for --help and similar options, which are not settings.
std::string keyOf(const CLI::Option& option) {
  if (!option.get_configurable()) return "";
  if (!option.get_lnames().empty()) return option.get_lnames().front();
  return CLI::detail::to_lower(option.get_name(true));
}

CLI::Option* optionFor(CLI::App& command, const std::string& key) {
  for (CLI::Option* option : command.get_options([](CLI::Option*) { return true; })) {
    if (!key.empty() && keyOf(*option) == key) return option;
  }
  return nullptr;
}

// "c.toml:2: stereo = x: no such layout" of "--stereo x: no such layout".
std::string placed(const std::string& place, const std::string& key, std::string_view words) {
  const std::string dashed = "--" + key;
  if (!words.starts_with(dashed)) return place + ": " + std::string(words);
  words.remove_prefix(dashed.size());
  return place + (words.starts_with(' ') ? " =" : "") + std::string(words);
}

bool isFlag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

// CLI11 would also take yes, numbers and lists for a flag.
bool isTrueOrFalse(const std::vector<std::string>& words) {
  return words.size() == 1 && (words.front() == "true" || words.front() == "false");
}

Outcome<void> give(CLI::Option& option, const ConfigEntry& entry, const std::string& place) {
  if (isFlag(option) && !isTrueOrFalse(entry.words)) {
    return failOn(place + " = " + tomlOf(entry.words), {ErrorCode::InvalidArgument, 0, "it is either true or false"});
  }
  try {
    std::vector<std::string> words = entry.words;
    std::ranges::transform(words, words.begin(), singleWord);
    option.add_result(std::move(words));
    option.run_callback();
    return {};
  } catch (const WordFailure& failure) {
    return failOn(placed(place, entry.key, failure.thing), failure.error);
  } catch (const CLI::Error& error) {
    return failOn(placed(place, entry.key, error.what()), {ErrorCode::InvalidArgument, 0, "see relievo play --help"});
  }
}

// "key = value  # from where"; control characters would end the comment.
std::string lineOf(const std::string& key, const std::vector<std::string>& words, std::string origin) {
  std::ranges::replace_if(origin, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  return key + " = " + tomlOf(words) + "  # " + origin + "\n";
}

}  // namespace

Outcome<ConfigLines> applyConfig(CLI::App& command, const FileConfig& config) {
  ConfigLines lines;
  for (const ConfigEntry& entry : config.entries) {
    if (entry.table != "play") continue;
    CLI::Option* option = optionFor(command, entry.key);
    if (option == nullptr) {
      return failOn(placeOf(config, entry), {ErrorCode::InvalidArgument, 0,
                                             "no such option; [play] has those of relievo play, without the dashes; "
                                             "see relievo play --help"});
    }
    if (option->count() > 0) continue;
    if (auto given = give(*option, entry, placeOf(config, entry)); !given) return std::unexpected(given.error());
    lines[entry.key] = entry.line;
  }
  return lines;
}

std::string configText(const CLI::App& command, const FileConfig& config, const ConfigLines& lines) {
  std::string text = "[play]\n";
  for (const CLI::Option* option : command.get_options([](const CLI::Option*) { return true; })) {
    const std::string key = keyOf(*option);
    if (key.empty()) continue;
    const bool flag = isFlag(*option);
    const auto line = lines.find(key);
    if (line != lines.end()) {
      text += lineOf(key, option->results(), config.path + ":" + std::to_string(line->second));
    } else if (option->count() > 0) {
      text += lineOf(key, option->results(), "command line");
    } else if (flag || !option->get_default_str().empty()) {
      text += lineOf(key, {flag ? "false" : option->get_default_str()}, "default");
    } else {
      text += "# " + key + " is not set\n";
    }
  }
  std::string table;
  for (const ConfigEntry& entry : config.entries) {
    if (entry.table == "play") continue;
    if (table != entry.table) text += "\n[" + entry.table + "]\n";
    table = entry.table;
    text += lineOf(entry.key, entry.words, config.path + ":" + std::to_string(entry.line));
  }
  return text;
}

}  // namespace relievo
