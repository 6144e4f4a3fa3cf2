// SPDX-License-Identifier: Apache-2.0
// Photos of more samples than a film's picture may have, with depth beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/scene_film.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::openFilm;
using test::TemporaryFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr int kWide = 5120, kHigh = 3328;  // 17.0 million samples

std::uint32_t mmAt(int c, int r) {
  return static_cast<std::uint32_t>(1000 + c / 8 + r / 4);
}

void write(const std::string& path, const char* codec, const char* format, int cols, int rows,
           std::uint32_t (*sample)(int, int, int, int)) {
  makeClip(path, {ClipTrack{.codec = codec,
                            .pix_fmt = format,
                            .width = cols,
                            .height = rows,
                            .frames = 1,
                            .range = ColorRange::Full,
                            .sample = sample}});
}

TEST(LargePhoto, EverySecondRowAndColumnIsReadOfColourAndDepth) {
  const TemporaryFolder folder;
  write(folder / "a.jpg", "mjpeg", "yuvj420p", kWide, kHigh,
        [](int k, int c, int r, int) { return k == 0 ? static_cast<std::uint32_t>(c / 32 + r / 64) : 128u; });
  write(folder / "a_depth.png", "png", "gray16be", kWide, kHigh, [](int, int c, int r, int) { return mmAt(c, r); });
  const test::OpenedFilm film = openFilm({.url = folder / "a.jpg"});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.pair.color.width, kWide / 2);
  EXPECT_EQ(film.pair.depth.width, kWide / 2);
  EXPECT_EQ(film.info.color_width, kWide / 2);
  EXPECT_NEAR(test::sampleAt(film.pair.color, 0, 2400, 1600), 4800 / 32 + 3200 / 64, 3);
  EXPECT_NEAR(film.distanceAt(2400, 1600), mmAt(4800, 3200), .5);
  EXPECT_NEAR(film.distanceAt(1, 1), mmAt(2, 2), .5);
  EXPECT_THAT(film.info.notes, Contains(HasSubstr("a photo of 5120 x 3328")));
}

std::string refusalOf(const std::string& url) {
  PairReader reader({.make_source = [](const std::string& file) { return drivers::makeMediaSource(file); },
                     .make_decoder = [](const StreamInfo& stream) { return drivers::makeSoftwareDecoder(stream); },
                     .read_text = {}});
  const auto opened = reader.open({.url = url});
  return opened ? "" : opened.error().message;
}

TEST(LargePhoto, OfOver50MegapixelsIsRefused) {
  const TemporaryFolder folder;
  makeClip(folder / "a.png", {{.codec = "png", .pix_fmt = "gray", .width = 8192, .height = 6208, .frames = 1}});
  EXPECT_THAT(refusalOf(folder / "a.png"), AllOf(HasSubstr("50 million"), HasSubstr("300 MB decoded")));
}

TEST(LargePhoto, AFilmCodedAsPhotosAreIsNone) {
  const TemporaryFolder folder;
  makeClip(folder / "a.avi", {{.codec = "mjpeg", .pix_fmt = "yuvj420p", .width = kWide, .height = kHigh, .frames = 1}});
  EXPECT_THAT(refusalOf(folder / "a.avi"), HasSubstr("16.7 million"));
}

}  // namespace
}  // namespace relievo
