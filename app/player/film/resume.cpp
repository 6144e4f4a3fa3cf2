// SPDX-License-Identifier: Apache-2.0
// A short list, given to the file writer when it has changed.
#include "app/player/film/resume.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "platform/files/answered_place.h"
#include "platform/log.h"
#include "platform/named_folder.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

using Json = nlohmann::json;

using Films = std::vector<std::pair<std::string, double>>;

// The valid part of the file; empty if there is none.
Result<Films> load(const std::string& path) {
  Films films;
  const auto text = readWholeFile(path, FileSize::Settings, "");
  if (!text && text.error().code != ErrorCode::NotFound) return std::unexpected(text.error());
  const Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (!json.is_array()) return films;
  for (const Json& row : json) {
    if (films.size() == Resume::kMostFilms) break;
    if (!row.is_array() || row.size() != 2 || !row[0].is_string() || !row[1].is_number()) continue;
    const double seconds = row[1].get<double>();
    if (seconds >= 0 && seconds < 1e6) films.emplace_back(row[0].get<std::string>(), seconds);
  }
  return films;
}

void tell(const std::string& path, const Error& error) {
  log(LogLevel::Warning, "play", "%s: films will start from the beginning: %s", path.c_str(), error.message);
}

Result<void> write(const std::string& path, const Films& films) {
  if (auto made = makeFolders(std::filesystem::path(path).parent_path()); !made) return made;
  return writeFile(path, Json(films).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace

std::string Resume::defaultPath() {
  if (const auto state = namedFolder("STATE_DIRECTORY"); !state.empty()) return state / "resume.json";
  if (const auto xdg = namedFolder("XDG_STATE_HOME"); !xdg.empty()) return xdg / "relievo/resume.json";
  if (const auto home = namedFolder("HOME"); !home.empty()) return home / ".local/state/relievo/resume.json";
  return "";
}

std::string Resume::keyOf(const std::string& url) {
  if (url.find("://") != std::string::npos) return url;
  std::error_code none;
  const auto path = std::filesystem::absolute(url, none);
  return none ? url : path.lexically_normal().string();
}

Resume::Resume(std::string path, FileWriter& files) : path_(std::move(path)), files_(files) {
  auto films = load(path_);
  if (films) films_ = std::move(*films);
  else tell(std::exchange(path_, {}), films.error());
  state_->kept = films.has_value();
}

std::optional<std::string> Resume::last() const {
  return films_.empty() ? std::nullopt : std::optional(films_.front().first);
}

std::optional<MediaTime> Resume::find(const std::string& url) const {
  const auto film = std::ranges::find(films_, keyOf(url), &Films::value_type::first);
  if (film == films_.end()) return std::nullopt;
  return mediaTime(film->second);
}

std::vector<std::pair<std::string, double>> Resume::all() const {
  return films_;
}

void Resume::keep(const std::string& url, MediaTime position) {
  if (position.time_since_epoch() < kLeast) return forget(url);
  const std::pair entry(keyOf(url), toSeconds(position));
  if (!films_.empty() && films_.front() == entry) return;  // a paused film
  std::erase_if(films_, [&](const auto& film) { return film.first == entry.first; });
  films_.insert(films_.begin(), entry);
  if (films_.size() > kMostFilms) films_.pop_back();
  changed();
}

void Resume::forget(const std::string& url) {
  const std::string key = keyOf(url);
  if (std::erase_if(films_, [&](const auto& film) { return film.first == key; }) > 0) changed();
}

void Resume::changed() {
  if (path_.empty()) return;
  files_.give(path_, [path = path_, films = films_, state = state_] {
    const auto written = write(path, films);
    state->kept = written.has_value();
    if (written || std::exchange(state->told, true)) return;
    tell(path, written.error());
  });
}

}  // namespace relievo
