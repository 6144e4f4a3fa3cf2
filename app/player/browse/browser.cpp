// SPDX-License-Identifier: Apache-2.0
#include "app/player/browse/browser.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "app/media/playlist.h"
#include "app/player/browse/shelf_view.h"
#include "app/player/film/resume.h"
#include "platform/print.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

bool isOn(const std::string& path, const std::string& place) noexcept {
  return path.starts_with(place) && (path.size() == place.size() || path[place.size()] == '/');
}

// The last part of a path, for a heading.
std::string nameOf(const std::string& place) {
  const fs::path path(place);
  const std::string name = (path.has_filename() ? path : path.parent_path()).filename().string();
  return name.empty() ? place : name;
}

std::string titleOf(const std::string& url) {
  return fs::path(withoutQuery(url)).stem().string();
}

bool isAddress(const std::string& url) noexcept {
  return url.find("://") != std::string::npos;
}

}  // namespace

Browser::Browser(BrowserConfig config, PairReader::Backends posters, SourceOptions options, bool own_threads)
    : config_([&] {
        for (std::string& folder : config.folders) folder = Resume::keyOf(folder);
        return std::move(config);
      }()),
      sticks_(config_.stick_roots),
      finder_(own_threads),
      posters_(std::move(posters), std::move(options)) {}

void Browser::open(LeftFilms left, MonotonicTime now) {
  left_ = std::move(left);
  static_cast<void>(sticks_.changed());
  look(now);
  fill();
}

void Browser::close() {
  posters_.wish({});
  view_.pointed.reset();
  static_cast<void>(sticks_.changed());
  sticks_before_ = sticks_.sticks();
}

bool Browser::attend(MonotonicTime now) {
  if (sticks_.changed() || now >= next_look_) look(now);
  if (finder_.hasNews()) fill();
  if (posters_.attend()) draw();
  return std::exchange(changed_, false);
}

std::optional<std::string> Browser::takenAway(const std::string& film) {
  if (!sticks_.changed()) return std::nullopt;
  const std::string path = Resume::keyOf(film);
  for (const std::string& stick : std::exchange(sticks_before_, sticks_.sticks())) {
    if (isOn(path, stick) && std::ranges::find(sticks_.sticks(), stick) == sticks_.sticks().end()) return stick;
  }
  return std::nullopt;
}

void Browser::selectBy(std::ptrdiff_t films) {
  moved_ = true;
  shelf_.selectBy(films);
  draw();
}

void Browser::select(std::size_t film) {
  moved_ = true;
  shelf_.select(film);
  draw();
}

void Browser::point(std::optional<std::size_t> film) {
  if (view_.pointed == film) return;
  view_.pointed = film;
  changed_ = true;
}

void Browser::warn(bool warned) {
  if (std::exchange(warned_, warned) != warned) draw();
}

void Browser::look(MonotonicTime now) {
  next_look_ = now + kLookPeriod;
  std::vector<std::string> files;
  for (const auto& [key, left_s] : left_) {
    if (!isAddress(key)) files.push_back(key);
  }
  finder_.look(places(), files);
}

// Folders first; a stick that holds one of them is not listed again.
std::vector<std::string> Browser::places() const {
  std::vector<std::string> all = config_.folders;
  for (const std::string& stick : sticks_.sticks()) {
    const auto holds = [&](const std::string& folder) { return isOn(folder, stick); };
    if (std::ranges::none_of(config_.folders, holds)) all.push_back(stick);
  }
  return all;
}

void Browser::fill() {
  std::map<std::string, double> left(left_.begin(), left_.end());
  std::map<std::string, ShelfFilm> known;  // by the key under which their position is kept
  std::vector<ShelfSection> sections(1, {.name = "Recent", .films = {}});
  for (const std::string& place : places()) {
    ShelfSection section{.name = nameOf(place), .films = finder_.filmsIn(place)};
    for (ShelfFilm& film : section.films) {
      const std::string key = Resume::keyOf(film.url);
      if (const auto found = left.find(key); found != left.end()) film.left_s = found->second;
      if (film.left_s) known.emplace(key, film);
    }
    if (!section.films.empty()) sections.push_back(std::move(section));
  }
  const std::vector<std::string> there = finder_.there();
  for (const auto& [key, left_s] : left_) {
    if (sections.front().films.size() == kMostRecent) break;
    if (!isAddress(key) && std::ranges::find(there, key) == there.end()) continue;
    ShelfFilm film{.url = key, .depth_url = "", .title = titleOf(key), .folder = "", .left_s = left_s};
    if (const auto found = known.find(key); found != known.end()) film = found->second;
    sections.front().films.push_back(std::move(film));
  }
  if (sections.front().films.empty()) sections.erase(sections.begin());
  shelf_.put(std::move(sections));
  if (!moved_) shelf_.select(0);
  draw();
}

void Browser::draw() {
  const auto pointed = view_.pointed;
  view_ = viewOf(
      shelf_, [this](const std::string& url) { return posters_.find(url); }, nothingThere(),
      warned_ ? ScreenList::kBottomOverWarning : ScreenList::kBottom);
  view_.pointed = pointed;
  changed_ = true;
  std::vector<WishedPoster> wishes;
  for (const ScreenListRow& row : view_.rows) {
    if (!row.film || isAddress(shelf_.film(*row.film).url)) continue;
    const ShelfFilm& film = shelf_.film(*row.film);
    const WishedPoster wish{film.url, film.depth_url};
    if (*row.film == shelf_.selected()) wishes.insert(wishes.begin(), wish);
    else wishes.push_back(wish);
  }
  posters_.wish(wishes);
}

std::string Browser::nothingThere() const {
  const char* const drop = config_.takes_drops ? ", or drop a film here" : "";
  for (const std::string& place : config_.folders) {
    const std::error_code failure = finder_.failureOf(place);
    if (failure == std::errc::no_such_file_or_directory) {
      return print("There is no folder %s: make it and put films in it, or name another (--films)%s", place.c_str(),
                   drop);
    }
    if (failure == std::errc::not_a_directory) return place + " is not a folder: name one (--films)";
    if (failure) return "The folder " + place + " cannot be read: " + failure.message();
  }
  const std::string folder = config_.folders.empty() ? "" : "put films in " + config_.folders.front() + " or ";
  return "No films yet: " + folder + "plug in a USB stick" + drop;
}

}  // namespace relievo
