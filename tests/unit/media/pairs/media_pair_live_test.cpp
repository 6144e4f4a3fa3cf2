// SPDX-License-Identifier: Apache-2.0
// Colour and depth from two sources over a network meet by their arrival, and again after a loss.
#include <gtest/gtest.h>

#include <future>

#include "app/media/depth_source.h"
#include "app/media/pair_reader.h"
#include "drivers/mock/mock.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/media/pairs/pairs_read.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;
using test::sampleAt;

MockMediaProfile live(int frames) {
  MockMediaProfile profile{.tracks = {MockTrack{.frames = frames, .frame_period = milliseconds(40)}}};
  profile.live = profile.remote = true;
  return profile;
}

// The source made second is opened later.
PairReader::Backends twoLive(const MockMediaProfile& color, const MockMediaProfile& depth, ManualClock& clock,
                             Duration later) {
  return {.make_source =
              [=, &clock, made = 0](const std::string&) mutable {
                const bool second = made++ % 2 == 1;
                if (second) clock.advance(later);
                return makeMockSource(second ? depth : color, clock);
              },
          .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); },
          .clock = &clock};
}

// A picture's number, from the motion of its slope.
int slopeNumber(const Frame& frame) {
  return static_cast<int>(sampleAt(frame, 0, 0, 0)) / 2;
}

// Pictures that arrive at the same time belong together: the depth's first picture and the colour's 25th, with which
// the film begins.
TEST(PairReader, TwoLiveSourcesMeetByTheirArrivalHere) {
  ManualClock clock;
  PairReader reader(twoLive(live(100), live(100), clock, std::chrono::seconds(1)));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (int k = 25; k < 60; ++k) {
    const auto pair = reader.next().value();
    EXPECT_EQ(slopeNumber(pair->color), k);
    EXPECT_EQ(slopeNumber(pair->depth), k - 25);
    EXPECT_EQ(pair->depth.pts, pair->color.pts);
  }
}

TEST(PairReader, TwoLiveSourcesOfOneSenderMeetByItsClock) {
  ManualClock clock;
  MockMediaProfile color = live(100), depth = live(100);
  color.sender_start = std::chrono::hours(5);
  depth.sender_start = std::chrono::hours(5) + milliseconds(400);
  PairReader reader(twoLive(color, depth, clock, std::chrono::seconds(1)));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  const auto pair = reader.next().value();
  EXPECT_EQ(slopeNumber(pair->color), 10);
  EXPECT_EQ(slopeNumber(pair->depth), 0);
}

TEST(PairReader, TwoLiveSourcesOfTwoSendersMeetByTheirArrival) {
  ManualClock clock;
  MockMediaProfile color = live(100), depth = live(100);
  color.sender_start = std::chrono::hours(5);
  depth.sender_start = std::chrono::hours(9);
  PairReader reader(twoLive(color, depth, clock, milliseconds(600)));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  const auto pair = reader.next().value();
  EXPECT_EQ(slopeNumber(pair->color), 15);
  EXPECT_EQ(slopeNumber(pair->depth), 0);
}

// The colour's connection breaks after a second and is back half a second later; the depth has continued meanwhile.
TEST(PairReader, TwoLiveSourcesMeetAnewAfterTheColourWasAway) {
  ManualClock clock;
  MockMediaProfile color = live(100), depth = live(100);
  color.lose_after_packets = 25;
  PairReader reader(
      {.make_source = [=, &clock, made = 0](
                          const std::string&) mutable { return makeMockSource(made++ == 1 ? depth : color, clock); },
       .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); },
       .clock = &clock});
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  Result<std::optional<FramePair>> pair = reader.next();
  MediaTime last;
  for (; pair; pair = reader.next()) last = (*pair)->color.pts;
  ASSERT_TRUE(reader.isSourceLost(pair.error()));
  clock.advance(milliseconds(1600));
  ASSERT_TRUE(reader.reopen().has_value());
  pair = reader.next();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ((*pair)->color.pts, last + milliseconds(40)) << "the film's time goes on";
  EXPECT_EQ(slopeNumber((*pair)->color), 0);
  ASSERT_FALSE((*pair)->depth.empty());
  EXPECT_EQ(slopeNumber((*pair)->depth), 40) << "1.6 s after the depth's first";
  EXPECT_EQ(reader.counters().reconnects, 1u);
}

// In real time, with the depth's own thread: the depth stalls for an hour, the colour is read to its end, and the film
// can be closed.
TEST(PairReader, DepthThatFallsSilentDoesNotHoldTheColourUp) {
  MonotonicClock clock;
  MockMediaProfile color{.tracks = {MockTrack{.frames = 60}}}, depth = live(60);
  depth.tracks[0].frame_period = color.tracks[0].frame_period;
  depth.stall_after_packets = 20;
  depth.stall = std::chrono::hours(1);
  PairReader reader(
      {.make_source = [=, &clock, made = 0](
                          const std::string&) mutable { return makeMockSource(made++ == 0 ? color : depth, clock); },
       .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 64}); },
       .clock = &clock,
       .own_threads = true});
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 60u);
  for (std::size_t k = 0; k < 19; ++k) EXPECT_EQ(pairs[k].depth.pts, pairs[k].color.pts) << k;
  for (std::size_t k = 25; k < 60; ++k) EXPECT_TRUE(pairs[k].depth.empty()) << k;
  reader.close();
}

TEST(PairReader, DepthOfAThreadOfItsOwnIsPairedLikeAnyOther) {
  MonotonicClock clock;
  MockMediaProfile color{.tracks = {MockTrack{.frames = 200}}}, depth{.tracks = {MockTrack{.frames = 200}}};
  depth.remote = true;
  PairReader reader(
      {.make_source = [=, &clock, made = 0](
                          const std::string&) mutable { return makeMockSource(made++ == 0 ? color : depth, clock); },
       .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 300}); },
       .clock = &clock,
       .own_threads = true});
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (const double target : {0.0, 3.0, 1.0}) {
    ASSERT_TRUE(reader.seek(mediaTime(target)).has_value());
    const auto pairs = readAll(reader);
    EXPECT_NEAR(static_cast<double>(pairs.size()), 200 - 30 * target, 1);
    for (const FramePair& pair : pairs) EXPECT_EQ(pair.depth.pts, pair.color.pts);
  }
  EXPECT_EQ(reader.counters().mismatched, 0u);
}

// Colour on the left, depth on the right; dark after the loss.
TEST(PairReader, ALiveFilmOfHalvesKeepsThemWhenItComesBackDark) {
  MockFilm film;
  film.color = live(60);
  film.color.tracks[0].model = ColorModel::Yuv;
  film.color.tracks[0].sample = [](int, int component, int c, int r) -> std::uint16_t {
    const bool left = component == 0 ? c < 80 : c < 40;
    if (component > 0) return left ? static_cast<std::uint16_t>(component == 1 ? 60 : 200) : 128;
    return static_cast<std::uint16_t>(40 + (left ? 2 * (r % 50) : 2 * (c - 80)));
  };
  film.depth = film.color;
  film.depth.tracks[0].sample = [](int, int component, int, int) -> std::uint16_t { return component > 0 ? 128 : 0; };
  film.color.lose_after_packets = 20;
  ASSERT_TRUE(film.reader.open({.url = "film"}).has_value());
  ASSERT_EQ(film.reader.info().packing, Packing::SideBySide);
  Result<std::optional<FramePair>> pair = film.reader.next();
  while (pair) pair = film.reader.next();
  ASSERT_TRUE(film.reader.isSourceLost(pair.error()));
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(film.reader.reopen().has_value());
    EXPECT_EQ(film.reader.info().packing, Packing::SideBySide);
    EXPECT_EQ(film.reader.info().color_width, 80);
    pair = film.reader.next();
    ASSERT_TRUE(pair && *pair);
    EXPECT_EQ((*pair)->color.width, 80);
    EXPECT_EQ((*pair)->depth.width, 80);
  }
}

TEST(PairReader, ALiveFilmThatCannotSeekGoesOnWhereItWas) {
  MockFilm film;
  film.color.live = true;
  ASSERT_TRUE(film.reader.open({.url = "color"}).has_value());
  const MediaTime first = film.reader.next().value()->color.pts;
  const auto sought = film.reader.seek(MediaTime{});
  ASSERT_FALSE(sought.has_value());
  EXPECT_EQ(sought.error().code, ErrorCode::Unsupported);
  EXPECT_EQ(film.reader.next().value()->color.pts, first + film.color.tracks[0].frame_period);
}

TEST(DepthSource, ASeekWhileItsSourceIsBeingOpenedAgainIsCarriedOut) {
  MonotonicClock clock;
  const MockMediaProfile whole{.tracks = {MockTrack{.width = 16, .height = 12, .frames = 1000}}, .remote = true};
  MockMediaProfile first = whole;
  first.lose_after_packets = 5;
  std::promise<void> opening, sought;
  int made = 0;
  const PairReader::Backends backends{.make_source =
                                          [&](const std::string&) {
                                            if (++made == 1) return makeMockSource(first, clock);
                                            if (made == 2) {
                                              opening.set_value();
                                              sought.get_future().wait();
                                            }
                                            return makeMockSource(whole, clock);
                                          },
                                      .make_decoder = [](const StreamInfo&) { return makeMockDecoder(); },
                                      .clock = &clock,
                                      .own_threads = true};
  DepthSource source(backends, {});
  ASSERT_TRUE(source.open("depth").has_value());
  opening.get_future().wait();
  ASSERT_TRUE(source.seek(mediaTime(20), Duration(0)).has_value());
  sought.set_value();
  Frame found;
  while (found.empty()) found = source.next().value().frame;
  EXPECT_NEAR(toSeconds(found.pts), 20, 0.04);
}

}  // namespace
}  // namespace relievo
