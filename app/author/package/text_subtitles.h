// SPDX-License-Identifier: Apache-2.0
// Converts subtitles from one coding of text to another.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
}

#include "platform/error.h"

namespace relievo {

// Whether the codec holds text, not pictures of it.
[[nodiscard]] bool isTextSubtitle(AVCodecID codec) noexcept;

class TextSubtitles {
 public:
  // Unsupported if this FFmpeg cannot read the one or write the other.
  [[nodiscard]] static Result<std::unique_ptr<TextSubtitles>> create(const AVCodecParameters& from,
                                                                     AVRational time_base, AVCodecID to);
  // The converted stream's parameters.
  [[nodiscard]] Result<void> describe(AVCodecParameters& parameters) const;
  // Replaces the packet's content; its times stay. `joins`: by the last packet's text, and its own below that. False if
  // there is no text in it.
  [[nodiscard]] Result<bool> convert(AVPacket& packet, bool joins);

 private:
  struct Free {
    void operator()(AVCodecContext* context) const noexcept { avcodec_free_context(&context); }
  };
  std::unique_ptr<AVCodecContext, Free> reader_, writer_;
  std::vector<std::uint8_t> coded_;
  std::string last_;  // the last packet's text, with what it joined
};

}  // namespace relievo
