// SPDX-License-Identifier: Apache-2.0
// The results lie in memory that the threads share: a thread that never returns from a dead disk keeps it alive.
#include "app/player/browse/film_finder.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "app/media/folder/film_folder.h"
#include "hal/media/media_names.h"
#include "platform/log.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFiles = "";  // place of the requested files

class Search {
 public:
  Search(std::string place, const std::atomic<bool>& stop) : place_(std::move(place)), stop_(stop) {}

  std::vector<ShelfFilm> films() {
    search(place_, 0);
    return std::move(films_);
  }
  // The error if the place itself could not be read.
  [[nodiscard]] std::error_code failure() const noexcept { return failure_; }

 private:
  void search(const fs::path& folder, int deep) {
    std::vector<std::string> names, folders;
    std::error_code failed;
    fs::directory_iterator entries(folder, failed);
    if (failed && deep == 0) failure_ = failed;
    for (; !failed && entries != fs::directory_iterator() && goesOn(); entries.increment(failed)) {
      const std::string name = entries->path().filename().string();
      ++seen_;
      if (name.starts_with('.')) continue;
      std::error_code none;
      const bool is_folder = entries->is_directory(none);
      if (is_folder && !entries->is_symlink(none)) folders.push_back(name);
      else if (!is_folder && mediaKindOf(name) == MediaKind::Film) names.push_back(name);
    }
    if (deep > 0 && std::ranges::find(folders, "depth") != folders.end()) {
      return add({.url = folder.string(), .depth_url = "", .title = folder.filename().string()}, folder.parent_path());
    }
    for (PlaylistEntry& film : pairedFilms(folder.string(), std::move(names))) add(std::move(film), folder);
    if (deep == kDeepest) return;
    std::ranges::sort(folders, naturalLess);
    for (const std::string& name : folders) search(folder / name, deep + 1);
  }

  void add(PlaylistEntry film, const fs::path& folder) {
    if (films_.size() == kMostFilms) return;
    std::string within = folder.lexically_relative(place_).string();
    if (within == ".") within.clear();
    films_.push_back({.url = std::move(film.url),
                      .depth_url = std::move(film.depth_url),
                      .title = std::move(film.title),
                      .folder = std::move(within),
                      .left_s = std::nullopt});
  }

  [[nodiscard]] bool goesOn() const noexcept { return !stop_ && seen_ < kMostNames && films_.size() < kMostFilms; }

  const std::string place_;
  const std::atomic<bool>& stop_;
  std::vector<ShelfFilm> films_;
  std::error_code failure_;
  std::size_t seen_ = 0;
};

std::vector<std::string> thoseThatExist(const std::vector<std::string>& files, const std::atomic<bool>& stop) {
  std::vector<std::string> there;
  for (const std::string& file : files) {
    std::error_code none;
    if (!stop && fs::exists(file, none)) there.push_back(file);
  }
  return there;
}

}  // namespace

struct FilmFinder::Shared {
  void read(const std::string& place, const std::vector<std::string>& files);

  std::mutex mutex;  // of all below
  std::condition_variable done;
  std::map<std::string, std::vector<ShelfFilm>> films;
  std::map<std::string, std::error_code> failures;  // of places that could not be read
  std::vector<std::string> there;
  std::set<std::string> read_now;
  bool news = false;
  std::atomic<bool> stop{false};
};

FilmFinder::~FilmFinder() {
  if (!shared_) return;
  shared_->stop = true;
  std::unique_lock lock(shared_->mutex);
  shared_->done.wait_for(lock, std::chrono::milliseconds(500), [this] { return shared_->read_now.empty(); });
}

void FilmFinder::look(const std::vector<std::string>& folders, const std::vector<std::string>& files) {
  if (!shared_) shared_ = std::make_shared<Shared>();
  {
    const std::scoped_lock lock(shared_->mutex);
    const auto isUnnamed = [&](const auto& known) { return std::ranges::find(folders, known.first) == folders.end(); };
    if (std::erase_if(shared_->films, isUnnamed) > 0) shared_->news = true;
  }
  for (const std::string& folder : folders) read(folder, {});
  read(kFiles, files);
}

// A thread that hangs is abandoned.
void FilmFinder::read(const std::string& place, const std::vector<std::string>& files) {
  {
    const std::scoped_lock lock(shared_->mutex);
    if (!shared_->read_now.insert(place).second) return;
  }
  if (!own_threads_) return shared_->read(place, files);
  std::thread([shared = shared_, place, files] { shared->read(place, files); }).detach();
}

void FilmFinder::Shared::read(const std::string& place, const std::vector<std::string>& files) {
  Search search(place, stop);
  auto found = place == kFiles ? std::vector<ShelfFilm>{} : search.films();
  auto found_files = thoseThatExist(files, stop);
  const std::scoped_lock lock(mutex);
  if (place == kFiles) {
    news = news || found_files != there;
    there = std::move(found_files);
  } else {
    const auto known = films.find(place);
    news = news || known == films.end() || known->second != found || failures[place] != search.failure();
    films[place] = std::move(found);
    failures[place] = search.failure();
  }
  read_now.erase(place);
  done.notify_all();
}

std::error_code FilmFinder::failureOf(const std::string& folder) const {
  if (!shared_) return {};
  const std::scoped_lock lock(shared_->mutex);
  const auto known = shared_->failures.find(folder);
  return known == shared_->failures.end() ? std::error_code{} : known->second;
}

bool FilmFinder::hasNews() {
  if (!shared_) return false;
  const std::scoped_lock lock(shared_->mutex);
  return std::exchange(shared_->news, false);
}

std::vector<ShelfFilm> FilmFinder::filmsIn(const std::string& folder) const {
  if (!shared_) return {};
  const std::scoped_lock lock(shared_->mutex);
  const auto known = shared_->films.find(folder);
  return known == shared_->films.end() ? std::vector<ShelfFilm>{} : known->second;
}

std::vector<std::string> FilmFinder::there() const {
  if (!shared_) return {};
  const std::scoped_lock lock(shared_->mutex);
  return shared_->there;
}

}  // namespace relievo
