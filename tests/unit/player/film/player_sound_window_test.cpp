// SPDX-License-Identifier: Apache-2.0
// Pieces of sound at their places: seams, gaps, overlaps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/player/sound/sound_window.h"

namespace relievo {
namespace {

using testing::Each;
using testing::ElementsAre;

// A thousand frames a second of one channel, so that a frame is a millisecond; the value of each is its own position.
class SoundWindowTest : public testing::Test {
 protected:
  static AudioChunk piece(double from_s, int frames, int first) {
    AudioChunk chunk{.pts = mediaTime(from_s), .samples = {}};
    for (int i = 0; i < frames; ++i) chunk.samples.push_back(static_cast<float>(first + i));
    return chunk;
  }
  std::vector<float> read(std::int64_t first, std::size_t count) {
    std::vector<float> out(count, -1.0F);
    out.resize(window_.read(first, out));
    return out;
  }
  SoundWindow window_{{.rate_hz = 1000, .channels = 1}};
};

TEST_F(SoundWindowTest, GivesBackWhatWasPutInAtItsPlace) {
  window_.add(piece(1.0, 20, 1000));
  window_.add(piece(1.02, 20, 1020));
  EXPECT_EQ(window_.end(), 1040);
  EXPECT_THAT(read(1018, 4), ElementsAre(1018, 1019, 1020, 1021));
  EXPECT_THAT(read(1038, 10), ElementsAre(1038, 1039));
  EXPECT_TRUE(read(1040, 10).empty());
}

TEST_F(SoundWindowTest, BeforeItsBeginningThereIsSilence) {
  window_.add(piece(0.003, 2, 3));
  EXPECT_THAT(read(0, 5), ElementsAre(0, 0, 0, 3, 4));
  EXPECT_THAT(read(-3, 3), Each(0));
}

TEST_F(SoundWindowTest, RoundedTimesMakeNoSeam) {
  window_.add(piece(0.0, 20, 0));
  window_.add(piece(0.029, 20, 20));  // 9 ms too late
  window_.add(piece(0.031, 20, 40));  // 9 ms too early
  EXPECT_EQ(window_.end(), 60);
  EXPECT_THAT(read(18, 4), ElementsAre(18, 19, 20, 21));
  EXPECT_THAT(read(38, 4), ElementsAre(38, 39, 40, 41));
}

TEST_F(SoundWindowTest, ARealGapIsSilence) {
  window_.add(piece(0.0, 20, 0));
  window_.add(piece(0.05, 20, 50));
  EXPECT_THAT(read(19, 3), ElementsAre(19, 0, 0));
  EXPECT_THAT(read(48, 4), ElementsAre(0, 0, 50, 51));
}

TEST_F(SoundWindowTest, WhatIsThereAlreadyIsLeftOut) {
  window_.add(piece(0.0, 50, 0));
  window_.add(piece(0.02, 50, 20));
  window_.add(piece(0.0, 30, 0));
  EXPECT_EQ(window_.end(), 70);
  EXPECT_THAT(read(48, 4), ElementsAre(48, 49, 50, 51));
}

TEST_F(SoundWindowTest, ForgetsWhatIsOver) {
  window_.add(piece(0.0, 20, 0));
  window_.add(piece(0.02, 20, 20));
  window_.dropBefore(20);
  EXPECT_THAT(read(19, 2), ElementsAre(0, 20));
  window_.dropBefore(1000);
  EXPECT_TRUE(window_.empty());
  EXPECT_TRUE(read(0, 4).empty());
}

TEST_F(SoundWindowTest, ChannelsStayTogether) {
  SoundWindow stereo({.rate_hz = 1000, .channels = 2});
  stereo.add({.pts = MediaTime{}, .samples = {1, -1, 2, -2, 3, -3}});
  std::vector<float> out(4);
  EXPECT_EQ(stereo.read(1, out), 2u);
  EXPECT_THAT(out, ElementsAre(2, -2, 3, -3));
}

}  // namespace
}  // namespace relievo
