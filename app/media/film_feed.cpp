// SPDX-License-Identifier: Apache-2.0
// Both sides of the feed: requests and a queue under one mutex, which is never held while the film is read.
#include "app/media/film_feed.h"

#include <chrono>
#include <utility>

#include "app/media/film_folder.h"
#include "platform/files/file_system_answer.h"

namespace relievo {

FilmFeed::FilmFeed(PairReader::Backends backends, std::size_t capacity)
    : capacity_(capacity), backends_(std::move(backends)), reader_(backends_) {}

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
    // Repeated, because an interrupt that arrives just before the reader opens a source has no effect.
    while (thread_.joinable() && !thread_ended_) {
      lock.unlock();
      interrupted_ = true;
      reader_.interrupt();
      lock.lock();
      wake_.wait_for(lock, std::chrono::milliseconds(10), [this] { return thread_ended_; });
    }
    queue_.clear();
    sound_.forget();
    state_ = State::Closed;
  }
  if (thread_.joinable()) thread_.join();
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
  request_.tracks_due = false;
  request_.target = MediaTime{};
  films_.clear();
  seek_error_.reset();
  news_.clear();
  depth_away_ = false;
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
  words_.clear();
  wake_.notify_all();
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
  if (news_.empty()) return std::nullopt;
  const News news = news_.front();
  news_.pop_front();
  return news;
}

bool FilmFeed::hasWork() const {
  if (state_ == State::Reconnecting) return backends_.clock->now() >= loss_.back_off.next();
  return tracksDue() || state_ == State::Opening || state_ == State::Seeking ||
         (state_ == State::Closed && reader_open_) || wantsPair() || wantsSound();
}

bool FilmFeed::wantsSound() const {
  return sound_.may_come && sound_.ahead() < kSoundAhead && (state_ == State::Reading || state_ == State::Ended);
}

bool FilmFeed::work() {
  std::unique_lock lock(mutex_);
  if (stopping_ || !hasWork()) return false;
  const State task = state_;
  const std::uint64_t generation = counts_.generation;
  counts_.at_work = counts_.film;
  interrupted_ = false;
  if (tracksDue()) {
    request_.tracks_due = false;
    const auto sound = request_.sound, words = request_.words;
    lock.unlock();
    workChoose(sound, words);
  } else if (task == State::Opening) {
    const SourceOptions options = request_.options;
    lock.unlock();
    workOpen(options, generation);
  } else if (task == State::Seeking) {
    const MediaTime target = request_.target;
    const Duration key_step = request_.key_step;
    lock.unlock();
    workSeek(target, key_step, generation);
  } else if (task == State::Closed) {
    reader_open_ = false;
    lock.unlock();
    reader_.close();
  } else if (task == State::Reconnecting) {
    lock.unlock();
    workReopen();
  } else {
    const bool pair = wantsPair(), sound = wantsSound();
    lock.unlock();
    const bool sounded = sound && workSound(!pair, generation);
    if (pair && !sounded) workRead(generation);
  }
  lock.lock();
  counts_.at_work = 0;
  return true;
}

void FilmFeed::workOpen(const SourceOptions& options, std::uint64_t generation) {
  auto list = readList(options.url);
  const auto opened = list && !*list ? reader_.open(options) : Result<void>{};
  const std::scoped_lock lock(mutex_);
  reader_open_ = list && !*list && opened;
  if (generation != counts_.generation) return;  // closed or replaced meanwhile
  if (!list) return failed(list.error().thing, list.error().error);
  if (!opened) return failed(reader_.failedThing(), opened.error());
  if (*list) {
    films_ = std::move(**list);
    state_ = State::Listed;
    return;
  }
  info_ = reader_.info();
  takeWords(readWords());
  sound_.may_come = hasSound();
  state_ = State::Reading;
}

void FilmFeed::workChoose(std::optional<std::size_t> sound, std::optional<std::size_t> words) {
  reader_.chooseTracks(sound, words);
  auto read = readWords();
  const std::scoped_lock lock(mutex_);
  if (counts_.at_work != counts_.film) return;
  info_ = reader_.info();
  sound_.forget();
  sound_.may_come = hasSound();
  takeWords(std::move(read));
}

std::deque<Subtitle> FilmFeed::readWords() {
  std::deque<Subtitle> words;
  while (auto subtitle = reader_.nextSubtitle()) words.push_back(std::move(*subtitle));
  return words;
}

// Those of a track that has been given up meanwhile are dropped.
void FilmFeed::takeWords(std::deque<Subtitle> words) {
  if (request_.tracks_due) return;
  for (Subtitle& subtitle : words) words_.push_back(std::move(subtitle));
}

// Returns nullopt if the URL is not a playlist.
Outcome<std::optional<std::vector<PlaylistEntry>>> FilmFeed::readList(const std::string& url) {
  constexpr std::size_t kMostBytes = std::size_t{4} << 20;
  if (auto films = filmsIn(url)) return films;
  if (!backends_.read_text || !mayBePlaylist(url)) return std::nullopt;
  const auto text = backends_.read_text(url, kMostBytes, interrupted_);
  if (!text) return failOn(url, text.error());
  if (!isPlaylist(url, *text)) return std::nullopt;
  auto films = parsePlaylist(*text, url);
  if (!films) return std::unexpected(films.error());
  return std::move(*films);
}

void FilmFeed::workSeek(MediaTime target, Duration key_step, std::uint64_t generation) {
  const auto sought = reader_.seek(target, key_step);
  const std::scoped_lock lock(mutex_);
  if (generation != counts_.generation) return;  // a newer seek has replaced this one
  if (!sought && loses(sought.error())) return;
  if (!sought) {
    seek_error_ = sought.error();
    request_.target = MediaTime{};  // so that no sample is skipped
  }
  sound_.may_come = hasSound();
  state_ = State::Reading;
}

void FilmFeed::workRead(std::uint64_t generation) {
  auto pair = reader_.next();
  if (hear_live_ && pair && *pair && (*pair)->taken) hear_live_(**pair);
  auto words = readWords();
  const PairCounters counters = reader_.counters();
  const auto depth_loss = reader_.depthLoss();
  const auto restart = reader_.takeRestart();
  const std::scoped_lock lock(mutex_);
  if (counts_.at_work != counts_.film) return;
  counters_ = counters;
  takeWords(std::move(words));
  noteRestart(restart);
  noteDepth(depth_loss);
  if (!pair && loses(pair.error())) return;
  if (generation != counts_.generation) return;
  sound_.may_come = hasSound();
  if (!pair) return failed(reader_.failedThing(), pair.error());
  if (!*pair) {
    state_ = State::Ended;
    return;
  }
  queue_.push_back(std::move(**pair));
}

// Decodes sound that has already been read, and reads more if `may_read`. False when there was nothing to do.
bool FilmFeed::workSound(bool may_read, std::uint64_t generation) {
  auto chunk = reader_.nextSound();
  if (!chunk && !may_read) return false;
  const bool more = chunk || reader_.readAhead();
  auto words = readWords();
  const std::scoped_lock lock(mutex_);
  if (counts_.at_work == counts_.film) takeWords(std::move(words));
  if (generation != counts_.generation) return true;
  sound_.may_come = more;
  if (!chunk) return true;
  const AudioFormat& format = *request_.options.sound;  // always set here: without it no sound is decoded
  const MediaTime end = chunk->pts + SoundQueue::lengthOf(*chunk, format);
  if (end > request_.target) sound_.add(std::move(*chunk), format);  // else it lies before a seek's target
  return true;
}

void FilmFeed::workReopen() {
  const auto reopened = reader_.reopen();
  const PairCounters counters = reader_.counters();
  const std::scoped_lock lock(mutex_);
  if (counts_.at_work != counts_.film) return;
  counters_ = counters;
  const MonotonicTime now = backends_.clock->now();
  if (reopened) {
    state_ = loss_.before;
    sound_.may_come = hasSound();
    if (state_ == State::Reading && sound_.until())
      request_.target = *sound_.until();  // do not repeat sound that was delivered
    news_.push_back({News::Kind::ColorBack, "", "", now});
  } else if (loss_.back_off.away(now) >= kPatience) {
    failed(request_.options.url, loss_.error);
  } else {
    loss_.back_off.failed(now);
  }
}

// Enters Reconnecting if the source may come back; afterwards the previous state is resumed.
bool FilmFeed::loses(const Error& error) {
  if (backends_.clock == nullptr || !reader_.isSourceLost(error)) return false;
  loss_.error = error;
  loss_.before = std::exchange(state_, State::Reconnecting);
  loss_.back_off.begin(backends_.clock->now());
  news_.push_back({News::Kind::ColorLost, error.message, "", backends_.clock->now()});
  return true;
}

void FilmFeed::noteRestart(const std::optional<VideoDecoder::Restart>& restart) {
  if (!restart) return;
  const MonotonicTime now = backends_.clock == nullptr ? MonotonicTime{} : backends_.clock->now();
  news_.push_back({News::Kind::DecoderRestarted, restart->why, restart->done, now});
}

void FilmFeed::noteDepth(const std::optional<Error>& loss) {
  if (loss.has_value() == depth_away_) return;
  depth_away_ = loss.has_value();
  const auto kind = loss ? News::Kind::DepthLost : News::Kind::DepthBack;
  news_.push_back({kind, loss ? loss->message : "", "", backends_.clock->now()});
}

void FilmFeed::failed(std::string thing, const Error& error) {
  failure_ = {thing.empty() ? request_.options.url : std::move(thing), error};
  state_ = State::Failed;
}

void FilmFeed::threadMain() {
  const CancelsAnswers cancels(interrupted_);
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const auto wanted = [this] { return stopping_ || hasWork(); };
      if (state_ == State::Reconnecting) {
        wake_.wait_for(lock, loss_.back_off.next() - backends_.clock->now(), wanted);
      } else {
        wake_.wait(lock, wanted);
      }
      if (stopping_) break;
    }
    work();
  }
  const std::scoped_lock lock(mutex_);
  thread_ended_ = true;
  wake_.notify_all();
}

}  // namespace relievo
