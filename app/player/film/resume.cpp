// SPDX-License-Identifier: Apache-2.0
// A short list under a mutex, and a thread that writes it when it has changed.
#include "app/player/film/resume.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "platform/atomic_file.h"
#include "platform/log.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

using Json = nlohmann::json;

// What of the file makes sense.
std::vector<std::pair<std::string, double>> load(const std::string& path) {
  std::vector<std::pair<std::string, double>> films;
  const auto text = readWholeFile(path, FileSize::Settings, "");
  if (!text) return films;
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_array()) return films;
  for (const Json& row : json) {
    if (films.size() == Resume::kMostFilms) break;
    if (!row.is_array() || row.size() != 2 || !row[0].is_string() || !row[1].is_number()) continue;
    const double seconds = row[1].get<double>();
    if (seconds >= 0 && seconds < 1e6) films.emplace_back(row[0].get<std::string>(), seconds);
  }
  return films;
}

}  // namespace

std::string Resume::defaultPath() {
  const auto set = [](const char* name) -> std::filesystem::path {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
  };
  if (const auto state = set("STATE_DIRECTORY"); !state.empty()) return state / "resume.json";
  if (const auto xdg = set("XDG_STATE_HOME"); !xdg.empty()) return xdg / "relievo/resume.json";
  if (const auto home = set("HOME"); !home.empty()) return home / ".local/state/relievo/resume.json";
  return "";
}

std::string Resume::keyOf(const std::string& url) {
  if (url.find("://") != std::string::npos) return url;
  std::error_code none;
  const auto path = std::filesystem::absolute(url, none);
  return none ? url : path.lexically_normal().string();
}

Resume::Resume(std::string path) : path_(std::move(path)), films_(load(path_)), thread_([this] { threadMain(); }) {}

Resume::~Resume() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    wake_.notify_all();
  }
  thread_.join();
}

std::optional<std::string> Resume::last() const {
  const std::scoped_lock lock(mutex_);
  return films_.empty() ? std::nullopt : std::optional(films_.front().first);
}

std::optional<MediaTime> Resume::find(const std::string& url) const {
  const std::scoped_lock lock(mutex_);
  const auto film = std::ranges::find(films_, keyOf(url), &Films::value_type::first);
  if (film == films_.end()) return std::nullopt;
  return mediaTime(film->second);
}

std::vector<std::pair<std::string, double>> Resume::all() const {
  const std::scoped_lock lock(mutex_);
  return films_;
}

void Resume::keep(const std::string& url, MediaTime position) {
  if (position.time_since_epoch() < kLeast) return forget(url);
  const std::scoped_lock lock(mutex_);
  const std::string key = keyOf(url);
  std::erase_if(films_, [&](const auto& film) { return film.first == key; });
  films_.emplace(films_.begin(), key, toSeconds(position));
  if (films_.size() > kMostFilms) films_.pop_back();
  changed();
}

void Resume::forget(const std::string& url) {
  const std::scoped_lock lock(mutex_);
  const std::string key = keyOf(url);
  if (std::erase_if(films_, [&](const auto& film) { return film.first == key; }) > 0) changed();
}

void Resume::changed() {
  dirty_ = true;
  wake_.notify_all();
}

void Resume::write(const Films& films) {
  const Json json(films);
  std::error_code none;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), none);
  auto file = AtomicFile::create(path_);
  Result<void> written = file ? Result<void>{} : std::unexpected(file.error());
  if (file) {
    file->write(json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    written = file->commit();
  }
  if (written || std::exchange(told_, true)) return;
  log(LogLevel::Warning, "play", "%s: %s; films will start from the beginning", path_.c_str(), written.error().message);
}

void Resume::threadMain() {
  std::unique_lock lock(mutex_);
  while (!stopping_ || dirty_) {
    wake_.wait(lock, [this] { return dirty_ || stopping_; });
    if (!std::exchange(dirty_, false)) continue;
    const Films films = films_;
    lock.unlock();
    write(films);
    lock.lock();
  }
}

}  // namespace relievo
