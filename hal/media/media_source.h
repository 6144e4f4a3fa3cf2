// SPDX-License-Identifier: Apache-2.0
// Interface of a media source: opens a file or a URL and returns its coded packets.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/media/continuous_time.h"
#include "hal/media/frame.h"
#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo {

enum class StreamKind : std::uint8_t { Video, Audio, Subtitle, Other };

// num / den; unknown if `num` is 0.
struct Ratio {
  int num = 0, den = 1;
  [[nodiscard]] bool known() const noexcept { return num > 0 && den > 0; }
  friend bool operator==(const Ratio&, const Ratio&) = default;
};

// Of interlaced video: the field that is coded first, then the one that is shown first.
enum class FieldOrder : std::uint8_t { Unknown, Progressive, TopTop, BottomBottom, TopBottom, BottomTop };

// One stream, described as far as the container does.
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
  int rotation = 0;            // clockwise quarter turns, 0 to 3, that make its pictures upright
  std::string pixel_format;    // FFmpeg's name: "yuv420p", "gray16le", ..; rows of codec "rawvideo" have no padding
  int bits = 0;                // of a sample
  std::uint8_t primaries = kUnspecifiedColor, transfer = kUnspecifiedColor;  // as in a Frame
  FieldOrder fields = FieldOrder::Unknown;
  Ratio average_rate;      // frames per second over the whole stream
  Ratio base_rate;         // the lowest rate whose period divides every step of the timestamps, as far as it was read
  int sample_rate_hz = 0;  // of sound
  int channels = 0;
  std::string channel_layout;               // "stereo", "5.1", ..
  bool counted = false;                     // no times of its own: its pictures are counted, or there is only one
  Duration frame_period{0};                 // the container's hint; the true one comes from the timestamps
  Duration duration{0};                     // 0 if unknown
  std::map<std::string, std::string> tags;  // upper-case keys: TITLE, HANDLER_NAME, DEPTH_NEAR, ..
  bool by_default = false, forced = false;  // of sound and subtitles: the film's own marks
  bool auxiliary = false;                   // signalled as depth or parallax (ISO/IEC 23002-3), besides the tags
  // The source's own description, for a decoder of the same library; null otherwise.
  std::shared_ptr<const void> native;
};

// Whether the container says that the stream has an alpha channel (WebM).
[[nodiscard]] inline bool saysAlpha(const StreamInfo& stream) {
  const auto mode = stream.tags.find("ALPHA_MODE");
  return mode != stream.tags.end() && mode->second == "1";
}

struct Chapter {
  Duration begin{0}, end{0};  // media times
  std::string title;
};

// A reference to coded data; valid as long as any copy of `owner` lives.
struct Packet {
  int stream = 0;
  const std::uint8_t* data = nullptr;
  std::size_t bytes = 0;
  std::optional<MediaTime> pts;
  std::optional<MediaTime> dts;
  bool keyframe = false;
  std::shared_ptr<const void> owner;
};

// States: Closed -open-> Open -read to the end-> Ended -seek-> Open; any -close-> Closed. A call in a state that does
// not allow it returns InvalidState and changes nothing.
//
// Thread: all calls on one thread, except `interrupt`, which any thread may call. Blocking: `open`, `read` and `seek`
// may wait for a disk or a network, at most for the back end's time-out; `interrupt` makes them return Cancelled.
// Times: packets have media times that begin near zero (the container's start time is subtracted). Where a container's
// times may jump, as in broadcasts, they are made continuous (ContinuousTime); `seek` uses the container's times.
class MediaSource {
 public:
  enum class State : std::uint8_t { Closed, Open, Ended };
  virtual ~MediaSource() = default;

  // The frames per second of pictures that have numbers but no times; nullopt: the back end's default. Before `open`.
  void setPictureRate(std::optional<double> frames_per_s) noexcept { picture_rate_ = frames_per_s; }
  // NotFound, PermissionDenied, Unsupported (protocol), Corrupt (not media), Timeout, Cancelled. Closed only.
  [[nodiscard]] Result<void> open(const std::string& url);
  // The next packet of any stream, in the container's order; nullopt at the end. A truncated file ends like a whole one
  // (see `missing`). Lost or Timeout if the source has gone away: a `remote` one may be back after `close` and `open`,
  // a live one then with times from zero. Open or Ended (nullopt again).
  [[nodiscard]] Result<std::optional<Packet>> read();
  // Seeks to the last key frame at or before `target`; the caller must flush the decoders. Open or Ended.
  [[nodiscard]] Result<void> seek(MediaTime target);
  void close() noexcept;

  // Makes a blocked call, and all later ones until the next `open`, return Cancelled. Any thread, any state.
  void interrupt() noexcept { interrupted(); }

  [[nodiscard]] State state() const noexcept { return state_; }
  // Empty while Closed. Does not change while Open.
  [[nodiscard]] const std::vector<StreamInfo>& streams() const noexcept { return streams_; }
  // Container tags, upper-case keys. Empty while Closed.
  [[nodiscard]] const std::map<std::string, std::string>& tags() const noexcept { return tags_; }
  // Empty while Closed, or if the container has none.
  [[nodiscard]] const std::vector<Chapter>& chapters() const noexcept { return chapters_; }
  // What the source found out about itself and a user may want to know, one line each. Empty while Closed.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }
  // The length of the whole film; 0 if unknown (live).
  [[nodiscard]] Duration duration() const noexcept { return duration_; }
  // True for a network source or a camera, which may go away and come back.
  [[nodiscard]] bool remote() const noexcept { return origin_.remote; }
  // True if it cannot be played again: no beginning, no end, no seeking.
  [[nodiscard]] bool live() const noexcept { return remote() && duration_ == Duration(0); }
  // Media time 0 on two other clocks, to synchronise two live sources: on this machine's, its arrival (for a camera,
  // when the picture was taken); on the sender's own, nullopt if the container does not have it.
  [[nodiscard]] MonotonicTime arrival() const noexcept { return origin_.arrival; }
  [[nodiscard]] std::optional<Duration> senderStart() const noexcept { return origin_.sender_start; }
  // Media time 0 of pictures on the clock or the count that their names are from, which another source may share.
  [[nodiscard]] std::optional<Duration> namedStart() const noexcept { return origin_.named_start; }
  // The number of jumps of its times since construction.
  [[nodiscard]] std::uint64_t jumps() const noexcept { return times_.jumps(); }
  // Pictures that were taken but never arrived, as far as the source knows (a camera numbers them), since
  // construction.
  [[nodiscard]] std::uint64_t missedPictures() const noexcept { return missed_; }
  // How much of the film could not be read, at least: behind where the data broke off, and since the last seek also
  // within it. 0 for a whole film, if unknown, and in all states but Ended.
  [[nodiscard]] Duration missing() const noexcept { return state_ == State::Ended ? missingTime() : Duration(0); }

 protected:
  struct Origin {
    bool remote = false;
    Duration longest_gap{0};  // see ContinuousTime
    MonotonicTime arrival;
    std::optional<Duration> sender_start;
    std::optional<Duration> named_start;
  };
  struct Description {
    std::vector<StreamInfo> streams;
    std::map<std::string, std::string> tags;
    Duration duration{0};
    Origin origin;
    std::vector<Chapter> chapters;
    std::vector<std::string> notes;
  };
  [[nodiscard]] std::optional<double> pictureRate() const noexcept { return picture_rate_; }
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
  std::vector<Chapter> chapters_;
  std::vector<std::string> notes_;
  std::optional<double> picture_rate_;
  Duration duration_{0};
  Origin origin_;
  ContinuousTime times_;
  std::uint64_t missed_ = 0;
};

}  // namespace relievo
