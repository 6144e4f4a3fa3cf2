// SPDX-License-Identifier: Apache-2.0
// Interface of a sound decoder: coded packets in, samples of the requested format out.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/audio_output.h"
#include "hal/media/media_source.h"
#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo {

// Consecutive samples, interleaved as in AudioFormat. May be empty.
struct AudioChunk {
  MediaTime pts;  // of the first frame
  std::vector<float> samples;
};

// States: Closed -open-> Open; any -close-> Closed. A call in a state that does not allow it returns InvalidState and
// changes nothing. Unlike a video decoder it has no queue: a packet's sound is small and is returned at once.
//
// Thread: one at a time. Blocking: no longer than one packet takes to decode.
class AudioDecoder {
 public:
  enum class State : std::uint8_t { Closed, Open };
  virtual ~AudioDecoder() = default;

  // The output has `format` whatever the stream holds: rates are resampled, channels mixed down.
  // Unsupported if the codec is unknown here, Corrupt if its parameters make no sense. Closed only.
  [[nodiscard]] Result<void> open(const StreamInfo& stream, const AudioFormat& format);
  // Returns the packet's sound; a codec may keep a little of it back for the next call. A damaged packet is no error:
  // it yields nothing and is counted (`damaged`). Open only.
  [[nodiscard]] Result<AudioChunk> decode(const Packet& packet);
  // Discards what was kept back, for a seek. Open only.
  [[nodiscard]] Result<void> flush();
  void close() noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] virtual const char* name() const noexcept = 0;
  // Packets dropped because they were damaged, since `open`.
  [[nodiscard]] std::uint64_t damaged() const noexcept { return damaged_; }

 protected:
  void countDamaged() noexcept { ++damaged_; }

 private:
  virtual Result<void> openDecoder(const StreamInfo& stream, const AudioFormat& format) = 0;
  virtual Result<AudioChunk> decodePacket(const Packet& packet) = 0;
  virtual void flushDecoder() noexcept = 0;
  virtual void closeDecoder() noexcept = 0;

  State state_ = State::Closed;
  std::uint64_t damaged_ = 0;
};

}  // namespace relievo
