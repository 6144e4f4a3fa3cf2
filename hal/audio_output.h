// SPDX-License-Identifier: Apache-2.0
// Interface of a sound output: takes samples ahead, and tells how many of them have been heard and when.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// Samples are floats from -1 to 1, interleaved: a frame is one sample of each channel.
struct AudioFormat {
  int rate_hz = 48000;
  int channels = 2;

  friend bool operator==(const AudioFormat&, const AudioFormat&) = default;
};

// "At `time` so many frames had been heard", counted from `open` or the last `flush`: both were sampled together, and
// what lies in buffers on the way to the ear is not counted.
struct AudioPosition {
  std::int64_t frames = 0;
  MonotonicTime time;
};

// States: Closed -open-> Open; any -close-> Closed. A device that goes away answers Lost, at the latest to a `write`,
// and is in state Lost until closed. A verb in a state that does not allow it returns InvalidState and changes nothing.
//
// Thread: one at a time. Blocking: `open` may take as long as a sound server needs; all others never wait.
// It begins to play with the first frames after `open`, a `flush` or a pause of its own: one that has run dry is silent
// until it is given more, and goes on from there. A film that stands flushes, and writes anew when it goes on: not
// every device can hold what it has.
class AudioOutput {
 public:
  enum class State : std::uint8_t { Closed, Open, Lost };
  struct Capabilities {
    const char* name = "";
    Duration buffer{0};  // that it takes ahead; known from `open` on
  };
  virtual ~AudioOutput() = default;

  // Returns what it really runs at: the nearest to what is wished for that the device can. NotFound, PermissionDenied,
  // Unsupported, Exhausted (another program has it).
  [[nodiscard]] Result<AudioFormat> open(const AudioFormat& wished);
  // Takes as many whole frames as there is room for, from the first on, and returns how many. Open only.
  [[nodiscard]] Result<std::size_t> write(std::span<const float> samples);
  // Nothing while it is silent: before the first frame is on its way, and after it has run dry. Open only.
  [[nodiscard]] Result<std::optional<AudioPosition>> position();
  // Silent at once: drops what was not heard yet. Open only.
  [[nodiscard]] Result<void> flush();
  void close() noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  // Of the last `open`.
  [[nodiscard]] const AudioFormat& format() const noexcept { return format_; }
  [[nodiscard]] virtual Capabilities capabilities() const noexcept = 0;

 private:
  virtual Result<AudioFormat> openOutput(const AudioFormat& wished) = 0;
  virtual Result<std::size_t> writeFrames(const float* samples, std::size_t frames) = 0;
  virtual Result<std::optional<AudioPosition>> samplePosition() = 0;
  virtual Result<void> dropFrames() = 0;
  virtual void closeOutput() noexcept = 0;

  template <class T>
  Result<T> noteLoss(Result<T> result) noexcept {
    if (!result && result.error().code == ErrorCode::Lost) state_ = State::Lost;
    return result;
  }

  State state_ = State::Closed;
  AudioFormat format_;
};

}  // namespace relievo
