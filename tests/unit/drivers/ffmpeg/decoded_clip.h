// SPDX-License-Identifier: Apache-2.0
// A clip as FFmpeg's source and decoder give it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo::test {

// Every code of 16 bits, without pattern (a multiplicative hash, its upper half).
inline std::uint32_t scattered(int component, int column, int row, int frame) {
  const auto n = static_cast<std::uint32_t>(column + 1000 * row + 1'000'000 * frame + 7 * component);
  return (n * 2654435761u) >> 16;
}

struct Clip {
  std::unique_ptr<MediaSource> source = makeFfmpegSource();
  std::unique_ptr<VideoDecoder> decoder = makeFfmpegDecoder();
  std::vector<Packet> packets;

  // Opens the file's only stream, which is video.
  explicit Clip(const std::string& path) {
    EXPECT_TRUE(source->open(path).has_value());
    while (auto packet = source->read().value()) packets.push_back(*packet);
  }
  [[nodiscard]] const StreamInfo& stream() const { return source->streams().at(0); }

  std::vector<Frame> decode() {
    EXPECT_TRUE(decoder->open(stream()).has_value());
    return decodeOpen();
  }
  std::vector<Frame> decodeOpen() {
    std::vector<Frame> frames;
    const auto receiveAll = [&] {
      while (auto frame = decoder->receive().value()) frames.push_back(*frame);
    };
    for (const Packet& packet : packets) {
      while (decoder->feed(packet).value() == Feed::Full) receiveAll();
    }
    EXPECT_TRUE(decoder->drain().has_value());
    receiveAll();
    EXPECT_EQ(decoder->state(), VideoDecoder::State::Ended);
    return frames;
  }
};

inline int chromaColumns(const Frame& frame, int component) {
  if (frame.model != ColorModel::Yuv || component == 0) return frame.width;
  return (frame.width + (1 << frame.chroma_shift_x) - 1) >> frame.chroma_shift_x;
}
inline int chromaRows(const Frame& frame, int component) {
  if (frame.model != ColorModel::Yuv || component == 0) return frame.height;
  return (frame.height + (1 << frame.chroma_shift_y) - 1) >> frame.chroma_shift_y;
}

// The number of samples that differ from what was written into frame k.
inline int wrongSamples(const Frame& frame, int k) {
  int wrong = 0;
  const int components = frame.model == ColorModel::Gray ? 1 : 3;
  for (int i = 0; i < components; ++i) {
    const std::uint32_t mask = (1u << frame.components[static_cast<std::size_t>(i)].bits) - 1;
    for (int r = 0; r < chromaRows(frame, i); ++r) {
      for (int c = 0; c < chromaColumns(frame, i); ++c) {
        if (sampleAt(frame, i, c, r) != (scattered(i, c, r, k) & mask)) ++wrong;
      }
    }
  }
  return wrong;
}

}  // namespace relievo::test
