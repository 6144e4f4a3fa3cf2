// SPDX-License-Identifier: Apache-2.0
// Reads a film ahead of the player: bounded queues of pairs and of sound, filled by a thread of its own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/media/back_off.h"
#include "app/media/pair_reader.h"
#include "app/media/playlist.h"
#include "hal/media_time.h"
#include "platform/failure.h"

namespace relievo {

// The player's side (all verbs but `work`) never waits for the film: it asks, and looks at `state`. The reader's side
// is `work`: a thread does it after `startThread`; without, the caller does, so that a test runs in simulated time.
//
// States: Closed -open-> Opening -> Reading -> Ended; Reading or Ended -seek-> Seeking -> Reading; Reading or Seeking,
// when a source on the network is lost -> Reconnecting -> what it was; any but Closed -> Failed; any -open-> Opening;
// any -close-> Closed. A source that turns out to be a list of films goes from Opening to Listed. Pairs and sound that
// were read before an end, a loss or a failure can still be taken.
//
// Sound is decoded as long as less than kSoundAhead of it lies in the queue. Pairs go first where something has to be
// read from the source.
class FilmFeed {
 public:
  static constexpr Duration kSoundAhead = std::chrono::milliseconds(500);
  enum class State : std::uint8_t { Closed, Opening, Seeking, Reading, Ended, Failed, Listed, Reconnecting };
  // A lost colour is looked for so long, at the intervals of BackOff; then the film has failed. The depth is looked for
  // as long as the film lasts.
  static constexpr Duration kPatience = std::chrono::seconds(30);
  // What has happened to a source, or to a decoder.
  struct News {
    enum class Kind : std::uint8_t { ColorLost, ColorBack, DepthLost, DepthBack, DecoderRestarted };
    Kind kind;
    const char* why = "";   // of a loss or a restart
    const char* done = "";  // of a restart
    MonotonicTime time;
  };

  // Without a clock among the back ends what is lost has failed.
  FilmFeed(PairReader::Backends backends, std::size_t capacity);
  ~FilmFeed();
  FilmFeed(const FilmFeed&) = delete;
  FilmFeed& operator=(const FilmFeed&) = delete;

  void startThread();
  // Interrupts what the reader waits for, ends the thread and closes the film. Does nothing the second time.
  void stop() noexcept;

  // What was open, or under way, is given up for it.
  void open(SourceOptions options);
  void close();
  // Forgets what was read ahead. What is taken once the state has left Seeking lies at or after `target`. A newer
  // target replaces one that is not reached yet. Reading, Ended, Seeking or Reconnecting (it is sought once it is found
  // again), else nothing happens. `key_step` as in PairReader::seek.
  void seek(MediaTime target, Duration key_step = Duration(0));
  [[nodiscard]] State state() const;
  // The next pair in order; nothing while there is none.
  [[nodiscard]] std::optional<FramePair> take();
  // The next samples in order; nothing while there are none.
  [[nodiscard]] std::optional<AudioChunk> takeSound();
  // True when no sound before `time` will come that has not come yet, as far as the film's interleaving tells: it is
  // there, or the reader would have to go too far for it.
  [[nodiscard]] bool hasSoundUntil(MediaTime time) const;

  // Listed: the films.
  [[nodiscard]] std::vector<PlaylistEntry> films() const;
  // From Reading on.
  [[nodiscard]] FilmInfo info() const;
  [[nodiscard]] PairCounters counters() const;
  // Of the failure; and the source that failed.
  [[nodiscard]] Error error() const;
  [[nodiscard]] std::string failedThing() const;
  // The seek that the source refused, once; the film then goes on from where the source stands.
  [[nodiscard]] std::optional<Error> takeSeekError();

  // In order, each once.
  [[nodiscard]] std::optional<News> takeNews();

  // One piece of the reader's work: opens, seeks, reads one pair or some sound, or tries a lost source again. False
  // when there is nothing to do now.
  bool work();

 private:
  [[nodiscard]] bool hasWork() const;
  [[nodiscard]] bool wantsPair() const { return state_ == State::Reading && queue_.size() < capacity_; }
  [[nodiscard]] bool wantsSound() const;
  [[nodiscard]] bool hasSound() const { return !info_.sound_codec.empty() && info_.sound_refused == nullptr; }
  [[nodiscard]] Duration lengthOf(const AudioChunk& chunk) const;
  void forgetSound();
  void workOpen(const SourceOptions& options, std::uint64_t generation);
  [[nodiscard]] Outcome<std::optional<std::vector<PlaylistEntry>>> readList(const std::string& url);
  void workSeek(MediaTime target, Duration key_step, std::uint64_t generation);
  void workRead(std::uint64_t generation);
  void workReopen();
  [[nodiscard]] bool loses(const Error& error);
  void noteRestart(const std::optional<VideoDecoder::Restart>& restart);
  void noteDepth(const std::optional<Error>& loss);
  bool workSound(bool may_read, std::uint64_t generation);
  void failed(std::string thing, const Error& error);
  void begin(State state);
  void interruptStale() const;
  void threadMain();

  const std::size_t capacity_;
  const PairReader::Backends backends_;
  mutable std::atomic<bool> interrupted_{false};  // while a list is read
  mutable PairReader reader_;                     // the reader's side only, but for `interrupt`

  mutable std::mutex mutex_;  // guards all below
  std::condition_variable wake_;
  State state_ = State::Closed;
  SourceOptions options_;
  MediaTime target_;
  Duration key_step_{0};
  std::uint64_t generation_ = 0;  // of films and seeks: what was read under an older one is dropped
  std::uint64_t film_ = 0;        // counts films
  std::uint64_t at_work_ = 0;     // the film that the reader is busy with; 0: it is idle
  bool reader_open_ = false;
  std::vector<PlaylistEntry> films_;
  std::deque<FramePair> queue_;
  std::deque<AudioChunk> sound_;
  Duration sound_ahead_{0};               // all that is in it
  std::optional<MediaTime> sound_until_;  // the end of the newest
  bool sound_may_come_ = false;
  FilmInfo info_;
  PairCounters counters_;
  Error error_;
  std::string failed_thing_;
  std::optional<Error> seek_error_;
  BackOff back_off_;
  Error loss_;                           // while Reconnecting
  State state_before_ = State::Reading;  // and after it
  bool depth_away_ = false;
  std::deque<News> news_;
  bool stopping_ = false;
  bool thread_ended_ = false;

  std::thread thread_;
};

}  // namespace relievo
