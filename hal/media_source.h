// SPDX-License-Identifier: Apache-2.0
// Interface of a media source: opens a file or a URL and hands out its coded packets.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/continuous_time.h"
#include "hal/frame.h"
#include "hal/media_time.h"
#include "platform/error.h"

namespace relievo {

enum class StreamKind : std::uint8_t { Video, Audio, Subtitle, Other };

// Names one stream and describes it as far as the container does.
struct StreamInfo {
  int index = 0;  // the `stream` of its packets
  StreamKind kind = StreamKind::Other;
  std::string codec;                    // "h264", "hevc", "vp8", .., lower case
  std::vector<std::uint8_t> extradata;  // parameter sets as the container holds them
  int width = 0;
  int height = 0;
  ColorRange range = ColorRange::Unspecified;
  ColorMatrix matrix = ColorMatrix::Unspecified;
  double sample_aspect = 1.0;  // width of a sample over its height
  int rotation = 0;            // quarter turns clockwise, 0 to 3, that make its pictures upright
  int sample_rate_hz = 0;      // of sound
  int channels = 0;
  Duration frame_period{0};                 // a hint from the container; the true one comes from the timestamps
  Duration duration{0};                     // 0 where unknown
  std::map<std::string, std::string> tags;  // upper-case keys: TITLE, HANDLER_NAME, DEPTH_NEAR, ..
  bool auxiliary = false;                   // signalled as depth or parallax (ISO/IEC 23002-3), whatever the tags say
  // The source's own description, for a decoder of the same library; null otherwise.
  std::shared_ptr<const void> native;
};

// Coded data by reference; valid as long as any copy of `owner` lives.
struct Packet {
  int stream = 0;
  const std::uint8_t* data = nullptr;
  std::size_t bytes = 0;
  std::optional<MediaTime> pts;
  std::optional<MediaTime> dts;
  bool keyframe = false;
  std::shared_ptr<const void> owner;
};

// States: Closed -open-> Open -read to the end-> Ended -seek-> Open; any -close-> Closed. A verb in a state that does
// not allow it returns InvalidState and changes nothing.
//
// Thread: all verbs on one thread, but `interrupt`, which any thread may call. Blocking: `open`, `read` and `seek` may
// wait for a disk or a network, at most for the back end's time-out; `interrupt` makes them return Cancelled.
// Times: packets' times are media times, beginning near zero (the container's start time is taken away). Where a
// container's times may jump, as in broadcasts, they go on nevertheless (ContinuousTime); a seek is by the container's.
class MediaSource {
 public:
  enum class State : std::uint8_t { Closed, Open, Ended };
  virtual ~MediaSource() = default;

  // NotFound, PermissionDenied, Unsupported (protocol), Corrupt (not media), Timeout, Cancelled. Closed only.
  [[nodiscard]] Result<void> open(const std::string& url);
  // The next packet of any stream, in the order of the container; nothing at the end. A file that is cut off in the
  // middle ends like a whole one (see `missing`). Lost or Timeout when the source has gone away: a `remote` one may be
  // back after `close` and `open`, a live one then with times from zero. Open or Ended (nothing again).
  [[nodiscard]] Result<std::optional<Packet>> read();
  // To the last key frame at or before `target`; decoders must be flushed by the caller. Open or Ended.
  [[nodiscard]] Result<void> seek(MediaTime target);
  void close() noexcept;

  // Makes a blocked verb return Cancelled, and those to come until the next `open`. Any thread, any state.
  void interrupt() noexcept { interrupted(); }

  [[nodiscard]] State state() const noexcept { return state_; }
  // Empty while Closed. Does not change while Open.
  [[nodiscard]] const std::vector<StreamInfo>& streams() const noexcept { return streams_; }
  // Container tags, upper-case keys. Empty while Closed.
  [[nodiscard]] const std::map<std::string, std::string>& tags() const noexcept { return tags_; }
  // Of the whole film; 0 where unknown (live).
  [[nodiscard]] Duration duration() const noexcept { return duration_; }
  // It comes over a network or from a camera: it may go away and come back.
  [[nodiscard]] bool remote() const noexcept { return origin_.remote; }
  // It cannot be had again: no beginning, no end, no seeking.
  [[nodiscard]] bool live() const noexcept { return remote() && duration_ == Duration(0); }
  // Where its time 0 is on two other clocks, to bring two live sources together: the machine's, at its arrival (of a
  // camera: when the picture was taken), and the sender's own, which is nothing where the container does not tell.
  [[nodiscard]] MonotonicTime arrival() const noexcept { return origin_.arrival; }
  [[nodiscard]] std::optional<Duration> senderStart() const noexcept { return origin_.sender_start; }
  // How often its times have jumped, since construction.
  [[nodiscard]] std::uint64_t jumps() const noexcept { return times_.jumps(); }
  // Pictures that were taken and never came here, as far as the source can tell (a camera counts them), since
  // construction.
  [[nodiscard]] std::uint64_t missedPictures() const noexcept { return missed_; }
  // How much of the duration was not there: the film broke off so long before its end. Ended; 0 of a whole film, where
  // it is unknown, and in the other states.
  [[nodiscard]] Duration missing() const noexcept { return state_ == State::Ended ? missingTime() : Duration(0); }

 protected:
  struct Origin {
    bool remote = false;
    Duration longest_gap{0};  // see ContinuousTime
    MonotonicTime arrival;
    std::optional<Duration> sender_start;
  };
  struct Description {
    std::vector<StreamInfo> streams;
    std::map<std::string, std::string> tags;
    Duration duration{0};
    Origin origin;
  };
  void countMissed(std::uint64_t pictures) noexcept { missed_ += pictures; }

 private:
  virtual Result<Description> openSource(const std::string& url) = 0;
  virtual Result<std::optional<Packet>> readPacket() = 0;
  virtual Result<void> seekTo(MediaTime target) = 0;
  [[nodiscard]] virtual Duration missingTime() const noexcept { return Duration(0); }
  virtual void closeSource() noexcept = 0;
  virtual void interrupted() noexcept = 0;
  void retime(Packet& packet);

  State state_ = State::Closed;
  std::vector<StreamInfo> streams_;
  std::map<std::string, std::string> tags_;
  Duration duration_{0};
  Origin origin_;
  ContinuousTime times_;
  std::uint64_t missed_ = 0;
};

}  // namespace relievo
