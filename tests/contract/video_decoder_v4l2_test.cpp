// SPDX-License-Identifier: Apache-2.0
// Hardware decoders that umockdev simulates as nodes of /dev, with FFmpeg doing the decoding: the contract, pictures
// exact to the bit, and playback when the driver hangs, fails or disappears.
#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "drivers/v4l2/v4l2.h"
#include "tests/contract/decoded_film.h"
#include "tests/contract/video_decoder_contract.h"
#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_codec.h"

namespace relievo {
namespace {

using test::bySoftware;
using test::CodecKind;
using test::feedTo;
using test::Film;
using test::play;
using test::Shown;
using test::shownOf;
using test::UmockdevCodec;

constexpr int kFrames = test::kMovingFrames;
constexpr CodecKind kPlanes{.pictures = V4L2_PIX_FMT_NV12M, .planes = true};

// One simulated machine for the whole contract.
std::unique_ptr<VideoDecoder> decoderOnMockedMachine() {
  static UmockdevCodec codec(umockdev_testbed_new(), 10);
  return makeV4l2M2mDecoder();
}
INSTANTIATE_TEST_SUITE_P(V4l2, VideoDecoderContract,
                         testing::Values(test::FilmBackend{"v4l2", makeFfmpegSource, decoderOnMockedMachine,
                                                           test::encodedFilm, nullptr}),
                         [](const auto& test) { return std::string(test.param.name); });

class V4l2M2m : public test::MockedMachine {
 protected:
  void SetUp() override {
    test::MockedMachine::SetUp();
    if (IsSkipped()) return;
    if (!clip_) {
      clip_.emplace();
      test::makeClip(*clip_ / "film.mkv", {test::movingClip()});
    }
  }
  static void TearDownTestSuite() { clip_.reset(); }
  [[nodiscard]] static std::string clip(const std::string& name = "film.mkv") { return *clip_ / name; }
  [[nodiscard]] static std::string makeClip(const std::string& name, const test::ClipTrack& track) {
    test::makeClip(clip(name), {track});
    return clip(name);
  }
  [[nodiscard]] static std::unique_ptr<VideoDecoder> open(const Film& film) {
    auto decoder = makeV4l2M2mDecoder();
    const auto opened = decoder->open(film.stream);
    EXPECT_TRUE(opened) << opened.error().message;
    return decoder;
  }

 private:
  static inline std::optional<test::TemporaryFolder> clip_;
};

// The buffers are larger than the picture, and their rows are padded.
TEST_F(V4l2M2m, PicturesAreThoseOfSoftwareToTheBitInEveryArrangement) {
  const Film film(clip());
  const auto software = bySoftware(film);
  ASSERT_EQ(software.size(), std::size_t{kFrames});
  const CodecKind kinds[] = {{}, {.pictures = V4L2_PIX_FMT_YUV420, .row_padding = 32}, kPlanes, {.needed = 1}};
  for (const CodecKind& kind : kinds) {
    UmockdevCodec codec(bed_, 10, kind);
    const auto decoder = open(film);
    EXPECT_EQ(play(*decoder, film), software) << kind.pictures;
    EXPECT_EQ(codec.openings(), 1);
    EXPECT_EQ(codec.unknownRequests(), 0);
    EXPECT_EQ(decoder->damaged(), 0u);
    EXPECT_EQ(decoder->description(), "v4l2-m2m, A decoder that is not there at /dev/video10");
  }
}

TEST_F(V4l2M2m, PacketsOfEveryContainerAndCodecAreDecoded) {
  test::ClipTrack hevc = test::movingClip();
  hevc.codec = "libx265";
  hevc.options = {{"x265-params", "log-level=none"}};
  for (const char* name : {"film.mp4", "film.ts"}) {
    UmockdevCodec codec(bed_, 10);
    const Film film(makeClip(name, test::movingClip()));
    EXPECT_EQ(play(*open(film), film), bySoftware(film)) << name;
  }
  for (const char* name : {"hevc.mkv", "hevc.ts"}) {
    UmockdevCodec codec(bed_, 10, {.packets = V4L2_PIX_FMT_HEVC});
    const Film film(makeClip(name, hevc));
    EXPECT_EQ(play(*open(film), film), bySoftware(film)) << name;
  }
}

TEST_F(V4l2M2m, ColoursAreAsTheStreamSaysThem) {
  UmockdevCodec codec(bed_, 10);
  test::ClipTrack track = test::movingClip();
  track.range = ColorRange::Full;
  track.pix_fmt = "yuvj420p";
  track.sample_width = 4, track.sample_height = 3;
  const Film film(makeClip("full.mkv", track));
  (void)play(*open(film), film, [](const Frame& frame) {
    EXPECT_EQ(frame.range, ColorRange::Full);
    EXPECT_DOUBLE_EQ(frame.sample_aspect, 4.0 / 3);
  });
}

TEST_F(V4l2M2m, ASeekForgetsWhatWasInsideAndGoesOnExactly) {
  UmockdevCodec codec(bed_, 10);
  const Film film(clip());
  const auto decoder = open(film);
  expectSeeksToGoOnExactly(*decoder, film, 30);
  EXPECT_EQ(codec.openings(), 1);
}

TEST_F(V4l2M2m, ASeekIntoAnOpenGroupDamagesNothing) {
  UmockdevCodec codec(bed_, 10, {.packets = V4L2_PIX_FMT_HEVC});
  test::ClipTrack hevc = test::movingClip();
  hevc.codec = "libx265";
  hevc.options = {{"x265-params", "log-level=none"}};
  const Film film(makeClip("open.mkv", hevc));
  const auto decoder = open(film);
  expectASeekIntoAnOpenGroupToDamageNothing(*decoder, film);
}

TEST_F(V4l2M2m, DamageCountsAfterTheTimesJumpBack) {
  UmockdevCodec codec(bed_, 10);
  const Film film(clip());
  const auto decoder = open(film);
  expectDamageToCountAfterTheTimesJumpBack(*decoder, film);
}

TEST_F(V4l2M2m, DrainsAgainAndAgain) {
  UmockdevCodec codec(bed_, 10);
  const Film film(clip());
  const auto decoder = open(film);
  expectKeyFramesDrainedOneByOne(*decoder, film);
  EXPECT_EQ(codec.drains(), 3);
}

TEST_F(V4l2M2m, TheResolutionChangesInMidStream) {
  (void)makeClip("a.ts", test::movingClip());
  test::ClipTrack second = test::movingClip(64, 160);
  second.start = std::chrono::seconds(5);
  (void)makeClip("b.ts", second);
  for (const char* const name : {"a.ts", "b.ts", "a.ts"}) {
    std::ofstream(clip("changing.ts"), std::ios::binary | std::ios::app) << std::ifstream(clip(name)).rdbuf();
  }
  const Film film(clip("changing.ts"));
  const auto software = bySoftware(film);
  ASSERT_EQ(software.size(), std::size_t{3 * kFrames});
  for (const CodecKind& kind : {CodecKind{}, kPlanes}) {
    UmockdevCodec codec(bed_, 10, kind);
    const auto decoder = open(film);
    std::vector<Frame> held;  // across the changes
    EXPECT_EQ(play(*decoder, film,
                   [&](const Frame& frame) {
                     if (held.size() < 6 || frame.width != held.back().width) held.push_back(frame);
                   }),
              software);
    EXPECT_EQ(codec.openings(), 1);
    for (const Frame& frame : held) {
      EXPECT_EQ(std::count(software.begin(), software.end(), shownOf(frame)), 1) << "a held picture changed";
    }
  }
}

// A seek during a change of resolution.
TEST_F(V4l2M2m, ASeekMayLeadToAnotherResolution) {
  (void)makeClip("a.ts", test::movingClip());
  test::ClipTrack second = test::movingClip(64, 160);
  second.start = std::chrono::seconds(5);
  (void)makeClip("b.ts", second);
  std::ofstream(clip("two.ts"), std::ios::binary)
      << std::ifstream(clip("a.ts")).rdbuf() << std::ifstream(clip("b.ts")).rdbuf();
  const Film film(clip("two.ts"));
  const auto software = bySoftware(film);
  UmockdevCodec codec(bed_, 10);
  const auto decoder = open(film);
  for (std::size_t stop = 71; stop < 80; stop += 2) {
    std::vector<Shown> some, rest;
    ASSERT_TRUE(feedTo(*decoder, film, 48, stop, some));
    ASSERT_TRUE(decoder->flush());
    ASSERT_TRUE(feedTo(*decoder, film, 0, 20, some));
    ASSERT_TRUE(decoder->flush());
    ASSERT_TRUE(feedTo(*decoder, film, 120, 144, rest));
    EXPECT_EQ(rest, std::vector(software.begin() + 120, software.end())) << stop;
    ASSERT_TRUE(decoder->flush());
  }
}

// Beyond the buffers that the driver can spare, pictures are copies, and decoding continues.
TEST_F(V4l2M2m, AnyNumberOfPicturesMayBeHeldAndTheDriverNeverStarves) {
  UmockdevCodec codec(bed_, 10, {.exports = true});
  const Film film(clip());
  const auto software = bySoftware(film);
  const auto decoder = open(film);
  std::vector<Frame> held;
  const auto shown = play(*decoder, film, [&](const Frame& frame) {
    held.push_back(frame);
    if (held.size() > 64) held.erase(held.begin() + 20);
  });
  EXPECT_EQ(shown, software);
  EXPECT_GE(codec.empty(), 3) << "of the four that it needs, but for the one that ends it";
  const auto exported = std::count_if(held.begin(), held.end(), [](auto& f) { return f.dma_bufs[0].fd >= 0; });
  EXPECT_GT(exported, 4);
  EXPECT_LT(exported, 20);
  const Frame& first = held.front();
  EXPECT_EQ(first.dma_bufs[1].fd, first.dma_bufs[0].fd);
  EXPECT_EQ(first.dma_bufs[1].offset_bytes, first.planes[0].stride_bytes * 80) << "the coded height";
  decoder->close();
  EXPECT_GE(::fcntl(first.dma_bufs[0].fd, F_GETFD), 0);
  for (const Frame& frame : held) EXPECT_EQ(std::count(software.begin(), software.end(), shownOf(frame)), 1);
}

TEST_F(V4l2M2m, AHungDriverIsFoundOutAndAGoneOneToo) {
  const Film film(clip());
  for (const bool gone : {false, true}) {
    UmockdevCodec codec(bed_, 10);
    if (gone) codec.unplugAfter(50);
    else codec.hangAfter(50, 1);
    const auto decoder = open(film);
    std::vector<Shown> shown;
    const auto played = feedTo(*decoder, film, 0, film.packets.size(), shown);
    EXPECT_EQ(test::answerOf(played), gone ? ErrorCode::Lost : ErrorCode::Timeout);
    EXPECT_GT(shown.size(), 30u);
    decoder->close();
    if (gone) continue;
    ASSERT_TRUE(decoder->open(film.stream)) << "opened again, it decodes again";
    EXPECT_EQ(play(*decoder, film), bySoftware(film));
  }
}

struct Trouble {
  const char* name;
  std::function<void(UmockdevCodec&)> befalls;
  int openings;
  std::vector<std::string> told;
  bool in_software;
};

// With some pictures always held, as a player does.
TEST_F(V4l2M2m, TheFilmGoesOnWhereItWasWithoutAPictureLostOrTwice) {
  const Film film(clip());
  const auto software = bySoftware(film);
  const std::string anew = "the decoder was restarted at the same picture",
                    other = "another decoder, in software, continues at the same picture";
  const Trouble troubles[] = {
      {"hangs once", [](auto& codec) { codec.hangAfter(60, 1); }, 2, {anew}, false},
      {"hangs twice", [](auto& codec) { codec.hangAfter(30, 2); }, 2, {anew, other}, true},
      {"hangs at once", [](auto& codec) { codec.hangAfter(0, 2); }, 2, {other}, true},  // the last restart is reported
      {"is gone", [](auto& codec) { codec.unplugAfter(60); }, 1, {other}, true},
  };
  for (const Trouble& trouble : troubles) {
    UmockdevCodec codec(bed_, 10);
    trouble.befalls(codec);
    const auto decoder = test::openWithFailover(makeV4l2M2mDecoder(), film);
    EXPECT_EQ(decoder->description(), "v4l2-m2m, A decoder that is not there at /dev/video10");
    std::vector<std::string> told;
    std::deque<Frame> held;
    const auto take = [&](const Frame& frame) {
      if (const auto restart = decoder->takeRestart()) told.emplace_back(restart->done);
      held.push_back(frame);
      if (held.size() > 8) held.pop_front();
    };
    EXPECT_EQ(play(*decoder, film, take), software) << trouble.name;
    EXPECT_EQ(codec.openings(), trouble.openings) << trouble.name;
    EXPECT_EQ(told, trouble.told) << trouble.name;
    EXPECT_EQ(decoder->description().starts_with("ffmpeg; no better decoder: the video hardware"), trouble.in_software)
        << decoder->description();
    EXPECT_EQ(decoder->damaged(), 0u);
  }
}

}  // namespace
}  // namespace relievo
