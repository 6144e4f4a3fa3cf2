// SPDX-License-Identifier: Apache-2.0
// The player's side of the feed: requests and a queue under one mutex, which is never held while the film is read.
#include "app/media/film_feed.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace relievo {

FilmFeed::FilmFeed(PairReader::Backends backends, std::size_t capacity)
    : capacity_(capacity), backends_(std::move(backends)), reader_(backends_) {}

FilmFeed::~FilmFeed() {
  stop();
}

void FilmFeed::startThread() {
  if (!reader_side_.thread.joinable()) reader_side_.thread = std::thread([this] { threadMain(); });
}

void FilmFeed::stop() noexcept {
  {
    std::unique_lock lock(mutex_);
    if (std::exchange(reader_side_.stopping, true)) return;
    wake_.notify_all();
    // Repeated, because an interrupt that arrives just before the reader opens a source has no effect.
    while (reader_side_.thread.joinable() && !reader_side_.ended) {
      lock.unlock();
      interrupted_ = true;
      reader_.interrupt();
      lock.lock();
      wake_.wait_for(lock, std::chrono::milliseconds(10), [this] { return reader_side_.ended; });
    }
    queue_.clear();
    sound_.forget();
    state_ = State::Closed;
  }
  if (reader_side_.thread.joinable()) reader_side_.thread.join();
  reader_.close();
}

void FilmFeed::open(SourceOptions options) {
  const std::scoped_lock lock(mutex_);
  request_.options = std::move(options);
  begin(State::Opening);
}

void FilmFeed::close() {
  const std::scoped_lock lock(mutex_);
  begin(State::Closed);
}

void FilmFeed::begin(State state) {
  ++counts_.film;
  ++counts_.generation;
  queue_.clear();
  sound_.forget();
  words_.clear();
  request_.tracks_due = request_.format_due = request_.words_due = false;
  request_.target = MediaTime{};
  request_.leave_out = false;
  request_.until.reset();
  request_.turn = 0;
  films_.clear();
  seek_error_.reset();
  news_ = {};
  info_ = {};
  counters_ = {};
  state_ = state;
  interruptStale();
  wake_.notify_all();
}

// Interrupts the reader if it still works on a film that has been closed or replaced. Callers repeat this, because an
// interrupt that arrives just before the reader opens that film has no effect.
void FilmFeed::interruptStale() const {
  if (counts_.at_work == 0 || counts_.at_work == counts_.film) return;
  interrupted_ = true;
  reader_.interrupt();
}

void FilmFeed::seek(MediaTime target, Duration key_step) {
  std::deque<FramePair> dropped;  // destroyed after the lock is released
  const std::scoped_lock lock(mutex_);
  const bool away = state_ == State::Reconnecting;
  if (!away && state_ != State::Reading && state_ != State::Ended && state_ != State::Seeking) return;
  request_.target = target;
  request_.key_step = key_step;
  ++counts_.generation;
  queue_.swap(dropped);
  sound_.forget();
  (away ? loss_.before : state_) = State::Seeking;
  wake_.notify_all();
}

void FilmFeed::leaveOut(bool unreferenced, std::optional<MediaTime> until) {
  const std::scoped_lock lock(mutex_);
  request_.leave_out = unreferenced;
  request_.until = until;
}

void FilmFeed::turn(int turn) {
  const std::scoped_lock lock(mutex_);
  request_.turn = turn;
  for (FramePair& pair : queue_) turnTo(pair, turn);
}

FilmFeed::Effort FilmFeed::effort() const {
  const std::scoped_lock lock(mutex_);
  // A thread that has been woken may have to wait for a processor: it counts as at work.
  return {.rested = wantsPair() ? rest_.ended() : rest_.until(now()),
          .decodes = wantsPair() && !reader_.waitsForSource()};
}

FilmFeed::State FilmFeed::state() const {
  const std::scoped_lock lock(mutex_);
  interruptStale();
  return state_;
}

std::vector<PlaylistEntry> FilmFeed::films() const {
  const std::scoped_lock lock(mutex_);
  return films_;
}

std::optional<FramePair> FilmFeed::take() {
  const std::scoped_lock lock(mutex_);
  if (queue_.empty()) return std::nullopt;
  std::optional<FramePair> pair(std::move(queue_.front()));
  queue_.pop_front();
  wake_.notify_all();
  return pair;
}

std::size_t FilmFeed::peekDepths(std::span<Frame> depths) const {
  const std::scoped_lock lock(mutex_);
  const std::size_t count = std::min(depths.size(), queue_.size());
  for (std::size_t i = 0; i < count; ++i) depths[i] = queue_[i].depth;
  return count;
}

std::optional<AudioChunk> FilmFeed::takeSound() {
  const std::scoped_lock lock(mutex_);
  auto chunk = sound_.take(request_.options.sound);
  if (chunk) wake_.notify_all();
  return chunk;
}

std::optional<Subtitle> FilmFeed::takeSubtitle() {
  const std::scoped_lock lock(mutex_);
  if (words_.empty()) return std::nullopt;
  std::optional<Subtitle> subtitle(std::move(words_.front()));
  words_.pop_front();
  return subtitle;
}

void FilmFeed::chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words) {
  const std::scoped_lock lock(mutex_);
  request_.sound = sound;
  request_.words = words;
  request_.tracks_due = true;
  if (changesWords()) {
    words_.clear();
    request_.words_due = true;
  }
  wake_.notify_all();
}

void FilmFeed::setSoundFormat(const AudioFormat& format) {
  const std::scoped_lock lock(mutex_);
  request_.options.sound = format;
  request_.format_due = true;
  sound_.forget();
  sound_.may_come = hasSound();
  wake_.notify_all();
}

void FilmFeed::addSubtitles(FilmTrack file) {
  const std::scoped_lock lock(mutex_);
  info_.subtitles.push_back(std::move(file));
}

bool FilmFeed::hasSoundUntil(MediaTime time) const {
  const std::scoped_lock lock(mutex_);
  return !wantsSound() || (sound_.until() && *sound_.until() >= time);
}

FilmInfo FilmFeed::info() const {
  const std::scoped_lock lock(mutex_);
  return info_;
}

PairCounters FilmFeed::counters() const {
  const std::scoped_lock lock(mutex_);
  return counters_;
}

Failure FilmFeed::failure() const {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

std::optional<Error> FilmFeed::takeSeekError() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(seek_error_, std::nullopt);
}

std::optional<FilmFeed::News> FilmFeed::takeNews() {
  const std::scoped_lock lock(mutex_);
  return news_.take();
}

}  // namespace relievo
