// SPDX-License-Identifier: Apache-2.0
// Seeks in paired films land on the first pair at or after their target.
#include <gtest/gtest.h>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/media/pairs/pairs_read.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;
using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;

struct SeekCase {
  const char* name;
  const char* file;
  ClipTrack color, depth;
};
void PrintTo(const SeekCase& c, std::ostream* out) {
  *out << c.name;
}
class Seeks : public testing::TestWithParam<SeekCase> {};

// A seek to any time (of a frame, between frames, beyond the end) gives the same pair as reading in order.
TEST_P(Seeks, LandOnTheFirstPairAtOrAfterTheTarget) {
  TemporaryFolder folder;
  makeClip(folder / GetParam().file, {GetParam().color, GetParam().depth});
  const SourceOptions options{.url = folder / GetParam().file};
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open(options).has_value());
  const auto pairs = readAll(reader);
  const std::size_t count = pairs.size();
  ASSERT_EQ(count, static_cast<std::size_t>(GetParam().color.frames));
  const auto sameAs = [&](std::size_t k) {
    const auto found = reader.next().value();
    ASSERT_TRUE(found.has_value()) << k;
    EXPECT_EQ(found->color.pts, pairs[k].color.pts) << k;
    EXPECT_EQ(numberOf(found->color), numberOf(pairs[k].color)) << k;
    EXPECT_EQ(numberOf(found->depth), numberOf(pairs[k].depth)) << k;
    EXPECT_EQ(found->depth.pts, pairs[k].depth.pts) << k;
    EXPECT_EQ(found->matched, pairs[k].matched) << k;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = i * 7 % count;  // back and forth
    ASSERT_TRUE(reader.seek(pairs[k].color.pts).has_value());
    sameAs(k);
    if (k + 1 < count) sameAs(k + 1);
    ASSERT_TRUE(reader.seek(pairs[k].color.pts - Duration(1)).has_value());
    sameAs(k);
    ASSERT_TRUE(reader.seek(pairs[k].color.pts + Duration(1)).has_value());
    sameAs(k + 1 < count ? k + 1 : k);  // the last one stands for its time
  }
  ASSERT_TRUE(reader.seek(mediaTime(-5)).has_value());
  sameAs(0);
  ASSERT_TRUE(reader.seek(mediaTime(1e4)).has_value());
  EXPECT_FALSE(reader.next().value().has_value());
  ASSERT_TRUE(reader.seek(MediaTime{}).has_value());
  for (std::size_t k = 0; k < count; ++k) sameAs(k);
}

ClipTrack h264(int fps, int frames, int gop, int b_frames, Duration start = Duration(0)) {
  return {.codec = "libx264",
          .pix_fmt = "yuv420p",
          .fps_num = fps,
          .frames = frames,
          .start = start,
          .gop = gop,
          .b_frames = b_frames,
          .sample = [](int component, int, int, int k) -> std::uint32_t {
            return component > 0 ? 128 : static_cast<std::uint32_t>(k * 3);
          },
          .options = {{"qp", "1"}}};
}

INSTANTIATE_TEST_SUITE_P(
    PairReader, Seeks,
    testing::Values(SeekCase{"Matroska", "a.mkv", h264(25, 48, 12, 0), h264(25, 48, 12, 0)},
                    SeekCase{"MatroskaReordered", "a.mkv", h264(30, 48, 12, 2), h264(30, 48, 12, 2)},
                    SeekCase{"Mp4Reordered", "a.mp4", h264(30, 48, 12, 2), h264(30, 48, 12, 2)},
                    SeekCase{"Mp4OtherGopAndRate", "a.mp4", h264(30, 60, 12, 2), h264(15, 30, 25, 1)},
                    SeekCase{"MatroskaOtherGopAndRate", "a.mkv", h264(24, 60, 10, 2), h264(30, 75, 40, 0)},
                    SeekCase{"TransportStream", "a.ts", h264(30, 48, 12, 2), h264(30, 48, 12, 2)},
                    SeekCase{"AdaptiveStream", "a.m3u8", h264(25, 100, 25, 2), h264(25, 100, 25, 2)},
                    SeekCase{"LateStart", "a.mkv", h264(25, 48, 12, 2, milliseconds(700)),
                             h264(25, 40, 12, 2, milliseconds(780))},
                    SeekCase{"DepthOfKeyFramesAlone", "a.mkv", h264(25, 48, 12, 2), depth(25, 48)},
                    SeekCase{"ShortDepth", "a.mkv", h264(25, 100, 12, 2), h264(25, 30, 12, 0)},
                    SeekCase{"ColourOfKeyFramesAlone", "a.mkv", color(25, 48), h264(25, 48, 20, 2)}),
    [](const auto& seek) { return std::string(seek.param.name); });

TEST(PairReader, SeeksInTwoFilesAndInNumberedPictures) {
  TemporaryFolder folder;
  makeClip(folder / "c.mkv", {h264(25, 48, 12, 2)});
  makeClip(folder / "%02d.png", {{.codec = "png", .pix_fmt = "gray", .frames = 48, .sample = frameNumber}});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "c.mkv", .depth_url = folder / "%02d.png"}).has_value());
  for (const int k : {30, 5, 47, 0, 24}) {
    ASSERT_TRUE(reader.seek(MediaTime(k * milliseconds(40))).has_value());
    const auto pair = reader.next().value().value();
    EXPECT_EQ(pair.color.pts, MediaTime(k * milliseconds(40)));
    EXPECT_EQ(numberOf(pair.depth), k);
  }
}

// Pictures 10 and 20 are half a second and a second after the ones before.
TEST(PairReader, ASeekIntoALongPictureFindsThatPicture) {
  TemporaryFolder folder;
  ClipTrack slides = color(25, 48);
  slides.time = [](int k) { return milliseconds(40 * k + (k < 10 ? 0 : 460) + (k < 20 ? 0 : 960)); };
  makeClip(folder / "a.mkv", {slides});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  const auto foundAt = [&](int ms) {
    EXPECT_TRUE(reader.seek(MediaTime(milliseconds(ms))).has_value());
    const int first = numberOf(reader.next().value().value().color);
    EXPECT_EQ(numberOf(reader.next().value().value().color), first + 1);
    return first;
  };
  EXPECT_EQ(foundAt(360), 9);
  EXPECT_EQ(foundAt(370), 9);
  EXPECT_EQ(foundAt(850), 10) << "the next is near";
  EXPECT_EQ(foundAt(860), 10);
  EXPECT_EQ(foundAt(1300), 19);
  EXPECT_EQ(foundAt(2000), 19);
}

TEST(PairReader, ASeekCountsNothingAsSkipped) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {h264(25, 48, 12, 0), h264(25, 48, 12, 0)});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  for (const int k : {30, 7, 47}) {
    ASSERT_TRUE(reader.seek(MediaTime(k * milliseconds(40))).has_value());
    ASSERT_TRUE(reader.next().has_value());
  }
  EXPECT_EQ(reader.counters().depth_skipped, 0u);
  EXPECT_EQ(reader.counters().pairs, 3u);
}

}  // namespace
}  // namespace relievo
