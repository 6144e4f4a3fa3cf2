// SPDX-License-Identifier: Apache-2.0
// toml++ reads it; a number is set line by line, since no writer keeps comments.
#include "app/player/config_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include "platform/atomic_file.h"

namespace relievo {
namespace {

constexpr const char* kSystemPath = "/etc/relievo/relievo.toml";

std::unexpected<Failure> wrong(const std::string& path, const toml::source_region& where, const char* message) {
  return failOn(path + ":" + std::to_string(where.begin.line), {ErrorCode::InvalidArgument, 0, message});
}

Outcome<FileConfig> read(const std::string& path, const std::string& text) {
  toml::table parsed;
  try {
    parsed = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    return wrong(path, error.source(), "this is no TOML; a line is key = value under a [table]");
  }
  FileConfig config;
  for (const auto& [table_name, table_node] : parsed) {
    const toml::table* table = table_node.as_table();
    if (table == nullptr || table_name.str() != "falcon") {
      return wrong(path, table_node.source(), "unknown; the tables are: falcon");
    }
    for (const auto& [key, node] : *table) {
      if (key.str() == "firmware") {
        config.falcon_firmware = node.value<std::string>();
        if (!config.falcon_firmware) return wrong(path, node.source(), "falcon.firmware is a path in quotes");
      } else if (key.str() == "counts_per_nm") {
        config.falcon_counts_per_nm = node.value<double>();
        const double counts = config.falcon_counts_per_nm.value_or(0);
        if (!(counts >= 1000 && counts <= 100'000)) {
          return wrong(path, node.source(), "falcon.counts_per_nm is a number from 1000 to 100000");
        }
      } else {
        return wrong(path, node.source(), "unknown; falcon has firmware and counts_per_nm");
      }
    }
  }
  return config;
}

}  // namespace

std::string defaultConfigPath() {
  const char* xdg = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  std::filesystem::path own;
  if (xdg != nullptr && *xdg != '\0') own = xdg;
  else if (home != nullptr && *home != '\0') own = std::filesystem::path(home) / ".config";
  std::error_code none;
  if (!own.empty() && std::filesystem::exists(own / "relievo/relievo.toml", none)) return own / "relievo/relievo.toml";
  return kSystemPath;
}

Outcome<FileConfig> loadConfig(const std::string& path) {
  const std::string name = path.empty() ? defaultConfigPath() : path;
  std::ifstream file(name);
  if (!file) {
    if (path.empty() && errno == ENOENT) return FileConfig{};
    return failOn(name, {ErrorCode::NotFound, errno, "the configuration cannot be read; check its path"});
  }
  std::ostringstream text;
  text << file.rdbuf();
  return read(name, text.str());
}

std::string withNumber(const std::string& text, const std::string& table, const std::string& key, double value) {
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
  return result;
}

Outcome<void> setNumber(const std::string& path, const std::string& table, const std::string& key, double value) {
  std::ostringstream text;
  if (const std::ifstream file(path); file) text << file.rdbuf();
  std::error_code none;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), none);
  auto file = AtomicFile::create(path);
  if (!file) return failOn(path, file.error());
  file->write(withNumber(text.str(), table, key, value));
  if (auto written = file->commit(); !written) return failOn(path, written.error());
  return {};
}

}  // namespace relievo
