// SPDX-License-Identifier: Apache-2.0
// Reads a film ahead of the player: bounded queues of frame pairs and sound, filled by the feed's own thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/media/back_off.h"
#include "app/media/feed_news.h"
#include "app/media/pair_reader.h"
#include "app/media/playlist.h"
#include "app/media/rest_time.h"
#include "app/media/tracks/sound_queue.h"
#include "hal/media/media_time.h"
#include "platform/failure.h"

namespace relievo {

// The player's side (every function except `work`) never waits for the film: it makes a request and polls `state`. The
// reader's side is `work`, which a thread calls after `startThread`. Without that thread the caller calls `work`, so
// that a test can run in simulated time.
//
// States: Closed -open-> Opening -> Reading -> Ended; Reading or Ended -seek-> Seeking -> Reading; Reading or Seeking
// -> Reconnecting when a network source is lost -> the previous state; any except Closed -> Failed; any -open->
// Opening; any -close-> Closed. A source that turns out to be a playlist goes from Opening to Listed. Pairs and sound
// read before an end, a loss or a failure can still be taken.
//
// Sound is decoded while less than kSoundAhead of it is queued. Pairs take priority when data has to be read from the
// source.
class FilmFeed {
 public:
  static constexpr Duration kSoundAhead = std::chrono::milliseconds(500);
  enum class State : std::uint8_t { Closed, Opening, Seeking, Reading, Ended, Failed, Listed, Reconnecting };
  // How long a lost colour source is retried, at the intervals of BackOff, before the film fails. A lost depth source
  // is retried for as long as the film plays.
  static constexpr Duration kPatience = std::chrono::seconds(30);
  using News = FeedNews::Item;

  // Without Backends::clock a lost source fails at once.
  FilmFeed(PairReader::Backends backends, std::size_t capacity);
  ~FilmFeed();
  FilmFeed(const FilmFeed&) = delete;
  FilmFeed& operator=(const FilmFeed&) = delete;

  // Sets a callback for the depth of a live film, called on the reader's side as soon as it has been read. Call before
  // `startThread`.
  void hearLive(std::function<void(const FramePair&)> hear) { hear_live_ = std::move(hear); }
  void startThread();
  // Interrupts any blocking read, ends the thread and closes the film. A second call does nothing.
  void stop() noexcept;

  // Abandons whatever is open or being opened.
  void open(SourceOptions options);
  void close();
  // Discards what was read ahead. What is taken after the state has left Seeking begins as PairReader::seek says. A
  // newer target replaces one that has not been reached. Valid in Reading, Ended, Seeking and Reconnecting (where it
  // takes effect once the source is back); ignored in other states. `key_step` as in PairReader::seek.
  void seek(MediaTime target, Duration key_step = Duration(0));
  [[nodiscard]] State state() const;
  // Like PairReader::leaveOut, before the next pair is read. Sound is then read ahead of late pictures.
  void leaveOut(bool unreferenced, std::optional<MediaTime> until = {});
  // Turns all pairs from now on, those that are queued too, by so many quarters in all (turnTo); until `open`.
  void turn(int turn);
  // How busy the reader is.
  struct Effort {
    Duration rested{0};    // total time in which its thread had nothing to do; 0 without Backends::clock
    bool decodes = false;  // it is working now, not waiting for the source
  };
  [[nodiscard]] Effort effort() const;
  // The next pair in order; nullopt if none is ready.
  [[nodiscard]] std::optional<FramePair> take();
  // The depth of those that `take` would return next, into `depths`; returns how many there are. They stay queued.
  [[nodiscard]] std::size_t peekDepths(std::span<Frame> depths) const;
  // The next samples in order; nullopt if none are ready.
  [[nodiscard]] std::optional<AudioChunk> takeSound();
  // The next subtitle that has been read; nullopt if there is none. After a seek some subtitles may be repeated.
  [[nodiscard]] std::optional<Subtitle> takeSubtitle();
  // Chooses other tracks, by their places in FilmInfo. Seek afterwards, since what was read of them before is skipped.
  // Subtitles that are refused are not chosen any more: FilmInfo::words.
  void chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words);
  // From here on the sound is decoded to another format. What was read ahead is dropped.
  void setSoundFormat(const AudioFormat& format);
  // Adds a subtitle file behind those of `info`, until the film is closed; choose it afterwards. From Reading on.
  void addSubtitles(FilmTrack file);
  // True if no more sound before `time` will come: it is queued, or the container stores it too far ahead to be read.
  [[nodiscard]] bool hasSoundUntil(MediaTime time) const;

  // The films of the playlist, in state Listed.
  [[nodiscard]] std::vector<PlaylistEntry> films() const;
  // Valid from Reading on.
  [[nodiscard]] FilmInfo info() const;
  [[nodiscard]] PairCounters counters() const;
  // The error that led to Failed, and the source that failed.
  [[nodiscard]] Failure failure() const;
  // A seek that the source refused, reported once; playback then continues from the source's position.
  [[nodiscard]] std::optional<Error> takeSeekError();

  // The events in order, each reported once.
  [[nodiscard]] std::optional<News> takeNews();

  // One step of the reader: opens, seeks, reads one pair or some sound, or retries a lost source. False when there is
  // nothing to do.
  bool work();

 private:
  [[nodiscard]] bool hasWork() const;
  [[nodiscard]] bool tracksDue() const {
    return (request_.tracks_due || request_.format_due) &&
           (state_ == State::Reading || state_ == State::Ended || state_ == State::Seeking);
  }
  [[nodiscard]] bool wantsPair() const { return state_ == State::Reading && queue_.size() < capacity_; }
  [[nodiscard]] bool wantsSound() const;
  [[nodiscard]] bool hasSound() const { return !info_.sound_codec.empty() && info_.sound_refused == nullptr; }
  void workOpen(const SourceOptions& options, std::uint64_t generation);
  [[nodiscard]] Outcome<std::optional<std::vector<PlaylistEntry>>> readList(const std::string& url);
  void workSeek(MediaTime target, Duration key_step, std::uint64_t generation);
  void workRead(std::uint64_t generation);
  void workReopen();
  void workChoose(std::optional<std::size_t> sound, std::optional<std::size_t> words, bool words_due);
  [[nodiscard]] bool changesWords() const { return request_.tracks_due && request_.words != info_.words; }
  void takeWords(std::deque<Subtitle> words);
  [[nodiscard]] std::deque<Subtitle> readWords();
  [[nodiscard]] bool loses(const Error& error);
  bool workSound(bool may_read, std::uint64_t generation);
  void failed(std::string thing, const Error& error);
  void begin(State state);
  void interruptStale() const;
  [[nodiscard]] MonotonicTime now() const;
  void threadMain();

  const std::size_t capacity_;
  const PairReader::Backends backends_;
  std::function<void(const FramePair&)> hear_live_;
  mutable std::atomic<bool> interrupted_{false};  // stops the reading of a playlist
  mutable PairReader reader_;                     // its calls for one thread are the reader's side's
  bool left_out_ = false;                         // likewise: the last argument of the reader's leaveOut

  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable wake_;
  State state_ = State::Closed;
  struct Request {
    SourceOptions options;
    MediaTime target;
    Duration key_step{0};
    bool tracks_due = false, format_due = false;
    bool words_due = false;  // those of before are gone, also where the same track is chosen again
    std::optional<std::size_t> sound, words;
    bool leave_out = false;
    std::optional<MediaTime> until;  // once
    int turn = 0;
  };
  Request request_;  // what was asked for last
  struct Counts {
    std::uint64_t generation = 0;  // films and seeks; data read under an older generation is dropped
    std::uint64_t film = 0;        // films
    std::uint64_t at_work = 0;     // the film the reader is working on; 0: idle
  };
  Counts counts_;
  bool reader_open_ = false;
  std::vector<PlaylistEntry> films_;
  std::deque<FramePair> queue_;
  SoundQueue sound_;
  std::deque<Subtitle> words_;
  FilmInfo info_;
  PairCounters counters_;
  Failure failure_;  // valid in Failed
  std::optional<Error> seek_error_;
  struct Loss {
    Error error;
    State before = State::Reading;  // the state to resume
    BackOff back_off;
  };
  Loss loss_;  // valid in Reconnecting
  FeedNews news_;
  RestTime rest_;
  struct Reader {
    std::thread thread;
    bool stopping = false, ended = false;
  };
  Reader reader_side_;
};

}  // namespace relievo
