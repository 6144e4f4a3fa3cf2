// SPDX-License-Identifier: Apache-2.0
// Events of the sources and decoders of a film that is read ahead, kept until the player asks for them. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "hal/media/video_decoder.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

class FeedNews {
 public:
  struct Item {
    enum class Kind : std::uint8_t {
      ColorLost,
      ColorBack,
      DepthLost,
      DepthBack,
      DecoderRestarted,
      SoundRefused,
      WordsRefused
    };
    Kind kind;
    const char* why = "";   // cause of a loss, a restart or a refusal
    const char* done = "";  // what a restart did
    MonotonicTime time;
    std::size_t track = 0;  // the place of refused subtitles
  };

  void colorLost(const Error& error, MonotonicTime now) { items_.push_back({Kind::ColorLost, error.message, "", now}); }
  void colorBack(MonotonicTime now) { items_.push_back({Kind::ColorBack, "", "", now}); }
  // Sets why the depth is unavailable now; nullopt: it is available. Only a change is reported.
  void depth(const std::optional<Error>& loss, MonotonicTime now) {
    if (std::exchange(depth_away_, loss.has_value()) == loss.has_value()) return;
    items_.push_back({loss ? Kind::DepthLost : Kind::DepthBack, loss ? loss->message : "", "", now});
  }
  void restarted(const VideoDecoder::Restart& restart, MonotonicTime now) {
    items_.push_back({Kind::DecoderRestarted, restart.why, restart.done, now});
  }
  // The sound that was chosen cannot be decoded.
  void soundRefused(const char* why, MonotonicTime now) { items_.push_back({Kind::SoundRefused, why, "", now}); }
  // Likewise, the subtitles.
  void wordsRefused(std::size_t track, const char* why, MonotonicTime now) {
    items_.push_back({Kind::WordsRefused, why, "", now, track});
  }
  // The next event, in order, each once.
  [[nodiscard]] std::optional<Item> take() {
    if (items_.empty()) return std::nullopt;
    const Item first = items_.front();
    items_.pop_front();
    return first;
  }

 private:
  using Kind = Item::Kind;

  std::deque<Item> items_;
  bool depth_away_ = false;
};

}  // namespace relievo
