// SPDX-License-Identifier: Apache-2.0
// A FilmFeed over a mock source, its reader called by hand.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "app/media/film_feed.h"
#include "drivers/mock/mock.h"
#include "platform/clock.h"

namespace relievo::test {

inline constexpr Duration kPeriod = std::chrono::milliseconds(40);
inline constexpr std::size_t kCapacity = 4;

inline MockMediaProfile filmOf(int frames) {
  MockTrack color{.width = 16, .height = 12, .model = ColorModel::Yuv, .frames = frames, .frame_period = kPeriod};
  MockTrack depth{.width = 16, .height = 12, .frames = frames, .frame_period = kPeriod};
  return {.tracks = {color, depth}};
}

inline PairReader::Backends backends(MockMediaProfile profile, Clock& clock) {
  return {.make_source = [profile = std::move(profile),
                          &clock](const std::string&) { return makeMockSource(profile, clock); },
          .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); },
          .clock = &clock};
}

class FilmFeedTest : public testing::Test {
 protected:
  FilmFeed& open(MockMediaProfile profile) {
    feed_ = std::make_unique<FilmFeed>(backends(std::move(profile), clock_), kCapacity);
    feed_->open({.url = "mock"});
    return *feed_;
  }
  int workAll() {
    int pieces = 0;
    while (feed_->work()) ++pieces;
    return pieces;
  }
  // Times, in frame periods, of all pairs that can be taken without further work.
  std::vector<int> takeAll() {
    std::vector<int> taken;
    while (const auto pair = feed_->take()) {
      taken.push_back(static_cast<int>(pair->color.pts.time_since_epoch() / kPeriod));
      EXPECT_EQ(pair->depth.pts, pair->color.pts);
    }
    return taken;
  }

  ManualClock clock_;
  std::unique_ptr<FilmFeed> feed_;
};

}  // namespace relievo::test
