// SPDX-License-Identifier: Apache-2.0
// All pictures of one stream of a recording or a folder of pictures, decoded.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "drivers/ffmpeg/ffmpeg.h"
#include "hal/media/media_source.h"
#include "hal/media/video_decoder.h"

namespace relievo::test {

// From the source's position to its end, by a decoder that is open for the stream. Every picture is a key frame.
[[nodiscard]] inline std::vector<Frame> framesOf(MediaSource& source, const StreamInfo& stream, VideoDecoder& decoder) {
  std::vector<Frame> frames;
  const auto receive = [&] {
    for (;;) {
      auto frame = decoder.receive();
      if (!frame || !*frame) return;
      frames.push_back(std::move(**frame));
    }
  };
  for (;;) {
    const auto packet = source.read();
    if (!packet || !*packet) break;
    if ((*packet)->stream != stream.index) continue;
    EXPECT_TRUE((*packet)->keyframe);
    EXPECT_EQ(decoder.feed(**packet), Feed::Accepted);
    receive();
  }
  EXPECT_TRUE(decoder.drain());
  receive();
  return frames;
}

// The same by FFmpeg, which finds no damage.
[[nodiscard]] inline std::vector<Frame> framesOf(MediaSource& source, const StreamInfo& stream) {
  const auto decoder = makeFfmpegDecoder();
  EXPECT_TRUE(decoder->open(stream));
  auto frames = framesOf(source, stream, *decoder);
  EXPECT_EQ(decoder->damaged(), 0u);
  return frames;
}

}  // namespace relievo::test
