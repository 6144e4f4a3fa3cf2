// SPDX-License-Identifier: Apache-2.0
// Interface of a video decoder: coded packets in, pictures by reference out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "hal/frame.h"
#include "hal/media_source.h"
#include "platform/error.h"

namespace relievo {

enum class Feed : std::uint8_t {
  Accepted,  // the decoder has taken its own reference of the packet
  Full,      // nothing was taken: receive first, then feed the same packet again
};

// States: Closed -open-> Open -drain-> Draining -last frame received-> Ended; Open, Draining or Ended -flush-> Open;
// any -close-> Closed. A verb in a state that does not allow it returns InvalidState and changes nothing.
//
// Thread: one at a time. Blocking: no longer than one picture takes to decode.
// Frames come in presentation order and by reference: the decoder's own buffers, no copy. The caller may hold as many
// as `capabilities().max_held_frames`; holding more may make `feed` answer Full for good.
class VideoDecoder {
 public:
  enum class State : std::uint8_t { Closed, Open, Draining, Ended };
  struct Capabilities {
    const char* name = "";    // "ffmpeg", "v4l2", ..
    int max_held_frames = 0;  // never changes while open
    bool hardware = false;
  };
  virtual ~VideoDecoder() = default;

  // Pictures of more samples are neither opened nor decoded: two of UHD beside each other go, and a handful of such
  // pictures fits a box's memory.
  static constexpr std::int64_t kMostSamples = std::int64_t{1} << 24;

  // Unsupported when the codec is unknown here or the pictures are too large, Corrupt when its parameters make no
  // sense. Closed only.
  [[nodiscard]] Result<void> open(const StreamInfo& stream);
  // A packet that is damaged is dropped and counted (`damaged`), not an error. Lost when the decoder has died.
  // Open only.
  [[nodiscard]] Result<Feed> feed(const Packet& packet);
  // The next picture, or nothing: more packets are needed (Open, Draining) or all pictures are out (Ended).
  [[nodiscard]] Result<std::optional<Frame>> receive();
  // No more packets will come: `receive` until Ended. Open only.
  [[nodiscard]] Result<void> drain();
  // Forgets packets and pictures inside, for a seek. Open, Draining, Ended.
  [[nodiscard]] Result<void> flush();
  void close() noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] virtual Capabilities capabilities() const noexcept = 0;
  // Packets and pictures dropped because they were damaged, since `open`.
  [[nodiscard]] std::uint64_t damaged() const noexcept { return damaged_; }
  // For people: what decodes, and why not something better. While open.
  [[nodiscard]] virtual std::string description() const { return capabilities().name; }
  // It has died and gone on where it was: no picture is missing. The last time, once.
  struct Restart {
    const char* why = "";
    const char* done = "";
  };
  [[nodiscard]] std::optional<Restart> takeRestart() noexcept { return std::exchange(restart_, std::nullopt); }

 protected:
  // What a back end answers on `receive`.
  enum class Progress : std::uint8_t { Picture, NeedsPackets, EndOfStream };
  void countDamaged(std::uint64_t more = 1) noexcept { damaged_ += more; }
  void noteRestart(const Restart& restart) noexcept { restart_ = restart; }

 private:
  virtual Result<void> openDecoder(const StreamInfo& stream) = 0;
  virtual Result<Feed> feedPacket(const Packet& packet) = 0;
  virtual Result<Progress> receiveFrame(Frame& frame) = 0;
  virtual Result<void> startDrain() = 0;
  virtual Result<void> flushDecoder() = 0;
  virtual void closeDecoder() noexcept = 0;

  State state_ = State::Closed;
  std::uint64_t damaged_ = 0;
  std::optional<Restart> restart_;
};

}  // namespace relievo
