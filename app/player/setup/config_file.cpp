// SPDX-License-Identifier: Apache-2.0
// Reads the configuration by toml++. Changes a number in the text itself, since toml++ would drop the comments.
#include "app/player/setup/config_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "app/player/user_folder.h"
#include "platform/atomic_file.h"
#include "platform/files/answered_place.h"
#include "platform/log.h"
#include "platform/text/dotted_names.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr const char* kSystemPath = "/etc/relievo/relievo.toml";

std::unexpected<Failure> wrong(const std::string& path, const toml::source_region& where, const char* message) {
  return failOn(path + ":" + std::to_string(where.begin.line), {ErrorCode::InvalidArgument, 0, message});
}

// The word that the value would be on a command line.
std::optional<std::string> wordOf(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
  const auto* number = node.as_floating_point();
  if (number == nullptr) return std::nullopt;
  char shortest[64];
  const auto end = std::to_chars(shortest, shortest + sizeof shortest, number->get()).ptr;
  return std::string(shortest, end);
}

std::optional<std::vector<std::string>> wordsOf(const toml::node& node) {
  std::vector<std::string> words;
  const auto take = [&words](const toml::node& each) {
    auto word = wordOf(each);
    if (word) words.push_back(std::move(*word));
    return word.has_value();
  };
  if (const toml::array* list = node.as_array()) {
    if (list->empty() || !std::ranges::all_of(*list, take)) return std::nullopt;
  } else if (!take(node)) {
    return std::nullopt;
  }
  return words;
}

// What is wrong with it, if anything is.
const char* takeFalcon(const toml::node& node, const std::string& key, FileConfig& config) {
  if (key == "firmware") {
    config.falcon_firmware = node.value<std::string>();
    return config.falcon_firmware ? nullptr : "falcon.firmware is a path in quotes";
  }
  if (key == "counts_per_nm") {
    config.falcon_counts_per_nm = node.value<double>();
    const double counts = config.falcon_counts_per_nm.value_or(0);
    return counts >= 1000 && counts <= 100'000 ? nullptr : "falcon.counts_per_nm is a number from 1000 to 100000";
  }
  return "unknown; falcon has firmware and counts_per_nm";
}

std::string tomlOf(const std::string& word) {
  const auto asText = [&word] {
    std::ostringstream quoted;
    quoted << toml::toml_formatter(toml::value<std::string>(word), toml::format_flags::allow_unicode_strings);
    return quoted.str();
  };
  try {
    const toml::table parsed = toml::parse("x = " + word);
    const toml::node* node = parsed.get("x");
    return parsed.size() == 1 && !node->is_string() && wordOf(*node) == word ? word : asText();
  } catch (const toml::parse_error&) {
    return asText();
  }
}

bool isLogArea(const std::string& key) {
  return key == "all" || std::ranges::find(kLogAreas, key) != kLogAreas.end();
}

std::string logAreas() {
  std::string words = "all";
  for (const std::string_view area : kLogAreas) words += ", " + std::string(area);
  return words;
}

}  // namespace

std::string defaultConfigPath() {
  const std::filesystem::path own = configFolder();
  if (!own.empty() && isThere(own / "relievo/relievo.toml")) return own / "relievo/relievo.toml";
  return kSystemPath;
}

Outcome<FileConfig> loadConfig(const std::string& path) {
  const std::string name = path.empty() ? defaultConfigPath() : path;
  const auto text = readWholeFile(name, FileSize::Settings, "the configuration cannot be read; check its path");
  if (text) return parseConfig(*text, name);
  if (path.empty() && text.error().os_error == ENOENT) return FileConfig{};
  return failOn(name, text.error());
}

Outcome<FileConfig> parseConfig(const std::string& text, const std::string& path) {
  constexpr const char* kNoToml = "this is not valid TOML; a line is key = value under a [table]";
  if (const auto line = lineWithTooManyDots(text); line > 0) return wrong(path, {.begin = {line, 1}}, kNoToml);
  toml::table parsed;
  try {
    parsed = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    return wrong(path, error.source(), kNoToml);
  }
  FileConfig config{.path = path};
  for (const auto& [table_name, table_node] : parsed) {
    const toml::table* table = table_node.as_table();
    const bool known = table_name == "play" || table_name == "falcon" || table_name == "log";
    if (table == nullptr || !known) {
      return wrong(path, table_node.source(), "unknown; the tables are: play, falcon, log");
    }
    for (const auto& [key, node] : *table) {
      const auto words = wordsOf(node);
      if (!words) {
        return wrong(path, node.source(), "a value is text in quotes, a number, true or false, or a list of these");
      }
      ConfigEntry entry{std::string(table_name.str()), std::string(key.str()), *words,
                        static_cast<int>(node.source().begin.line)};
      if (entry.table == "falcon") {
        if (const char* what = takeFalcon(node, entry.key, config)) return wrong(path, node.source(), what);
      }
      if (entry.table == "log" && !isLogArea(entry.key)) {
        return failOn(placeOf(config, entry) + " is no area of the log; they are " + logAreas(),
                      {ErrorCode::InvalidArgument, 0, "mend this line"});
      }
      if (entry.table == "log" && (words->size() != 1 || !logLevelOf(words->front()))) {
        return wrong(path, node.source(), "a level is \"error\", \"warning\", \"info\" or \"debug\"");
      }
      config.entries.push_back(std::move(entry));
    }
  }
  return config;
}

void applyLogLevels(const FileConfig& config) {
  const auto apply = [&config](bool all) {
    for (const ConfigEntry& entry : config.entries) {
      if (entry.table != "log" || (entry.key == "all") != all) continue;
      const LogLevel level = *logLevelOf(entry.words.front());
      if (all) setLogLevel(level);
      else setLogLevel(entry.key, level);
    }
  };
  apply(true);
  apply(false);
}

std::string placeOf(const FileConfig& config, const ConfigEntry& entry) {
  return config.path + ":" + std::to_string(entry.line) + ": " + entry.key;
}

std::string tomlOf(const std::vector<std::string>& words) {
  if (words.size() == 1) return tomlOf(words.front());
  std::string text = "[";
  for (const std::string& word : words) text += (text.size() == 1 ? "" : ", ") + tomlOf(word);
  return text + "]";
}

std::optional<std::string> withNumber(const std::string& text, const std::string& table, const std::string& key,
                                      double value) {
  char line[128];
  std::snprintf(line, sizeof line, "%s = %.6g", key.c_str(), value);
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string each; std::getline(in, each);) lines.push_back(each);

  const toml::table parsed = toml::parse(text);
  const toml::table* found = parsed[table].as_table();
  const toml::node* old = found == nullptr ? nullptr : found->get(key);
  const auto at = [&lines](const toml::source_region& where) {
    return lines.begin() + static_cast<std::ptrdiff_t>(where.begin.line) - 1;
  };
  if (old != nullptr) {
    *at(old->source()) = line;
  } else if (found != nullptr) {
    lines.insert(at(found->source()) + 1, line);
  } else {
    if (!lines.empty()) lines.emplace_back();
    lines.push_back("[" + table + "]");
    lines.emplace_back(line);
  }
  std::string result;
  for (const std::string& each : lines) result += each + "\n";
  toml::table wanted = parsed;
  wanted.emplace<toml::table>(table);
  wanted[table].as_table()->insert_or_assign(key, *toml::parse(line).get(key));
  try {
    if (toml::parse(result) == wanted) return result;
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
  return std::nullopt;
}

Outcome<void> setNumber(const std::string& path, const std::string& table, const std::string& key, double value) {
  const auto text = readWholeFile(path, FileSize::Settings, "cannot be read");
  if (!text && text.error().os_error != ENOENT) return failOn(path, text.error());
  const auto edited = withNumber(text.value_or(""), table, key, value);
  if (!edited) {
    return failOn(path + ": " + table,
                  {ErrorCode::Unsupported, 0,
                   "the table is written inline; write it as [table] and lines below, then try again"});
  }
  std::error_code none;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), none);
  auto file = AtomicFile::create(path);
  if (!file) return failOn(path, file.error());
  file->write(*edited);
  if (auto written = file->commit(); !written) return failOn(path, written.error());
  return {};
}

}  // namespace relievo
