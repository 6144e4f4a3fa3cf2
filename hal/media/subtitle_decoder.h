// SPDX-License-Identifier: Apache-2.0
// Interface of a subtitle decoder: coded packets in, lines in the form of Advanced SubStation or pictures out.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/media/media_source.h"
#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo {

// A picture of words on the film's canvas, in pixels from its top left. Red, green, blue, opacity; the colours are
// multiplied by the opacity.
struct SubtitlePicture {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

// What is shown from `begin` to `end`, or without an end until the next one begins. Neither lines nor pictures: nothing
// is shown.
struct Subtitle {
  MediaTime begin;
  std::optional<MediaTime> end;
  std::vector<std::string> lines;             // "ReadOrder,Layer,Style,Name,MarginL,MarginR,MarginV,Effect,Text"
  std::shared_ptr<const std::string> styles;  // the script's head: the same object for all of a track
  std::vector<SubtitlePicture> pictures;
  int canvas_width = 0, canvas_height = 0;  // of pictures; 0: the video's
};

// States: Closed -open-> Open. Thread: one at a time. Blocking: no longer than one packet takes to decode.
class SubtitleDecoder {
 public:
  virtual ~SubtitleDecoder() = default;

  // Unsupported if the codec is unknown here. Once.
  [[nodiscard]] virtual Result<void> open(const StreamInfo& stream) = 0;
  // A packet that holds none, or is damaged, yields nothing. Open only.
  [[nodiscard]] virtual std::optional<Subtitle> decode(const Packet& packet) = 0;
  // After a seek. Open only.
  virtual void flush() noexcept = 0;
};

}  // namespace relievo
