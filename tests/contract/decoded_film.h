// SPDX-License-Identifier: Apache-2.0
// Whole films through a decoder, as a player feeds them, for comparison with FFmpeg's pictures.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "drivers/failover/failover.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo::test {

// A film that moves, of three key frames.
inline constexpr int kMovingFrames = 72;
inline ClipTrack movingClip(int width = 100, int height = 70) {
  ClipTrack track{.codec = "libx264",
                  .pix_fmt = "yuv420p",
                  .width = width,
                  .height = height,
                  .fps_num = 25,
                  .frames = kMovingFrames,
                  .gop = 24,
                  .b_frames = 2};
  track.sample = [](int i, int c, int r, int n) {
    return static_cast<std::uint32_t>(i == 0 ? 20 + (3 * c + 2 * r + 5 * n + (c * r) % 7) % 200
                                             : 100 + (c + n + 7 * i) % 50);
  };
  return track;
}

// A film's packets of one track.
struct Film {
  explicit Film(const std::string& path, std::size_t track = 0) {
    const auto source = makeFfmpegSource();
    EXPECT_TRUE(source->open(path));
    stream = source->streams().at(track);
    for (;;) {
      auto packet = source->read();
      EXPECT_TRUE(packet);
      if (!packet || !*packet) return;
      if ((*packet)->stream == stream.index) packets.push_back(std::move(**packet));
    }
  }
  StreamInfo stream;
  std::vector<Packet> packets;
};

struct Shown {
  MediaTime pts;
  int width, height;
  std::uint64_t digest;
  bool operator==(const Shown&) const = default;
};
inline void PrintTo(const Shown& shown, std::ostream* out) {
  *out << toSeconds(shown.pts) << " s, " << shown.width << " x " << shown.height << ", " << std::hex << shown.digest;
}

// A digest of every sample of every component.
inline Shown shownOf(const Frame& frame) {
  std::uint64_t sum = 1469598103934665603ull;
  for (int i = 0; i < (frame.model == ColorModel::Gray ? 1 : 3); ++i) {
    const int across = i > 0 ? frame.chroma_shift_x : 0, down = i > 0 ? frame.chroma_shift_y : 0;
    for (int r = 0; r < (frame.height + (1 << down) - 1) >> down; ++r) {
      for (int c = 0; c < (frame.width + (1 << across) - 1) >> across; ++c) {
        sum = (sum ^ sampleAt(frame, i, c, r)) * 1099511628211ull;
      }
    }
  }
  return {frame.pts, frame.width, frame.height, sum};
}

// Feeds packets [from, to) and collects the pictures, as a player does; `each` gets every picture.
using Each = std::function<void(const Frame&)>;
inline Result<void> feedTo(VideoDecoder& decoder, const Film& film, std::size_t from, std::size_t to,
                           std::vector<Shown>& shown, const Each& each = {}) {
  const auto receive = [&]() -> Result<void> {
    for (;;) {
      auto frame = decoder.receive();
      if (!frame) return std::unexpected(frame.error());
      if (!*frame) return {};
      shown.push_back(shownOf(**frame));
      if (each) each(**frame);
    }
  };
  for (std::size_t i = from; i < to;) {
    if (auto received = receive(); !received) return received;
    const auto fed = decoder.feed(film.packets[i]);
    if (!fed) return std::unexpected(fed.error());
    EXPECT_EQ(*fed, Feed::Accepted) << "though all pictures were received";
    ++i;
  }
  if (to < film.packets.size()) return receive();
  if (auto drained = decoder.drain(); !drained) return drained;
  auto received = receive();
  EXPECT_TRUE(!received || decoder.state() == VideoDecoder::State::Ended);
  return received;
}
inline std::vector<Shown> play(VideoDecoder& decoder, const Film& film, const Each& each = {}) {
  std::vector<Shown> shown;
  const auto played = feedTo(decoder, film, 0, film.packets.size(), shown, each);
  EXPECT_TRUE(played) << played.error().message;
  return shown;
}
inline std::vector<Shown> bySoftware(const Film& film) {
  const auto decoder = makeFfmpegDecoder();
  EXPECT_TRUE(decoder->open(film.stream));
  return play(*decoder, film);
}
// Opened for the film, with FFmpeg's decoder behind it.
inline std::unique_ptr<VideoDecoder> openWithFailover(std::unique_ptr<VideoDecoder> best, const Film& film) {
  std::vector<std::unique_ptr<VideoDecoder>> decoders;
  decoders.push_back(std::move(best));
  decoders.push_back(makeFfmpegDecoder());
  auto decoder = makeFailoverDecoder(std::move(decoders));
  EXPECT_TRUE(decoder->open(film.stream));
  return decoder;
}

// Seeks forget what is inside the decoder, `inside` packets of the film, and the pictures go on exactly.
inline void expectSeeksToGoOnExactly(VideoDecoder& decoder, const Film& film, std::size_t inside) {
  const auto software = bySoftware(film);
  for (const std::size_t key : {48u, 0u, 24u}) {
    std::vector<Shown> before, after;
    ASSERT_TRUE(feedTo(decoder, film, 0, inside, before));
    EXPECT_GT(before.size(), 10u);
    ASSERT_TRUE(decoder.flush());
    ASSERT_TRUE(feedTo(decoder, film, key, film.packets.size(), after));
    EXPECT_EQ(after, std::vector(software.begin() + static_cast<std::ptrdiff_t>(key), software.end()));
    ASSERT_TRUE(decoder.flush());
  }
  EXPECT_EQ(decoder.damaged(), 0u);
}
// After a seek to a key frame of an open group, the pictures shown before it cannot be decoded; nothing is damaged, but
// for pictures that a library's element loses, at most `lost`, which are counted.
inline void expectASeekIntoAnOpenGroupToDamageNothing(VideoDecoder& decoder, const Film& film, std::size_t lost = 0) {
  const auto software = bySoftware(film);
  std::size_t key = 1;
  while (key + 1 < film.packets.size() && !film.packets[key].keyframe) ++key;
  ASSERT_LT(key + 1, film.packets.size());
  ASSERT_LT(*film.packets[key + 1].pts, *film.packets[key].pts) << "the group is open";
  std::vector<Shown> before, after;
  ASSERT_TRUE(feedTo(decoder, film, 0, key, before));
  ASSERT_TRUE(decoder.flush());
  ASSERT_TRUE(feedTo(decoder, film, key, film.packets.size(), after));
  const auto first = std::ranges::find(software, *film.packets[key].pts, &Shown::pts);
  const std::vector<Shown> expected(first, software.end());
  ASSERT_FALSE(after.empty());
  EXPECT_EQ(after.front(), expected.front());
  ASSERT_LE(after.size(), expected.size());
  EXPECT_LE(expected.size() - after.size(), lost);
  EXPECT_EQ(decoder.damaged(), expected.size() - after.size());
  auto next = expected.begin();
  for (const Shown& shown : after) {
    next = std::find(next, expected.end(), shown);
    ASSERT_NE(next, expected.end()) << toSeconds(shown.pts);
  }
}
// As when a broadcast's times wrap round, or its next item begins.
inline void expectDamageToCountAfterTheTimesJumpBack(VideoDecoder& decoder, Film film) {
  for (std::size_t i = 24; i < film.packets.size(); ++i) {
    *film.packets[i].pts -= std::chrono::seconds(100);
    film.packets[i].dts.reset();
  }
  static const std::uint8_t noise[] = {0, 0, 0, 3, 0x41, 0xFF, 0x13};  // a slice, by its first byte
  film.packets[50].data = noise;
  film.packets[50].bytes = sizeof noise;
  std::vector<Shown> shown;
  ASSERT_TRUE(feedTo(decoder, film, 0, film.packets.size(), shown));
  EXPECT_LT(shown.size(), film.packets.size());
  EXPECT_GT(decoder.damaged(), 0u);
}
// As in fast forward: each key frame is drained by itself.
inline void expectKeyFramesDrainedOneByOne(VideoDecoder& decoder, const Film& film) {
  const auto software = bySoftware(film);
  for (std::size_t key = 0; key < film.packets.size(); key += 24) {
    ASSERT_TRUE(film.packets[key].keyframe);
    ASSERT_EQ(decoder.feed(film.packets[key]).value(), Feed::Accepted);
    ASSERT_TRUE(decoder.drain());
    const auto frame = decoder.receive().value();
    ASSERT_TRUE(frame);
    EXPECT_EQ(shownOf(*frame), software[key]);
    EXPECT_FALSE(decoder.receive().value());
    EXPECT_EQ(decoder.state(), VideoDecoder::State::Ended);
    ASSERT_TRUE(decoder.flush());
  }
}

}  // namespace relievo::test
