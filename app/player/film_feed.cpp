// SPDX-License-Identifier: Apache-2.0
// The two sides of the feed: requests and a queue under one mutex, which is never held while the film is read.
#include "app/player/film_feed.h"

#include <chrono>
#include <utility>

namespace relievo {

FilmFeed::FilmFeed(PairReader::Backends backends, std::size_t capacity)
    : capacity_(capacity), reader_(std::move(backends)) {}

FilmFeed::~FilmFeed() {
  stop();
}

void FilmFeed::startThread() {
  if (!thread_.joinable()) thread_ = std::thread([this] { threadMain(); });
}

void FilmFeed::stop() noexcept {
  {
    std::unique_lock lock(mutex_);
    if (std::exchange(stopping_, true)) return;
    wake_.notify_all();
    // An interrupt that comes just before the reader opens a source does not reach it: so it is repeated.
    while (thread_.joinable() && !thread_ended_) {
      lock.unlock();
      reader_.interrupt();
      lock.lock();
      wake_.wait_for(lock, std::chrono::milliseconds(10), [this] { return thread_ended_; });
    }
    queue_.clear();
    state_ = State::Closed;
  }
  if (thread_.joinable()) thread_.join();
  reader_.close();
}

void FilmFeed::open(SourceOptions options) {
  const std::scoped_lock lock(mutex_);
  if (state_ != State::Closed) return;
  options_ = std::move(options);
  state_ = State::Opening;
  wake_.notify_all();
}

void FilmFeed::seek(MediaTime target) {
  std::deque<FramePair> dropped;  // freed after the lock
  const std::scoped_lock lock(mutex_);
  if (state_ != State::Reading && state_ != State::Ended && state_ != State::Seeking) return;
  target_ = target;
  ++generation_;
  queue_.swap(dropped);
  state_ = State::Seeking;
  wake_.notify_all();
}

FilmFeed::State FilmFeed::state() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

std::optional<FramePair> FilmFeed::take() {
  const std::scoped_lock lock(mutex_);
  if (queue_.empty()) return std::nullopt;
  std::optional<FramePair> pair(std::move(queue_.front()));
  queue_.pop_front();
  wake_.notify_all();
  return pair;
}

FilmInfo FilmFeed::info() const {
  const std::scoped_lock lock(mutex_);
  return info_;
}

PairCounters FilmFeed::counters() const {
  const std::scoped_lock lock(mutex_);
  return counters_;
}

Error FilmFeed::error() const {
  const std::scoped_lock lock(mutex_);
  return error_;
}

std::string FilmFeed::failedThing() const {
  const std::scoped_lock lock(mutex_);
  return failed_thing_;
}

std::optional<Error> FilmFeed::takeSeekError() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(seek_error_, std::nullopt);
}

bool FilmFeed::hasWork() const {
  return state_ == State::Opening || state_ == State::Seeking ||
         (state_ == State::Reading && queue_.size() < capacity_);
}

bool FilmFeed::work() {
  std::unique_lock lock(mutex_);
  if (stopping_ || !hasWork()) return false;
  const State task = state_;
  const MediaTime target = target_;
  const std::uint64_t generation = generation_;
  if (task == State::Opening) {
    const SourceOptions options = options_;
    lock.unlock();
    workOpen(options);
    return true;
  }
  lock.unlock();
  if (task == State::Seeking) {
    workSeek(target, generation);
  } else {
    workRead(generation);
  }
  return true;
}

void FilmFeed::workOpen(const SourceOptions& options) {
  const auto opened = reader_.open(options);
  const std::scoped_lock lock(mutex_);
  if (!opened) return failed(opened.error());
  info_ = reader_.info();
  state_ = State::Reading;
}

void FilmFeed::workSeek(MediaTime target, std::uint64_t generation) {
  const auto sought = reader_.seek(target);
  const std::scoped_lock lock(mutex_);
  if (generation != generation_) return;  // a newer target has come meanwhile
  if (!sought) seek_error_ = sought.error();
  state_ = State::Reading;
}

void FilmFeed::workRead(std::uint64_t generation) {
  auto pair = reader_.next();
  const PairCounters counters = reader_.counters();
  const std::scoped_lock lock(mutex_);
  counters_ = counters;
  if (generation != generation_) return;
  if (!pair) return failed(pair.error());
  if (!*pair) {
    state_ = State::Ended;
    return;
  }
  queue_.push_back(std::move(**pair));
}

void FilmFeed::failed(const Error& error) {
  error_ = error;
  failed_thing_ = reader_.failedThing().empty() ? options_.url : reader_.failedThing();
  state_ = State::Failed;
}

void FilmFeed::threadMain() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || hasWork(); });
      if (stopping_) break;
    }
    work();
  }
  const std::scoped_lock lock(mutex_);
  thread_ended_ = true;
  wake_.notify_all();
}

}  // namespace relievo
