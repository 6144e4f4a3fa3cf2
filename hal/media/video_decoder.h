// SPDX-License-Identifier: Apache-2.0
// Interface of a video decoder: coded packets in, references to pictures out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "hal/media/frame.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo {

enum class Feed : std::uint8_t {
  Accepted,  // the decoder holds its own reference to the packet
  Full,      // the packet was not taken: receive first, then feed it again
};

// States: Closed -open-> Open -drain-> Draining -last frame received-> Ended; Open, Draining or Ended -flush-> Open;
// any -close-> Closed. A call in a state that does not allow it returns InvalidState and changes nothing.
//
// Thread: one at a time. Blocking: no longer than one picture takes to decode.
// Frames come in presentation order and refer to the decoder's own buffers, without a copy. The caller may hold up to
// `capabilities().max_held_frames`; if it holds more, `feed` may answer Full forever.
class VideoDecoder {
 public:
  enum class State : std::uint8_t { Closed, Open, Draining, Ended };
  struct Capabilities {
    const char* name = "";    // "ffmpeg", "v4l2", ..
    int max_held_frames = 0;  // never changes while open
    bool hardware = false;
  };
  virtual ~VideoDecoder() = default;

  // `open` refuses larger pictures, and back ends do not decode them. The limit allows two UHD pictures side by side,
  // and a few pictures of that size fit into a set-top box's memory.
  static constexpr std::int64_t kMostSamples = std::int64_t{1} << 24;
  static constexpr const char* kTooLarge =
      "its pictures have over 16.7 million samples (the most is 7680 x 2160 or 4096 x 4096); scale the film down";

  // Unsupported if the codec is unknown here or the pictures are too large, Corrupt if its parameters make no
  // sense. Closed only.
  [[nodiscard]] Result<void> open(const StreamInfo& stream);
  // A damaged packet is no error: it is dropped and counted (`damaged`). Lost if the decoder has died.
  // Open only.
  [[nodiscard]] Result<Feed> feed(const Packet& packet);
  // The next picture, or nullopt: more packets are needed (Open, Draining) or all pictures are out (Ended).
  [[nodiscard]] Result<std::optional<Frame>> receive();
  // No more packets will come: `receive` until Ended. Open only.
  [[nodiscard]] Result<void> drain();
  // Discards packets and pictures inside, for a seek. Open, Draining, Ended.
  [[nodiscard]] Result<void> flush();
  void close() noexcept;
  // Leaves out the pictures that no other picture refers to, from about the next packet on, to save time: they never
  // come out. A back end that cannot tell them apart decodes all. Kept over a flush; `open` begins with all pictures.
  // Open, Draining, Ended.
  [[nodiscard]] Result<void> leaveOutUnreferenced(bool leave_out);

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] virtual Capabilities capabilities() const noexcept = 0;
  // Packets and pictures dropped because they were damaged, since `open`.
  [[nodiscard]] std::uint64_t damaged() const noexcept { return damaged_; }
  // For the user: which decoder is used, and why no better one. While open.
  [[nodiscard]] virtual std::string description() const { return capabilities().name; }
  // The decoder died and another continued without losing a picture. Returns the last such restart, once.
  struct Restart {
    const char* why = "";   // what failed
    const char* done = "";  // what was done about it
  };
  [[nodiscard]] std::optional<Restart> takeRestart() noexcept { return std::exchange(restart_, std::nullopt); }

 protected:
  // A back end's answer to `receive`.
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
  virtual void leaveOut(bool /*unreferenced*/) noexcept {}

  State state_ = State::Closed;
  std::uint64_t damaged_ = 0;
  std::optional<Restart> restart_;
};

}  // namespace relievo
