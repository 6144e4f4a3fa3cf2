// SPDX-License-Identifier: Apache-2.0
// The thread shares its memory with the maker: one that never comes back from a dead disk keeps it alive.
#include "app/player/browse/poster_maker.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "app/media/reading/picture_look.h"
#include "platform/files/file_system_answer.h"

namespace relievo {
namespace {

constexpr int kNice = 5;

// A picture that is not blank, a little way into the film; for a film without a length, the first one.
std::optional<Frame> tellingPictureOf(PairReader& reader) {
  constexpr std::array kPlaces{0.1, 0.2, 0.4};
  std::optional<Frame> found;
  const auto take = [&] {
    if (auto pair = reader.next(); pair && *pair) found = (*pair)->color;
    return found && !isBlank(*found);
  };
  const double length_s = toSeconds(reader.info().duration);
  if (length_s <= 0 && take()) return found;
  for (const double place : kPlaces) {
    if (length_s > 0 && reader.seek(mediaTime(place * length_s), std::chrono::seconds(1)) && take()) return found;
  }
  if (!found && reader.seek(MediaTime{})) static_cast<void>(take());
  return found;
}

}  // namespace

struct PosterMaker::Shared {
  Shared(PairReader::Backends backends, SourceOptions source)
      : reader(std::move(backends)), options(std::move(source)) {
    options.sound.reset();
  }
  void threadMain();
  [[nodiscard]] std::optional<WishedPoster> nextWish();
  [[nodiscard]] bool isUnwanted() const;
  [[nodiscard]] std::shared_ptr<const Poster> make(const WishedPoster& film);
  [[nodiscard]] std::shared_ptr<const Poster> find(const std::string& url) const;
  void interrupt() noexcept {
    interrupted = true;
    reader.interrupt();
  }

  PairReader reader;                     // used by the thread, except `interrupt`
  SourceOptions options;                 // likewise
  std::atomic<bool> interrupted{false};  // ends what is asked of the file system, such as of what kind a file is
  mutable std::mutex mutex;              // of all below
  std::condition_variable done;
  std::vector<WishedPoster> wishes;
  std::deque<std::pair<std::string, std::shared_ptr<const Poster>>> made;
  std::string at;  // the film being read; empty: none
  std::chrono::steady_clock::time_point since;
  bool left = false;  // it is no longer requested
  bool running = false, stopping = false, news = false;
};

PosterMaker::PosterMaker(PairReader::Backends backends, SourceOptions options) {
  if (backends.make_source) shared_ = std::make_shared<Shared>(std::move(backends), std::move(options));
}

PosterMaker::~PosterMaker() {
  if (!shared_) return;
  std::unique_lock lock(shared_->mutex);
  shared_->stopping = true;
  shared_->wishes.clear();
  if (!shared_->at.empty()) shared_->interrupt();
  shared_->done.wait_for(lock, std::chrono::milliseconds(500), [this] { return !shared_->running; });
}

void PosterMaker::wish(const std::vector<WishedPoster>& films) {
  if (!shared_) return;
  const std::scoped_lock lock(shared_->mutex);
  shared_->wishes = films;
  const auto isWished = [&](const std::string& url) {
    return std::ranges::find(films, url, &WishedPoster::url) != films.end();
  };
  if (!shared_->at.empty() && !isWished(shared_->at)) {
    shared_->left = true;
    shared_->interrupt();
  }
  if (films.empty() || std::exchange(shared_->running, true)) return;
  std::thread([shared = shared_] { shared->threadMain(); }).detach();
}

bool PosterMaker::attend() {
  if (!shared_) return false;
  const std::scoped_lock lock(shared_->mutex);
  if (!shared_->at.empty() && std::chrono::steady_clock::now() - shared_->since > kLongest) shared_->interrupt();
  return std::exchange(shared_->news, false);
}

std::shared_ptr<const Poster> PosterMaker::find(const std::string& url) const {
  if (!shared_) return nullptr;
  const std::scoped_lock lock(shared_->mutex);
  return shared_->find(url);
}

std::shared_ptr<const Poster> PosterMaker::Shared::find(const std::string& url) const {
  const auto known = std::ranges::find(made, url, [](const auto& each) { return each.first; });
  return known == made.end() ? nullptr : known->second;
}

std::optional<WishedPoster> PosterMaker::Shared::nextWish() {
  for (const WishedPoster& film : wishes) {
    if (find(film.url) == nullptr) return film;
  }
  return std::nullopt;
}

// `open` forgets an interruption that came before it.
bool PosterMaker::Shared::isUnwanted() const {
  const std::scoped_lock lock(mutex);
  return left || stopping;
}

std::shared_ptr<const Poster> PosterMaker::Shared::make(const WishedPoster& film) {
  options.url = film.url;
  options.depth_url = film.depth_url;
  auto poster = std::make_shared<Poster>();
  if (reader.open(options) && !isUnwanted()) {
    poster->length_s = toSeconds(reader.info().duration);
    if (const auto picture = tellingPictureOf(reader)) poster->picture = posterOf(*picture);
  }
  reader.close();
  return poster;
}

// Ends when there is nothing to make, so that there is no such thread while a film is played.
void PosterMaker::Shared::threadMain() {
  const CancelsAnswers cancels(interrupted);
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
  std::unique_lock lock(mutex);
  while (!stopping) {
    const auto film = nextWish();
    if (!film) break;
    at = film->url;
    left = interrupted = false;
    since = std::chrono::steady_clock::now();
    lock.unlock();
    auto poster = make(*film);
    lock.lock();
    if (!left || !poster->empty()) made.emplace_front(at, std::move(poster));
    if (made.size() > kMostKept) made.pop_back();
    news = true;
    at.clear();
  }
  running = false;
  done.notify_all();
}

}  // namespace relievo
