// SPDX-License-Identifier: Apache-2.0
// Reads a film ahead of the player: a bounded queue of pairs, filled by a thread of its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/media/pair_reader.h"
#include "hal/media_time.h"

namespace relievo {

// The player's side (all verbs but `work`) never waits for the film: it asks, and looks at `state`. The reader's side
// is `work`: a thread does it after `startThread`; without, the caller does, so that a test runs in simulated time.
//
// States: Closed -open-> Opening -> Reading -> Ended; Reading or Ended -seek-> Seeking -> Reading; any but Closed ->
// Failed. Pairs that were read before an end or a failure can still be taken.
class FilmFeed {
 public:
  enum class State : std::uint8_t { Closed, Opening, Seeking, Reading, Ended, Failed };

  FilmFeed(PairReader::Backends backends, std::size_t capacity);
  ~FilmFeed();
  FilmFeed(const FilmFeed&) = delete;
  FilmFeed& operator=(const FilmFeed&) = delete;

  void startThread();
  // Interrupts what the reader waits for, ends the thread and closes the film. Does nothing the second time.
  void stop() noexcept;

  void open(SourceOptions options);  // Closed only
  // Forgets what was read ahead. What is taken once the state has left Seeking lies at or after `target`. A newer
  // target replaces one that is not reached yet. Reading, Ended or Seeking, else nothing happens.
  void seek(MediaTime target);
  [[nodiscard]] State state() const;
  // The next pair in order; nothing while there is none.
  [[nodiscard]] std::optional<FramePair> take();

  // From Reading on.
  [[nodiscard]] FilmInfo info() const;
  [[nodiscard]] PairCounters counters() const;
  // Of the failure; and the source that failed.
  [[nodiscard]] Error error() const;
  [[nodiscard]] std::string failedThing() const;
  // The seek that the source refused, once; the film then goes on from where the source stands.
  [[nodiscard]] std::optional<Error> takeSeekError();

  // One piece of the reader's work: opens, seeks or reads one pair. False when there is nothing to do.
  bool work();

 private:
  [[nodiscard]] bool hasWork() const;
  void workOpen(const SourceOptions& options);
  void workSeek(MediaTime target, std::uint64_t generation);
  void workRead(std::uint64_t generation);
  void failed(const Error& error);
  void threadMain();

  const std::size_t capacity_;
  PairReader reader_;  // the reader's side only, but for `interrupt`

  mutable std::mutex mutex_;  // guards all below
  std::condition_variable wake_;
  State state_ = State::Closed;
  SourceOptions options_;
  MediaTime target_;
  std::uint64_t generation_ = 0;  // of seeks: what was read under an older one is dropped
  std::deque<FramePair> queue_;
  FilmInfo info_;
  PairCounters counters_;
  Error error_;
  std::string failed_thing_;
  std::optional<Error> seek_error_;
  bool stopping_ = false;
  bool thread_ended_ = false;

  std::thread thread_;
};

}  // namespace relievo
