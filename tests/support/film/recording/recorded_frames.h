// SPDX-License-Identifier: Apache-2.0
// All pictures of one stream of a recording, decoded.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "drivers/ffmpeg/ffmpeg.h"
#include "hal/media/media_source.h"

namespace relievo::test {

// From where the source stands to its end. In a recording every picture is a key frame, and none is damaged.
[[nodiscard]] inline std::vector<Frame> framesOf(MediaSource& source, const StreamInfo& stream) {
  std::vector<Frame> frames;
  const auto decoder = makeFfmpegDecoder();
  EXPECT_TRUE(decoder->open(stream));
  const auto receive = [&] {
    for (;;) {
      auto frame = decoder->receive();
      if (!frame || !*frame) return;
      frames.push_back(std::move(**frame));
    }
  };
  for (;;) {
    const auto packet = source.read();
    if (!packet || !*packet) break;
    if ((*packet)->stream != stream.index) continue;
    EXPECT_TRUE((*packet)->keyframe);
    EXPECT_EQ(decoder->feed(**packet), Feed::Accepted);
    receive();
  }
  EXPECT_TRUE(decoder->drain());
  receive();
  EXPECT_EQ(decoder->damaged(), 0u);
  return frames;
}

}  // namespace relievo::test
