// SPDX-License-Identifier: Apache-2.0
// Interface of a sound output: buffers samples, and reports how many have been heard and when.
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

// At `time`, `frames` frames had been heard since `open` or the last `flush`. Both were sampled together; frames that
// are still in buffers are not counted.
struct AudioPosition {
  std::int64_t frames = 0;
  MonotonicTime time;
};

// States: Closed -open-> Open; any -close-> Closed. A device that goes away answers Lost, at the latest to a `write`,
// and stays in state Lost until closed. A call in a state that does not allow it returns InvalidState and changes
// nothing.
// Thread: one at a time. Blocking: `open` may wait half a second for a sound server, the others some milliseconds.
// Playback starts with the first frames after `open` or `flush`. After an underrun it is silent and continues with the
// next frames written. To pause a film, flush, and write the samples again to continue: not every device can pause with
// samples in its buffer.
class AudioOutput {
 public:
  enum class State : std::uint8_t { Closed, Open, Lost };
  struct Capabilities {
    const char* name = "";
    Duration buffer{0};  // length of its buffer; known from `open` on
  };
  virtual ~AudioOutput() = default;

  // Returns the actual format: the nearest to `wished` that the device supports. NotFound, PermissionDenied,
  // Unsupported, Exhausted (another program uses the device), Timeout (a server that may answer the next time).
  [[nodiscard]] Result<AudioFormat> open(const AudioFormat& wished);
  // Takes as many whole frames as fit, from the first on, and returns their number. Until a `flush` the next call must
  // go on with the frame behind those: it may have been taken already. Open only.
  [[nodiscard]] Result<std::size_t> write(std::span<const float> samples);
  // nullopt while silent: before the first frame plays, and after an underrun. Open only.
  [[nodiscard]] Result<std::optional<AudioPosition>> position();
  // Drops what was not heard yet; silent at once. Open only.
  [[nodiscard]] Result<void> flush();
  void close() noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  // The format of the last `open`.
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
