// SPDX-License-Identifier: Apache-2.0
// The reader's side of the feed: what its thread does, one step at a time.
#include <chrono>
#include <utility>

#include "app/media/film_feed.h"
#include "app/media/folder/film_folder.h"
#include "app/media/photo_list.h"
#include "app/media/subtitle_file.h"
#include "platform/files/file_system_answer.h"

namespace relievo {

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
  if (reader_side_.stopping || !hasWork()) return false;
  const State task = state_;
  const std::uint64_t generation = counts_.generation;
  counts_.at_work = counts_.film;
  interrupted_ = false;
  if (tracksDue()) {
    const bool chooses = std::exchange(request_.tracks_due, false);
    const bool words_due = std::exchange(request_.words_due, false);
    const auto format = std::exchange(request_.format_due, false) ? request_.options.sound : std::nullopt;
    const auto sound = request_.sound, words = request_.words;
    lock.unlock();
    if (format) reader_.setSoundFormat(*format);
    if (chooses) workChoose(sound, words, words_due);
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
    // Where pictures are late, sound must not wait for them.
    const bool pair = wantsPair(), sound = wantsSound();
    const bool sound_first = request_.leave_out && sound_.ahead() < kSoundAhead / 2;
    const bool leave_out = request_.leave_out;
    const auto until = std::exchange(request_.until, std::nullopt);
    lock.unlock();
    if (leave_out != left_out_ || until) reader_.leaveOut(leave_out, until);
    left_out_ = leave_out;
    const bool sounded = sound && workSound(!pair || sound_first, generation);
    if (pair && !sounded) workRead(generation);
  }
  lock.lock();
  counts_.at_work = 0;
  return true;
}

void FilmFeed::workOpen(const SourceOptions& options, std::uint64_t generation) {
  auto photos = photosIn(options, backends_.make_source);
  auto list = photos ? std::move(photos) : readList(options.url);
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
  left_out_ = false;
  takeWords(readWords());
  sound_.may_come = hasSound();
  state_ = State::Reading;
}

// The reader does not know the subtitle files that were added. Such a file is read once, when it is chosen.
void FilmFeed::workChoose(std::optional<std::size_t> sound, std::optional<std::size_t> words, bool words_due) {
  const bool is_added = words && *words >= reader_.info().subtitles.size();
  reader_.chooseTracks(sound, is_added ? std::nullopt : words);
  Result<std::deque<Subtitle>> read = readWords();
  const auto tracks = info().subtitles;
  if (is_added && words_due && *words < tracks.size()) read = readSubtitleFile(tracks[*words].path, backends_);
  const std::scoped_lock lock(mutex_);
  if (counts_.at_work != counts_.film) return;
  auto subtitles = std::move(info_.subtitles);
  info_ = reader_.info();
  info_.subtitles = std::move(subtitles);
  info_.words = read ? words : std::nullopt;
  sound_.forget();
  sound_.may_come = hasSound();
  if (info_.sound_refused != nullptr) news_.soundRefused(info_.sound_refused, now());
  if (read) takeWords(std::move(*read));
  else news_.wordsRefused(*words, read.error().message, now());
}

std::deque<Subtitle> FilmFeed::readWords() {
  std::deque<Subtitle> words;
  while (auto subtitle = reader_.nextSubtitle()) words.push_back(std::move(*subtitle));
  return words;
}

// Subtitles of a track that has been deselected meanwhile are dropped.
void FilmFeed::takeWords(std::deque<Subtitle> words) {
  if (changesWords()) return;
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
  if (pair && *pair) {
    std::unique_lock lock(mutex_);
    const int turn = request_.turn;  // it may have changed while a camera's picture was waited for
    lock.unlock();
    turnTo(**pair, turn);
  }
  if (hear_live_ && pair && *pair && (*pair)->taken) hear_live_(**pair);
  auto words = readWords();
  const PairCounters counters = reader_.counters();
  const auto depth_loss = reader_.depthLoss();
  const auto restart = reader_.takeRestart();
  const std::scoped_lock lock(mutex_);
  if (counts_.at_work != counts_.film) return;
  counters_ = counters;
  takeWords(std::move(words));
  if (restart) news_.restarted(*restart, now());
  news_.depth(depth_loss, now());
  if (!pair && loses(pair.error())) return;
  if (generation != counts_.generation) return;
  sound_.may_come = hasSound();
  if (!pair) return failed(reader_.failedThing(), pair.error());
  if (!*pair) {
    state_ = State::Ended;
    return;
  }
  queue_.push_back(std::move(**pair));
  turnTo(queue_.back(), request_.turn);  // another turn may have been asked for meanwhile
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
  if (!chunk || request_.format_due) return true;
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
  if (reopened) {
    state_ = loss_.before;
    sound_.may_come = hasSound();
    if (state_ == State::Reading && sound_.until())
      request_.target = *sound_.until();  // do not repeat sound that was delivered
    news_.colorBack(now());
  } else if (loss_.back_off.away(now()) >= kPatience) {
    failed(request_.options.url, loss_.error);
  } else {
    loss_.back_off.failed(now());
  }
}

// Enters Reconnecting if the source may come back; afterwards the previous state is resumed.
bool FilmFeed::loses(const Error& error) {
  if (backends_.clock == nullptr || !reader_.isSourceLost(error)) return false;
  loss_.error = error;
  loss_.before = std::exchange(state_, State::Reconnecting);
  loss_.back_off.begin(now());
  news_.colorLost(error, now());
  return true;
}

void FilmFeed::failed(std::string thing, const Error& error) {
  failure_ = {thing.empty() ? request_.options.url : std::move(thing), error};
  state_ = State::Failed;
}

MonotonicTime FilmFeed::now() const {
  return backends_.clock == nullptr ? MonotonicTime{} : backends_.clock->now();
}

void FilmFeed::threadMain() {
  const CancelsAnswers cancels(interrupted_);
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const auto wanted = [this] { return reader_side_.stopping || hasWork(); };
      if (state_ == State::Reconnecting) {
        wake_.wait_for(lock, loss_.back_off.next() - backends_.clock->now(), wanted);
      } else {
        rest_.begin(now());
        wake_.wait(lock, wanted);
        rest_.end(now());
      }
      if (reader_side_.stopping) break;
    }
    work();
  }
  const std::scoped_lock lock(mutex_);
  reader_side_.ended = true;
  wake_.notify_all();
}

}  // namespace relievo
