// SPDX-License-Identifier: Apache-2.0
// Depth from a separate source, which may be lost and reopened while the colour keeps playing.
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
#include "app/media/tracks/track_reader.h"

namespace relievo {

// A file is read on the caller's thread. A network stream or a camera is read ahead by a thread of its own
// (Backends::own_threads). `next` waits a quarter of a second for it, longer after an opening or a seek, and then
// reports no depth until a picture arrives. A lost source is reopened, with back-off, for as long as the colour plays;
// without a clock (Backends::clock) it stays lost.
//
// Use from one thread, except `interrupt`, which any thread may call.
class DepthSource {
 public:
  // From one opening of the source to the next. The timestamps of a live source start anew with each session.
  struct Session {
    std::uint32_t number = 0;
    bool live = false;
    MonotonicTime arrival;                 // MediaSource::arrival
    std::optional<Duration> sender_start;  // MediaSource::senderStart
    std::optional<Duration> named_start;   // MediaSource::namedStart
    Duration duration{0};                  // MediaSource::duration
  };
  struct Given {
    Frame frame;  // with the session's own timestamp; empty: none
    Session session;
    bool ended = false;  // if there is no frame: the source has ended; only a seek brings more
    bool away = false;   // if there is no frame: the source is late or lost
  };

  // `backends` must outlive it. The rate applies to pictures without timestamps.
  DepthSource(const PairReader::Backends& backends, std::optional<double> frames_per_s)
      : backends_(backends), frames_per_s_(frames_per_s) {}
  ~DepthSource();
  DepthSource(const DepthSource&) = delete;
  DepthSource& operator=(const DepthSource&) = delete;

  // Call once. NotFound if the source has no video track.
  [[nodiscard]] Result<void> open(const std::string& url);
  // Valid after `open`.
  [[nodiscard]] const StreamInfo& stream() const noexcept { return facts_.stream; }
  [[nodiscard]] const std::map<std::string, std::string>& tags() const noexcept { return facts_.tags; }
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return facts_.notes; }

  // The next picture in order. An error means that the source will not be retried.
  [[nodiscard]] Result<Given> next();
  // As TrackReader::seek. If a thread reads the source, or the source is lost, the seek is carried out later: this call
  // does not wait.
  [[nodiscard]] Result<void> seek(MediaTime target, Duration key_step);
  void interrupt() noexcept;

  // Why the source is lost, while it is being retried.
  [[nodiscard]] std::optional<Error> loss() const;
  struct Counters {
    std::uint64_t damaged = 0, deinterlaced = 0, jumps = 0, missed_pictures = 0, reconnects = 0;
    Duration missing{0};
  };
  [[nodiscard]] Counters counters() const;
  // A restart of its decoder, reported once.
  [[nodiscard]] std::optional<VideoDecoder::Restart> takeRestart() noexcept;
  [[nodiscard]] const std::string& decoder() const noexcept { return facts_.decoder; }

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
  struct Facts {
    StreamInfo stream;
    std::string decoder;
    std::map<std::string, std::string> tags;
    std::vector<std::string> notes;
  };
  Facts facts_;           // from `open` on
  bool reopens_ = false;  // a lost source

  // Used only by the side that reads: the thread if there is one.
  std::size_t track_ = 0;
  Counters before_;  // sum over the earlier sessions
  BackOff back_off_;

  mutable std::mutex mutex_;  // guards everything below; not held while the source is read
  std::condition_variable wake_, ready_;
  std::unique_ptr<TrackReader> reader_;  // changed only by the side that reads
  Session session_;
  std::deque<Given> queue_;
  struct Seek {
    std::uint64_t number = 0;         // of the last one
    std::optional<MediaTime> target;  // while it is pending
    Duration key_step{0};
  };
  Seek seek_;
  MediaTime goes_on_at_;  // where a seekable source resumes after a loss
  std::optional<VideoDecoder::Restart> restart_;
  std::optional<Error> loss_;
  Counters counters_;
  bool ended_ = false;
  bool warming_up_ = true;  // no picture yet since the opening or the seek
  bool late_ = false;       // the last wait for a picture timed out
  bool interrupted_ = false;
  bool thread_ended_ = false;
  std::thread thread_;
};

}  // namespace relievo
