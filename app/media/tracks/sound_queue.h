// SPDX-License-Identifier: Apache-2.0
// A film's sound that has been decoded ahead, and how far it reaches. Not thread-safe.
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "hal/media/audio_decoder.h"
#include "hal/media/media_time.h"

namespace relievo {

class SoundQueue {
 public:
  // Drops everything: the film has been closed or sought.
  void forget() {
    chunks_.clear();
    ahead_ = Duration(0);
    until_.reset();
    may_come = false;
  }
  void add(AudioChunk chunk, const AudioFormat& format) {
    const Duration length = lengthOf(chunk, format);
    ahead_ += length;
    until_ = chunk.pts + length;
    chunks_.push_back(std::move(chunk));
  }
  // The oldest chunk; nullopt if there is none.
  [[nodiscard]] std::optional<AudioChunk> take(const std::optional<AudioFormat>& format) {
    if (chunks_.empty()) return std::nullopt;
    std::optional<AudioChunk> chunk(std::move(chunks_.front()));
    chunks_.pop_front();
    ahead_ -= lengthOf(*chunk, *format);
    return chunk;
  }
  // The total length of the chunks.
  [[nodiscard]] Duration ahead() const noexcept { return ahead_; }
  // The end of the newest chunk that was added, whether it was taken or not.
  [[nodiscard]] std::optional<MediaTime> until() const noexcept { return until_; }

  [[nodiscard]] static Duration lengthOf(const AudioChunk& chunk, const AudioFormat& format) {
    return fromSeconds(static_cast<double>(chunk.samples.size()) / format.channels / format.rate_hz);
  }

  bool may_come = false;  // the film has sound that has not been decoded yet

 private:
  std::deque<AudioChunk> chunks_;
  Duration ahead_{0};
  std::optional<MediaTime> until_;
};

}  // namespace relievo
