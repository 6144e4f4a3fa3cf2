// SPDX-License-Identifier: Apache-2.0
// Two views in the two layers of one HEVC stream: the film of tests/support/film/mv_hevc, whole and with bytes changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr int kCols = 128, kRows = 96, kPictures = 8;
constexpr Duration kPeriod = std::chrono::milliseconds(40);
constexpr std::uint32_t kLeft = 100, kRight = 156;  // Cb

bool decodesBoth() {
  const AVCodec* const codec = avcodec_find_decoder(AV_CODEC_ID_HEVC);
  const AVClass* options = codec->priv_class;
  return options != nullptr && av_opt_find(&options, "view_ids", nullptr, 0, AV_OPT_SEARCH_FAKE_OBJ) != nullptr;
}
#define NEEDS_BOTH_VIEWS() \
  if (!decodesBoth()) GTEST_SKIP() << "this FFmpeg decodes the first view alone; both need FFmpeg 7.1 or later"

std::string theFilm() {
  std::ifstream file(RELIEVO_SOURCE_DIR "/tests/support/film/mv_hevc/two_views.mov", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
std::string with(std::string film, const std::string& old, const std::string& new_bytes) {
  const std::size_t at = film.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return film.replace(at, old.size(), new_bytes);
}
// Boxes that a reader knows nothing of (ISO/IEC 14496-12, 8.1.2).
std::string withoutBox(const std::string& film, const char* name) {
  return with(film, name, "free");
}
// H.265, D.2.1 and G.14.2.3: message 176, four bytes; the left view is 0, the right one 1. Message 177 is another.
const std::string kDisplays("\xb0\x04\x04\x0d\x00\x10", 6), kOtherWay("\xb0\x04\x04\x0a\x80\x10", 6);
std::string withoutDisplays(const std::string& film) {
  return with(film, kDisplays, "\xb1" + kDisplays.substr(1));
}
// Units of a layer in those samples become filler data (type 38) of the base layer.
std::string withoutLayer(std::string film, int layer, const std::vector<int>& samples) {
  std::size_t at = film.find("mdat") + 4;
  const std::size_t end = film.find("moov") - 4;
  for (int sample = -1; at < end;) {
    std::size_t bytes = 0;
    for (int i = 0; i < 4; ++i) bytes = bytes << 8 | static_cast<std::uint8_t>(film[at + i]);
    at += 4;
    const int type = static_cast<std::uint8_t>(film[at]) >> 1;
    const int own = static_cast<std::uint8_t>(film[at + 1]) >> 3;
    if (own == 0 && type < 32) ++sample;
    const bool chosen = std::ranges::find(samples, sample) != samples.end();
    if (own == layer && type < 32 && chosen) film.replace(at, 2, "\x4c\x01");
    at += bytes;
  }
  return film;
}
const std::vector<int> kAllSamples{0, 1, 2, 3, 4, 5, 6, 7};

class MvHevc : public testing::Test {
 protected:
  std::string place(const std::string& bytes) {
    std::ofstream(folder_ / "a.mov", std::ios::binary) << bytes;
    return folder_ / "a.mov";
  }
  void open(const std::string& bytes, DepthFrom depth_from = DepthFrom::Film) {
    const auto opened = reader_.open({.url = place(bytes), .depth_from = depth_from});
    ASSERT_TRUE(opened) << opened.error().message;
  }
  std::vector<FramePair> rest() {
    std::vector<FramePair> pairs;
    for (auto pair = reader_.next(); pair && *pair; pair = reader_.next()) pairs.push_back(std::move(**pair));
    return pairs;
  }

  test::TemporaryFolder folder_;
  PairReader reader_{{.make_source = [](const std::string&) { return makeFfmpegSource(); },
                      .make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); }}};
};

std::uint32_t blueOf(const Frame& frame) {
  return frame.empty() ? 0 : test::sampleAt(frame, 1, 20, 20);
}
// The mean difference between left (c, r) and right (c - shift, r) over eight columns and rows.
double differenceAt(const FramePair& pair, int c0, int r0, int shift) {
  double sum = 0;
  for (int r = r0; r < r0 + 8; ++r) {
    for (int c = c0; c < c0 + 8; ++c) {
      sum += std::abs(static_cast<double>(test::sampleAt(pair.color, 0, c, r)) -
                      test::sampleAt(pair.right, 0, c - shift, r));
    }
  }
  return sum / 64;
}
int disparityAt(const FramePair& pair, int c, int r) {
  int best = 0;
  for (int shift = -8; shift <= 12; ++shift) {
    if (differenceAt(pair, c, r, shift) < differenceAt(pair, c, r, best)) best = shift;
  }
  return best;
}
void expectEyes(const FramePair& pair) {
  EXPECT_NEAR(blueOf(pair.color), kLeft, 4);
  EXPECT_NEAR(blueOf(pair.right), kRight, 4);
  EXPECT_EQ(pair.color.pts, pair.right.pts);
}

TEST_F(MvHevc, EachEyeIsShownItsView) {
  NEEDS_BOTH_VIEWS();
  open(theFilm());
  EXPECT_EQ(reader_.info().packing, Packing::StereoLayers);
  EXPECT_FALSE(reader_.info().has_depth);
  EXPECT_EQ(reader_.info().color_width, kCols);
  ASSERT_EQ(reader_.info().reading.doubts.size(), 1U);
  EXPECT_THAT(reader_.info().reading.doubts[0], HasSubstr("the two layers of its pictures (MV-HEVC) are two views"));
  const auto pairs = rest();
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kPictures));
  for (int k = 0; k < kPictures; ++k) {
    const FramePair& pair = pairs[static_cast<std::size_t>(k)];
    EXPECT_EQ(pair.color.pts, MediaTime(k * kPeriod));
    EXPECT_EQ(pair.color.duration, kPeriod);
    expectEyes(pair);
    EXPECT_EQ(pair.right.height, kRows);
    EXPECT_EQ(disparityAt(pair, 60 + 2 * k, 44), 6) << "the board, picture " << k;
    EXPECT_EQ(disparityAt(pair, 20, 44), 2) << "the wall, picture " << k;
  }
  EXPECT_EQ(reader_.counters().damaged, 0U);
}

TEST_F(MvHevc, TheLeftEyesViewIsLeftWhoeverSaysIt) {
  NEEDS_BOTH_VIEWS();
  const std::string stri("stri\0\0\0\0\3", 9), reversed("stri\0\0\0\0\x0b", 9), hero("hero\0\0\0\0\1", 9),
      right_hero("hero\0\0\0\0\2", 9);
  const std::string silent = withoutDisplays(theFilm());
  const struct {
    const char* said;
    std::string film;
    std::uint32_t shown_left;
  } ways[] = {{"by none", withoutBox(silent, "vexu"), kLeft},
              {"by the boxes", silent, kLeft},
              {"by the order in the boxes", with(silent, stri, reversed), kRight},
              {"by the leading eye", with(silent, hero, right_hero), kRight},
              {"by the pictures, without boxes", withoutBox(with(theFilm(), kDisplays, kOtherWay), "vexu"), kRight},
              {"by the pictures, against the boxes", with(theFilm(), stri, reversed), kLeft}};
  for (const auto& way : ways) {
    open(way.film);
    const auto pairs = rest();
    EXPECT_EQ(pairs.size(), static_cast<std::size_t>(kPictures)) << way.said;
    for (const FramePair& pair : pairs) {
      EXPECT_NEAR(blueOf(pair.color), way.shown_left, 4) << way.said;
      EXPECT_NEAR(blueOf(pair.right), kLeft + kRight - way.shown_left, 4) << way.said;
    }
  }
}

TEST_F(MvHevc, AfterASeekTheEyesAreTheSame) {
  NEEDS_BOTH_VIEWS();
  // The message is with the first key frame alone; the boxes, which say otherwise, are with all.
  open(with(theFilm(), kDisplays, kOtherWay));
  for (const int k : {6, 4, 1, 7, 0}) {
    ASSERT_TRUE(reader_.seek(MediaTime(k * kPeriod)));
    const auto pairs = rest();
    ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kPictures - k));
    EXPECT_EQ(pairs[0].color.pts, MediaTime(k * kPeriod));
    for (const FramePair& pair : pairs) {
      EXPECT_NEAR(blueOf(pair.color), kRight, 4);
      EXPECT_NEAR(blueOf(pair.right), kLeft, 4);
    }
  }
  ASSERT_TRUE(reader_.seek(MediaTime{}, kPeriod));  // key frames alone
  const auto keys = rest();
  ASSERT_EQ(keys.size(), 2U);
  EXPECT_NEAR(blueOf(keys[1].color), kRight, 4);
  EXPECT_EQ(keys[1].right.pts, MediaTime(4 * kPeriod));
}

TEST_F(MvHevc, DepthCanBeMadeFromThem) {
  NEEDS_BOTH_VIEWS();
  open(theFilm(), DepthFrom::Views);
  EXPECT_TRUE(reader_.info().depth_from_views);
  EXPECT_TRUE(reader_.info().reading.doubts.empty());
  for (const FramePair& pair : rest()) expectEyes(pair);
}

TEST_F(MvHevc, BothAreTurnedUpright) {
  NEEDS_BOTH_VIEWS();
  open(theFilm());
  const auto stored = rest();
  const std::string one("\0\1\0\0", 4), minus_one("\xff\xff\0\0", 4), zeros(12, '\0');
  std::string film = theFilm();
  film.replace(film.find(one + zeros + one, film.find("tkhd")), 20, minus_one + zeros + minus_one);  // by 180 degrees
  open(film);
  const auto upright = rest();
  ASSERT_EQ(upright.size(), stored.size());
  expectEyes(upright[3]);
  for (const auto& [c, r] : {std::pair{3, 5}, {100, 70}}) {
    EXPECT_EQ(test::sampleAt(upright[3].color, 0, c, r),
              test::sampleAt(stored[3].color, 0, kCols - 1 - c, kRows - 1 - r));
    EXPECT_EQ(test::sampleAt(upright[3].right, 0, c, r),
              test::sampleAt(stored[3].right, 0, kCols - 1 - c, kRows - 1 - r));
  }
}

// Sample 3, picture 1, is the one of its group that no other refers to.
TEST_F(MvHevc, WhatIsLostOfOnePictureIsLostOfItAlone) {
  NEEDS_BOTH_VIEWS();
  open(withoutLayer(theFilm(), 1, {3}));
  const auto pairs = rest();
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kPictures));
  for (int k = 0; k < kPictures; ++k) {
    const FramePair& pair = pairs[static_cast<std::size_t>(k)];
    EXPECT_EQ(pair.color.pts, MediaTime(k * kPeriod));
    EXPECT_EQ(pair.right.empty(), k == 1);
    EXPECT_NEAR(blueOf(pair.color), kLeft, 4);
    if (k != 1) expectEyes(pair);
  }
  open(withoutLayer(theFilm(), 0, {3}));
  for (const FramePair& pair : rest()) expectEyes(pair);
}

// Hardware that is too slow decodes no picture that no other refers to; x265 marks those of the base layer alone.
TEST_F(MvHevc, WhatIsLeftOutIsLeftOutOfBothEyes) {
  NEEDS_BOTH_VIEWS();
  std::ofstream(folder_ / "a.mov", std::ios::binary) << theFilm();
  const auto source = makeFfmpegSource();
  const auto decoder = makeFfmpegDecoder();
  ASSERT_TRUE(source->open(folder_ / "a.mov"));
  ASSERT_TRUE(decoder->open(source->streams().at(0)));
  ASSERT_TRUE(decoder->leaveOutUnreferenced(true));
  int pictures = 0;
  const auto receiveAll = [&] {
    while (auto frame = decoder->receive().value()) {
      EXPECT_NEAR(blueOf(*frame), kLeft, 4);
      EXPECT_NEAR(blueOf(*frame->right), kRight, 4);
      ++pictures;
    }
  };
  while (auto packet = source->read().value()) {
    while (decoder->feed(*packet).value() == Feed::Full) receiveAll();
  }
  ASSERT_TRUE(decoder->drain());
  receiveAll();
  EXPECT_LT(pictures, kPictures);
  EXPECT_GE(pictures, kPictures - 2);
}

// A tool that knows nothing of layers copied the film.
TEST_F(MvHevc, WhereTheFirstIsLeftAloneItPlaysFlat) {
  open(withoutBox(withoutLayer(theFilm(), 1, kAllSamples), "lhvC"));
  EXPECT_EQ(reader_.info().packing, Packing::Tracks);
  EXPECT_THAT(reader_.info().reading.doubts, testing::ElementsAre(HasSubstr("contains only the first")));
  const auto pairs = rest();
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kPictures));
  for (int k = 0; k < kPictures; ++k) {
    const FramePair& pair = pairs[static_cast<std::size_t>(k)];
    EXPECT_EQ(pair.color.pts, MediaTime(k * kPeriod));
    EXPECT_NEAR(blueOf(pair.color), kLeft, 4);
    EXPECT_TRUE(pair.right.empty());
  }
}

// As everywhere before FFmpeg 7.1.
TEST_F(MvHevc, WhereTheSecondCannotBeDecodedOneLineSaysSo) {
  open(decodesBoth() ? withoutBox(theFilm(), "lhvC") : theFilm());
  EXPECT_EQ(reader_.info().packing, Packing::Tracks);
  EXPECT_THAT(reader_.info().reading.doubts, testing::ElementsAre(HasSubstr("FFmpeg 7.1")));
  const auto pairs = rest();
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kPictures));
  for (const FramePair& pair : pairs) EXPECT_NEAR(blueOf(pair.color), kLeft, 4);
  EXPECT_EQ(reader_.counters().damaged, 0U);
}

TEST_F(MvHevc, OtherFilmsOfThatCodecHaveNoLayers) {
  test::ClipTrack track{.codec = "libx265", .pix_fmt = "yuv420p", .width = 96, .height = 64, .frames = 3};
  track.sample = [](int k, int c, int r, int) { return k > 0 ? 128U : static_cast<std::uint32_t>(60 + c + r); };
  track.options = {{"x265-params", "log-level=error"}};
  test::makeClip(folder_ / "b.mp4", {track});
  ASSERT_TRUE(reader_.open({.url = folder_ / "b.mp4"}));
  EXPECT_EQ(reader_.info().packing, Packing::Tracks);
  EXPECT_THAT(reader_.info().reading.doubts, Not(Contains(HasSubstr("MV-HEVC"))));
  EXPECT_EQ(rest().size(), 3U);
}

TEST_F(MvHevc, NoDamageIsMoreThanDamage) {
  const std::string film = theFilm();
  const std::size_t sets = film.find("hvcC");
  for (std::size_t at = sets; at < sets + 90; at += 7) {
    std::string damaged = film;
    damaged[at] = static_cast<char>(damaged[at] ^ (at % 2 == 0 ? 0x80 : 0x7f));
    if (reader_.open({.url = place(damaged)})) static_cast<void>(rest());
  }
}

}  // namespace
}  // namespace relievo
