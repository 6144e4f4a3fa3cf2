// SPDX-License-Identifier: Apache-2.0
// GStreamer's elements, FFmpeg's among them: the contract, pictures exact to the bit, and playback when an element
// hangs, fails or is gone.
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "drivers/gstreamer/gstreamer.h"
#include "tests/contract/decoded_film.h"
#include "tests/contract/video_decoder_contract.h"
#include "tests/support/device/gstreamer_element.h"

namespace relievo {
namespace {

using test::bySoftware;
using test::feedTo;
using test::Film;
using test::GstreamerElement;
using test::play;
using test::Shown;
using test::shownOf;
using Fault = GstreamerElement::Fault;

constexpr int kFrames = test::kMovingFrames;

const bool kPrepared = [] {
  test::keepGstreamerListAt(RELIEVO_BIN_DIR "/../tests/gstreamer.list");
  return true;
}();

std::unique_ptr<VideoDecoder> softwareElement() {
  return makeGstreamerDecoder("avdec_h264");
}
std::unique_ptr<VideoDecoder> elementByRank() {
  static GstreamerElement element;
  return makeGstreamerDecoder();
}
INSTANTIATE_TEST_SUITE_P(
    Gstreamer, VideoDecoderContract,
    testing::Values(test::FilmBackend{"software", makeFfmpegSource, softwareElement, test::encodedFilm, nullptr},
                    test::FilmBackend{"hardware", makeFfmpegSource, elementByRank, test::encodedFilm, nullptr}),
    [](const auto& test) { return std::string(test.param.name); });

test::ClipTrack movingClip(const std::string& codec = "libx264", const std::string& format = "yuv420p") {
  test::ClipTrack track = test::movingClip();
  track.codec = codec;
  track.pix_fmt = format;
  if (codec.starts_with("libvpx")) track.b_frames = 0;
  if (codec == "libx265") track.options = {{"x265-params", "log-level=none"}};
  return track;
}

class Gstreamer : public testing::Test {
 protected:
  void SetUp() override {
    if (clip_) return;
    clip_.emplace();
    test::makeClip(*clip_ / "film.mkv", {movingClip()});
  }
  static void TearDownTestSuite() { clip_.reset(); }
  [[nodiscard]] static std::string clip(const std::string& name = "film.mkv") { return *clip_ / name; }
  [[nodiscard]] static std::string makeClip(const std::string& name, const test::ClipTrack& track) {
    test::makeClip(clip(name), {track});
    return clip(name);
  }
  [[nodiscard]] static std::unique_ptr<VideoDecoder> open(const Film& film, const std::string& element = "") {
    auto decoder = makeGstreamerDecoder(element);
    const auto opened = decoder->open(film.stream);
    EXPECT_TRUE(opened) << opened.error().message;
    return decoder;
  }

 private:
  static inline std::optional<test::TemporaryFolder> clip_;
};

struct Kind {
  const char *name, *element, *codec, *format;
};

TEST_F(Gstreamer, PicturesAreThoseOfFfmpegToTheBitInEveryContainerCodecAndFormat) {
  const Kind kinds[] = {
      {"a.mkv", "avdec_h264", "libx264", "yuv420p"},         {"a.mp4", "avdec_h264", "libx264", "yuv420p"},
      {"a.ts", "avdec_h264", "libx264", "yuv420p"},          {"gray.mkv", "avdec_h264", "libx264", "gray"},
      {"444.mkv", "avdec_h264", "libx264", "yuv444p"},       {"10.mkv", "avdec_h264", "libx264", "yuv420p10le"},
      {"422.mkv", "avdec_h264", "libx264", "yuv422p10"},     {"hevc.mkv", "avdec_h265", "libx265", "yuv420p"},
      {"hevc.ts", "avdec_h265", "libx265", "yuv420p10"},     {"h444.mkv", "avdec_h265", "libx265", "yuv444p10"},
      {"8.webm", "avdec_vp8", "libvpx", "yuv420p"},          {"9.webm", "avdec_vp9", "libvpx-vp9", "yuv420p"},
      {"m.ts", "avdec_mpeg2video", "mpeg2video", "yuv420p"},
  };
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.name);
    const Film film(makeClip(kind.name, movingClip(kind.codec, kind.format)));
    const auto reference = makeFfmpegDecoder();
    ASSERT_TRUE(reference->open(film.stream));
    std::vector<Frame> frames;
    const auto software = play(*reference, film, [&](const Frame& frame) { frames.push_back(frame); });
    ASSERT_EQ(software.size(), std::size_t{kFrames});
    const auto decoder = open(film, kind.element);
    EXPECT_EQ(decoder->description(), std::string("gstreamer, ") + kind.element);
    EXPECT_FALSE(decoder->capabilities().hardware);
    EXPECT_EQ(play(*decoder, film,
                   [&](const Frame& frame) {
                     const Frame& same = frames.front();
                     EXPECT_EQ(frame.model, same.model);
                     EXPECT_EQ(frame.range, same.model == ColorModel::Gray ? ColorRange::Full : film.stream.range);
                     EXPECT_EQ(frame.components[0].bits, same.components[0].bits);
                     EXPECT_EQ(frame.interlaced, same.interlaced);
                   }),
              software);
    EXPECT_EQ(decoder->damaged(), 0u);
  }
}

TEST_F(Gstreamer, ColoursAreAsTheStreamSaysThem) {
  test::ClipTrack track = movingClip("libx264", "yuvj420p");
  track.range = ColorRange::Full;
  track.primaries = kBt709;
  track.sample_width = 4, track.sample_height = 3;
  const Film film(makeClip("full.mkv", track));
  (void)play(*open(film, "avdec_h264"), film, [](const Frame& frame) {
    EXPECT_EQ(frame.range, ColorRange::Full);
    EXPECT_EQ(frame.primaries, kBt709);
    EXPECT_DOUBLE_EQ(frame.sample_aspect, 4.0 / 3);
  });
}

TEST_F(Gstreamer, TimesMayBeNegativeAndJumpBack) {
  Film film(clip());
  for (Packet& packet : film.packets) {
    packet.pts = *packet.pts - std::chrono::seconds(1);
    packet.dts.reset();
  }
  const auto shown = play(*open(film, "avdec_h264"), film);
  ASSERT_EQ(shown.size(), std::size_t{kFrames});
  EXPECT_EQ(shown.front().pts, MediaTime(-std::chrono::seconds(1)));
  expectDamageToCountAfterTheTimesJumpBack(*open(film, "avdec_h264"), film);
}

TEST_F(Gstreamer, ASeekForgetsWhatWasInsideAndGoesOnExactly) {
  GstreamerElement element;
  const Film film(clip());
  const auto decoder = open(film);
  expectSeeksToGoOnExactly(*decoder, film, 40);
}

TEST_F(Gstreamer, ASeekIntoAnOpenGroupDamagesNothing) {
  const Film film(makeClip("open.mkv", movingClip("libx265")));
  const auto decoder = open(film, "avdec_h265");
  // GStreamer 1.26's element takes the second picture for the "ghost" of one that cannot be decoded.
  expectASeekIntoAnOpenGroupToDamageNothing(*decoder, film, 1);
}

TEST_F(Gstreamer, DrainsAgainAndAgain) {
  const Film film(clip());
  const auto decoder = open(film, "avdec_h264");
  expectKeyFramesDrainedOneByOne(*decoder, film);
}

TEST_F(Gstreamer, TheResolutionChangesInMidStream) {
  (void)makeClip("a.ts", movingClip());
  test::ClipTrack second = movingClip();
  second.width = 64, second.height = 160;
  second.start = std::chrono::seconds(5);
  (void)makeClip("b.ts", second);
  for (const char* const name : {"a.ts", "b.ts", "a.ts"}) {
    std::ofstream(clip("changing.ts"), std::ios::binary | std::ios::app) << std::ifstream(clip(name)).rdbuf();
  }
  const Film film(clip("changing.ts"));
  const auto software = bySoftware(film);
  ASSERT_EQ(software.size(), std::size_t{3 * kFrames});
  std::vector<Frame> held;  // across the changes
  EXPECT_EQ(play(*open(film, "avdec_h264"), film,
                 [&](const Frame& frame) {
                   if (held.size() < 6 || frame.width != held.back().width) held.push_back(frame);
                 }),
            software);
  for (const Frame& frame : held) {
    EXPECT_EQ(std::count(software.begin(), software.end(), shownOf(frame)), 1) << "a held picture changed";
  }
}

TEST_F(Gstreamer, DmaBufsAreKeptAndBeyondTheElementsBuffersPicturesAreCopies) {
  GstreamerElement element;
  element.useDmaBufs();
  const Film film(clip());
  const auto software = bySoftware(film);
  const auto decoder = open(film);
  std::vector<Frame> held;
  EXPECT_EQ(play(*decoder, film,
                 [&](const Frame& frame) {
                   held.push_back(frame);
                   if (held.size() > 30) held.erase(held.begin() + 20);
                 }),
            software);
  const auto own = std::count_if(held.begin(), held.end(), [](auto& f) { return f.dma_bufs[0].fd >= 0; });
  EXPECT_EQ(own, 8);
  const Frame& first = held.front();
  EXPECT_EQ(first.dma_bufs[2].fd, first.dma_bufs[0].fd);
  EXPECT_EQ(first.planes[2].data - first.planes[0].data,
            std::ptrdiff_t{first.dma_bufs[2].offset_bytes} - std::ptrdiff_t{first.dma_bufs[0].offset_bytes});
  std::vector<std::uint8_t> row(100);
  ASSERT_EQ(::pread(first.dma_bufs[1].fd, row.data(), 50, first.dma_bufs[1].offset_bytes), 50);
  EXPECT_TRUE(std::equal(row.begin(), row.begin() + 50, first.planes[1].data)) << "the same samples by the descriptor";
  decoder->close();
  for (const Frame& frame : held) EXPECT_EQ(std::count(software.begin(), software.end(), shownOf(frame)), 1);
}

TEST_F(Gstreamer, AHungElementIsFoundOutAndAFailingAndAGoneOneToo) {
  const Film film(clip());
  struct Case {
    Fault fault;
    ErrorCode code;
  };
  for (const auto [fault, code] :
       {Case{Fault::Hangs, ErrorCode::Lost}, {Fault::Fails, ErrorCode::Io}, {Fault::IsGone, ErrorCode::Lost}}) {
    GstreamerElement element;
    element.befall(fault, 50, 1);
    const auto decoder = open(film);
    std::vector<Shown> shown;
    EXPECT_EQ(test::answerOf(feedTo(*decoder, film, 0, film.packets.size(), shown)), code);
    EXPECT_GT(shown.size(), 30u);
    decoder->close();
    ASSERT_TRUE(decoder->open(film.stream)) << "opened again, it decodes again";
    EXPECT_EQ(play(*decoder, film), bySoftware(film));
  }
}

TEST_F(Gstreamer, AnElementThatHangsStopsNeitherASeekNorTheEnd) {
  const Film film(clip());
  GstreamerElement element;
  const auto decoder = makeGstreamerDecoder();
  const auto hang = [&] {
    element.befall(Fault::Hangs, 0, 1);
    ASSERT_TRUE(decoder->open(film.stream));
    for (std::size_t i = 0; i < 15; ++i) ASSERT_EQ(decoder->feed(film.packets[i]).value(), Feed::Accepted);
    element.awaitHang();
  };
  hang();
  EXPECT_EQ(test::answerOf(decoder->flush()), ErrorCode::Lost);
  decoder->close();
  hang();
  decoder->close();
  EXPECT_EQ(decoder->state(), VideoDecoder::State::Closed);
}

struct Trouble {
  const char* name;
  Fault fault;
  int after, times, instances;
  std::vector<std::string> told;
  bool in_software;
};

// With some pictures always held, as a player does.
TEST_F(Gstreamer, TheFilmGoesOnWhereItWasWithoutAPictureLostOrTwice) {
  const Film film(clip());
  const auto software = bySoftware(film);
  const std::string anew = "the decoder was restarted at the same picture",
                    other = "another decoder, in software, continues at the same picture";
  const Trouble troubles[] = {
      {"hangs", Fault::Hangs, 60, 1, 1, {other}, true},
      {"hangs at once", Fault::Hangs, 0, 1, 1, {other}, true},
      {"fails once", Fault::Fails, 60, 1, 2, {anew}, false},
      {"fails twice", Fault::Fails, 30, 2, 2, {other}, true},  // the last restart is reported
      {"is gone", Fault::IsGone, 60, 1, 1, {other}, true},
  };
  for (const Trouble& trouble : troubles) {
    SCOPED_TRACE(trouble.name);
    GstreamerElement element;
    element.befall(trouble.fault, trouble.after, trouble.times);
    const auto decoder = test::openWithFailover(makeGstreamerDecoder(), film);
    EXPECT_EQ(decoder->description(), std::string("gstreamer, ") + GstreamerElement::kName);
    std::vector<std::string> told;
    std::vector<Frame> held;
    EXPECT_EQ(play(*decoder, film,
                   [&](const Frame& frame) {
                     held.push_back(frame);
                     if (held.size() > 5) held.erase(held.begin());
                     if (const auto restart = decoder->takeRestart()) told.emplace_back(restart->done);
                   }),
              software);
    EXPECT_EQ(told, trouble.told);
    EXPECT_EQ(element.instances(), trouble.instances);
    EXPECT_EQ(decoder->description().starts_with("ffmpeg; no better decoder: the GStreamer element"),
              trouble.in_software)
        << decoder->description();
  }
}

int openFiles() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<int>(std::distance(begin(all), end(all)));
}

TEST_F(Gstreamer, AThousandOpeningsLeaveNothingBehind) {
  GstreamerElement element;
  element.useDmaBufs();
  const Film film(clip());
  const auto once = [&](int i) {
    const auto decoder = open(film);
    for (std::size_t p = 0; p < 6; ++p) ASSERT_EQ(decoder->feed(film.packets[p]).value(), Feed::Accepted);
    EXPECT_TRUE(i % 3 != 0 || decoder->drain());
    (void)decoder->receive();
    EXPECT_TRUE(i % 3 != 1 || decoder->flush());
  };
  // GStreamer gives up its last reference on a thread of its own.
  const auto settled = [&](int wanted) {
    for (int i = 0; i < 500 && element.live() > wanted; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return element.live();
  };
  for (int i = 0; i < 5; ++i) once(i);
  EXPECT_EQ(settled(0), 0);
  const int files = openFiles();
  for (int i = 0; i < 1000; ++i) once(i);
  EXPECT_EQ(element.instances(), 1005 + 1005 / 3);
  EXPECT_EQ(settled(0), 0) << "elements and pictures";
  EXPECT_EQ(openFiles(), files);
  for (const Packet& packet : film.packets) EXPECT_EQ(packet.owner.use_count(), 1);
}

}  // namespace
}  // namespace relievo
