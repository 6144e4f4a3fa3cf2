// SPDX-License-Identifier: Apache-2.0
// The depth pictures of a source of their own, which may go away and come back without the colour's waiting for it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/media/back_off.h"
#include "app/media/pair_reader.h"
#include "app/media/track_reader.h"

namespace relievo {

// A file is read by who asks. What comes over a network or from a camera is read ahead by a thread
// (Backends::own_threads), and is waited for a quarter of a second, longer after an opening or a seek; then there is no
// depth until it is there again. When it is lost it is opened again, with back-off and for as long as the colour plays
// (Backends::clock, else it stays lost).
//
// One thread, but `interrupt`, which any thread may call.
class DepthSource {
 public:
  // From one opening to the next. The times of a live source begin anew with each.
  struct Session {
    std::uint32_t number = 0;
    bool live = false;
    MonotonicTime arrival;                 // MediaSource::arrival
    std::optional<Duration> sender_start;  // MediaSource::senderStart
  };
  struct Given {
    Frame frame;  // at the session's own time; empty: none
    Session session;
    bool ended = false;  // without a frame: no more will come, unless after a seek
    bool away = false;   // without a frame: it is late or lost
  };

  // `backends` must outlive it. The rate is of pictures without times.
  DepthSource(const PairReader::Backends& backends, std::optional<double> frames_per_s)
      : backends_(backends), frames_per_s_(frames_per_s) {}
  ~DepthSource();
  DepthSource(const DepthSource&) = delete;
  DepthSource& operator=(const DepthSource&) = delete;

  // Once. NotFound without a video track.
  [[nodiscard]] Result<void> open(const std::string& url);
  // From `open` on.
  [[nodiscard]] const StreamInfo& stream() const noexcept { return stream_; }
  [[nodiscard]] const std::map<std::string, std::string>& tags() const noexcept { return tags_; }

  // The next picture in order. Fails only where the source is not tried again.
  [[nodiscard]] Result<Given> next();
  // As TrackReader does. Of what is read by a thread, or lost, it is begun and not waited for.
  [[nodiscard]] Result<void> seek(MediaTime target, Duration key_step);
  void interrupt() noexcept;

  // Why it is away, while it is looked for.
  [[nodiscard]] std::optional<Error> loss() const;
  struct Counters {
    std::uint64_t damaged = 0, jumps = 0, missed_pictures = 0, reconnects = 0;
    Duration missing{0};
  };
  [[nodiscard]] Counters counters() const;
  // Of its decoder.
  [[nodiscard]] std::optional<VideoDecoder::Restart> takeRestart() noexcept;
  [[nodiscard]] const std::string& decoder() const noexcept { return decoder_; }

 private:
  [[nodiscard]] Result<void> connect();
  [[nodiscard]] Result<Given> nextHere();
  void threadMain();
  void work(std::unique_lock<std::mutex>& lock);
  void readOne(std::unique_lock<std::mutex>& lock);
  void findAgain(std::unique_lock<std::mutex>& lock);
  void lose(const Error& error);
  void count();

  const PairReader::Backends& backends_;
  const std::optional<double> frames_per_s_;
  std::string url_;
  StreamInfo stream_;
  std::string decoder_;
  std::map<std::string, std::string> tags_;
  bool tried_again_ = false;  // when lost

  // The reading side's: the thread's, where there is one.
  std::size_t track_ = 0;
  Counters before_;  // of the sessions before
  BackOff back_off_;

  mutable std::mutex mutex_;  // guards all below; not held while the source is read
  std::condition_variable wake_, ready_;
  std::unique_ptr<TrackReader> reader_;  // changed by the reading side alone
  Session session_;
  std::deque<Given> queue_;
  std::optional<MediaTime> target_;  // of a seek
  MediaTime goes_on_at_;             // where one that can be sought goes on when it is found again
  Duration key_step_{0};             // of the last one
  std::uint64_t generation_ = 0;     // of seeks
  std::optional<VideoDecoder::Restart> restart_;
  std::optional<Error> loss_;
  Counters counters_;
  bool ended_ = false;
  bool warming_up_ = true;  // nothing has come since it was opened or sought
  bool late_ = false;       // it was waited for in vain
  bool interrupted_ = false;
  bool thread_ended_ = false;
  std::thread thread_;
};

}  // namespace relievo
