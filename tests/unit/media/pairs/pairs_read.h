// SPDX-License-Identifier: Apache-2.0
// Clips in which the samples of each picture hold its number, and the pairs that a reader makes of them.
#pragma once

#include <gtest/gtest.h>

#include "app/media/pair_reader.h"
#include "drivers/mock/mock.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"

namespace relievo {

using test::ClipTrack;
using test::sampleAt;

// Every sample of frame k is k, so that a picture identifies its frame.
inline std::uint32_t frameNumber(int /*component*/, int /*column*/, int /*row*/, int frame) {
  return static_cast<std::uint32_t>(frame);
}

inline ClipTrack color(int fps = 30, int frames = 30) {
  return {.pix_fmt = "yuv420p", .fps_num = fps, .frames = frames, .sample = frameNumber};
}
inline ClipTrack depth(int fps = 30, int frames = 30) {
  return {.fps_num = fps, .frames = frames, .sample = frameNumber, .tags = {{"title", "depth"}}};
}

inline int numberOf(const Frame& frame) {
  return frame.empty() ? -1 : static_cast<int>(sampleAt(frame, 0, 5, 5));
}

inline std::vector<FramePair> readAll(PairReader& reader) {
  std::vector<FramePair> pairs;
  for (;;) {
    auto pair = reader.next();
    EXPECT_TRUE(pair.has_value());
    if (!pair || !*pair) return pairs;
    pairs.push_back(std::move(**pair));
  }
}

// Films of the mock back end, which can be told to fail.
struct MockFilm {
  ManualClock clock;
  MockMediaProfile color, depth;
  int sources = 0;
  PairReader reader{{[this](const std::string&) { return makeMockSource(sources++ == 0 ? color : depth, clock); },
                     [](const StreamInfo&) { return makeMockDecoder(); }}};
};

}  // namespace relievo
