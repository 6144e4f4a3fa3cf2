// SPDX-License-Identifier: Apache-2.0
// The FFmpeg decoder: references to pictures, colour signalling, damage, seeks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/pictures/picture.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/huge_page_marks.h"
#include "tests/unit/drivers/ffmpeg/decoded_clip.h"

namespace relievo::test {
namespace {

TEST(FfmpegDecoder, PicturesAreTheDecodersOwnMemory) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 6}});
  Clip clip(folder / "a.mkv");
  ASSERT_TRUE(clip.decoder->open(clip.stream()).has_value());
  std::optional<Frame> frame;
  for (std::size_t i = 0; !frame; ++i) {
    ASSERT_EQ(clip.decoder->feed(clip.packets.at(i)).value(), Feed::Accepted);
    frame = clip.decoder->receive().value();
  }
  // The decoder still uses it as a reference picture, so it has several owners; a copy would have one.
  const auto* picture = static_cast<const AVFrame*>(frame->owner.get());
  EXPECT_EQ(frame->planes[0].data, picture->data[0]);
  EXPECT_EQ(frame->planes[0].stride_bytes, picture->linesize[0]);
  EXPECT_GT(av_buffer_get_ref_count(picture->buf[0]), 1);

  const Frame copy = *frame;
  EXPECT_EQ(copy.planes[0].data, frame->planes[0].data);
  EXPECT_EQ(copy.owner.use_count(), 2);
}

TEST(FfmpegDecoder, HeldPicturesStayIntactWhenTheDecoderHasGone) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.frames = 24, .sample = scattered}});
  std::vector<Frame> held;
  int allowed = 0;
  {
    Clip clip(folder / "a.mkv");
    held = clip.decode();
    allowed = clip.decoder->capabilities().max_held_frames;
  }
  ASSERT_EQ(held.size(), 24u);
  EXPECT_GE(allowed, 24);
  std::set<const std::uint8_t*> places;
  for (int k = 0; k < 24; ++k) {
    const Frame& frame = held[static_cast<std::size_t>(k)];
    EXPECT_EQ(wrongSamples(frame, k), 0) << "frame " << k;
    places.insert(frame.planes[0].data);
  }
  EXPECT_EQ(places.size(), 24u);
}

// Of an odd size, so that rows end in padding.
TEST(FfmpegDecoder, BigPicturesLieOnHugePages) {
  if (!marksHugePages()) GTEST_SKIP() << "this kernel has no huge pages to ask for";
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.width = 2051, .height = 1201, .frames = 2, .sample = scattered}});
  const auto frames = Clip(folder / "a.mkv").decode();
  ASSERT_EQ(frames.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    EXPECT_EQ(wrongSamples(frame, k), 0) << "frame " << k;
    EXPECT_TRUE(isMarkedForHugePages(frame.planes[0].data)) << "frame " << k;
    EXPECT_TRUE(isMarkedForHugePages(frame.planes[0].data + 1200 * frame.planes[0].stride_bytes)) << "frame " << k;
  }
}

// 4:0:0 as an encoder writes it: one plane; libavcodec yields 4:2:0 of full range with flat chroma.
TEST(FfmpegDecoder, GrayH264IsReadFromItsLumaPlaneAndIsFullRange) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.codec = "libx264",
                                        .pix_fmt = "gray",
                                        .frames = 3,
                                        .range = ColorRange::Full,
                                        .sample = scattered,
                                        .options = {{"qp", "0"}}}});
  Clip clip(folder / "a.mkv");
  const auto frames = clip.decode();
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[1].range, ColorRange::Full);
  EXPECT_EQ(frames[1].components[0].bits, 8);
  for (int r = 0; r < 48; ++r) {
    for (int c = 0; c < 64; ++c) ASSERT_EQ(sampleAt(frames[1], 0, c, r), scattered(0, c, r, 1) & 0xff);
  }
}

TEST(FfmpegDecoder, RangeIsWhatTheStreamSignalsAndFullForGrayThatSaysNothing) {
  TemporaryFolder folder;
  const auto rangeOf = [&](const char* codec, const char* pix_fmt, ColorRange signalled, const char* file = "a.mkv") {
    makeClip(folder / file, {ClipTrack{.codec = codec, .pix_fmt = pix_fmt, .frames = 1, .range = signalled}});
    return Clip(folder / file).decode().at(0).range;
  };
  EXPECT_EQ(rangeOf("ffv1", "gray", ColorRange::Unspecified, "a.avi"), ColorRange::Full);
  EXPECT_EQ(rangeOf("ffv1", "gray", ColorRange::Limited), ColorRange::Limited);
  EXPECT_EQ(rangeOf("ffv1", "yuv420p", ColorRange::Unspecified, "a.avi"), ColorRange::Unspecified);
  EXPECT_EQ(rangeOf("libx264", "yuv420p", ColorRange::Limited), ColorRange::Limited);
  EXPECT_EQ(rangeOf("libx264", "yuv420p", ColorRange::Full), ColorRange::Full);
  EXPECT_EQ(rangeOf("mjpeg", "yuvj420p", ColorRange::Unspecified, "a.avi"), ColorRange::Full);
}

TEST(FfmpegDecoder, SampleAspectAndDurationAreTold) {
  TemporaryFolder folder;
  makeClip(folder / "a.mp4", {ClipTrack{.codec = "libx264",
                                        .pix_fmt = "yuv420p",
                                        .fps_num = 25,
                                        .frames = 3,
                                        .sample_width = 9,
                                        .sample_height = 16}});
  Clip clip(folder / "a.mp4");
  const auto frames = clip.decode();
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_DOUBLE_EQ(frames[0].sample_aspect, 9.0 / 16.0);
  EXPECT_EQ(frames[0].duration, std::chrono::milliseconds(40));
}

// A stream from another back end's source: with a codec name, parameter sets, and packets in foreign memory.
TEST(FfmpegDecoder, DecodesStreamsThatAnotherSourceDescribes) {
  TemporaryFolder folder;
  makeClip(folder / "a.mp4", {ClipTrack{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 10}});
  Clip clip(folder / "a.mp4");
  const auto expected = clip.decode();

  Clip foreign(folder / "a.mp4");
  StreamInfo stream = foreign.stream();
  ASSERT_FALSE(stream.extradata.empty());
  stream.native = std::make_shared<int>(42);
  for (Packet& packet : foreign.packets) {
    const auto bytes = std::make_shared<std::vector<std::uint8_t>>(packet.data, packet.data + packet.bytes);
    packet.data = bytes->data();
    packet.owner = bytes;
  }
  ASSERT_TRUE(foreign.decoder->open(stream).has_value());
  const auto frames = foreign.decodeOpen();
  ASSERT_EQ(frames.size(), expected.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].pts, expected[k].pts);
    EXPECT_EQ(sampleAt(frames[k], 0, 17, 23), sampleAt(expected[k], 0, 17, 23));
  }
}

TEST(FfmpegDecoder, RefusesACodecThatItDoesNotKnow) {
  const auto decoder = makeFfmpegDecoder();
  const auto opened = decoder->open(StreamInfo{.kind = StreamKind::Video, .codec = "no-such-codec"});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
}

// Overwrites the middle of a packet.
void damage(Packet& packet) {
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(packet.data, packet.data + packet.bytes);
  for (std::size_t i = bytes->size() / 3; i < bytes->size(); ++i) (*bytes)[i] ^= static_cast<std::uint8_t>(37 * i + 11);
  packet.data = bytes->data();
  packet.owner = bytes;
}

// Each codec's own way of noticing: FFV1 by check sums, H.264 by its grammar, PNG by its format.
TEST(FfmpegDecoder, DamagedPacketsAreDroppedAndCounted) {
  TemporaryFolder folder;
  struct Case {
    ClipTrack track;
    const char* file;
  };
  const Case cases[] = {
      {{.codec = "ffv1", .frames = 10, .gop = 1, .sample = scattered, .options = {{"level", "3"}, {"slicecrc", "1"}}},
       "ffv1.mkv"},
      {{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 10, .gop = 1, .sample = scattered}, "h264.mkv"},
      {{.codec = "png", .pix_fmt = "rgb24", .frames = 10, .sample = scattered}, "png.mkv"},
  };
  for (const Case& c : cases) {
    makeClip(folder / c.file, {c.track});
    Clip clip(folder / c.file);
    ASSERT_EQ(clip.packets.size(), 10u);
    damage(clip.packets[4]);
    const auto frames = clip.decode();
    EXPECT_EQ(clip.decoder->damaged(), 1u) << c.file;
    ASSERT_EQ(frames.size(), 9u) << c.file;
    for (const Frame& frame : frames) {
      EXPECT_GT(std::chrono::abs(frame.pts - clip.packets[4].pts.value()), std::chrono::milliseconds(1)) << c.file;
    }
  }
}

TEST(FfmpegDecoder, PicturesWithoutTimesAreNumberedByTheFramePeriod) {
  TemporaryFolder folder;
  makeClip(folder / "%02d.png", {ClipTrack{.codec = "png", .pix_fmt = "gray", .frames = 4}});
  Clip clip(folder / "%02d.png");
  EXPECT_FALSE(clip.packets[0].pts.has_value());
  StreamInfo stream = clip.stream();
  EXPECT_EQ(stream.frame_period, std::chrono::milliseconds(40));  // FFmpeg's default
  stream.frame_period = std::chrono::milliseconds(100);
  ASSERT_TRUE(clip.decoder->open(stream).has_value());
  const auto frames = clip.decodeOpen();
  ASSERT_EQ(frames.size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(frames[static_cast<std::size_t>(k)].pts, MediaTime(k * stream.frame_period));
}

// Numbers become codes on a scale of their own; what is no distance becomes 0.
TEST(FfmpegDecoder, FloatingPointBecomesCodesWithTheirScale) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity(), kNone = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> metres{0.5F, 1.2344F, 1.2346F, 655.35F, 140.2F, 0, -1, kInfinite, kNone, 0.004F};
  const double per_code = 0.05;  // 655.35 is an outlier of 20 samples, yet the largest: 655.35/32767 rounded up
  const std::vector<std::uint16_t> mm{10, 25, 25, 13107, 2804, 0, 0, 0, 0, 1};
  ffmpeg::FramePtr picture(av_frame_alloc());
  picture->format = AV_PIX_FMT_GRAYF32LE;
  picture->width = static_cast<int>(metres.size());
  picture->height = 2;
  ASSERT_GE(av_frame_get_buffer(picture.get(), 0), 0);
  for (int r = 0; r < 2; ++r) {
    std::memcpy(picture->data[0] + r * picture->linesize[0], metres.data(), metres.size() * sizeof(float));
  }
  ffmpeg::Converter converter;
  const auto converted = converter.convert(*picture);
  ASSERT_TRUE(converted.has_value());
  EXPECT_DOUBLE_EQ(converter.scale().valuePerCode(), per_code);
  EXPECT_EQ((*converted)->format, AV_PIX_FMT_GRAY16LE);
  const auto* const row = reinterpret_cast<const std::uint16_t*>((*converted)->data[0] + (*converted)->linesize[0]);
  EXPECT_EQ(std::vector<std::uint16_t>(row, row + mm.size()), mm);
}

// Every other picture is a B picture that no other refers to: the second, the fourth, ..
TEST(FfmpegDecoder, LeavesOutJustThePicturesThatNoOtherRefersTo) {
  const TemporaryFolder folder;
  const std::string path = folder / "b.mkv";
  makeClip(path, {ClipTrack{.codec = "libx264",
                            .pix_fmt = "yuv420p",
                            .frames = 24,
                            .gop = 12,
                            .b_frames = 1,
                            .sample = [](int i, int c, int r, int frame) { return scattered(i, c, r, frame) & 255; },
                            .options = {{"crf", "20"}, {"b_strategy", "0"}, {"sc_threshold", "0"}}}});
  Clip clip(path);
  const std::vector<Frame> whole = clip.decode();
  ASSERT_EQ(whole.size(), 24U);
  ASSERT_TRUE(clip.decoder->flush());
  ASSERT_TRUE(clip.decoder->leaveOutUnreferenced(true));
  const std::vector<Frame> less = clip.decodeOpen();
  EXPECT_GE(less.size(), 12U);
  EXPECT_LE(less.size(), 14U);  // the last before a key frame is a reference too
  for (const Frame& frame : less) {
    const auto same = std::ranges::find(whole, frame.pts, &Frame::pts);
    ASSERT_NE(same, whole.end());
    for (int r = 0; r < frame.height; ++r) {
      for (int c = 0; c < frame.width; ++c) ASSERT_EQ(sampleAt(frame, 0, c, r), sampleAt(*same, 0, c, r));
    }
  }
  ASSERT_TRUE(clip.decoder->flush());
  ASSERT_TRUE(clip.decoder->leaveOutUnreferenced(false));
  EXPECT_EQ(clip.decodeOpen().size(), 24U);
  EXPECT_EQ(clip.decoder->damaged(), 0U);
}

TEST(FfmpegDecoder, FlushForgetsAndStartsAgain) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 12, .b_frames = 2}});
  Clip clip(folder / "a.mkv");
  const auto once = clip.decode();
  ASSERT_TRUE(clip.decoder->flush().has_value());
  for (int i = 0; i < 5; ++i) static_cast<void>(clip.decoder->feed(clip.packets[static_cast<std::size_t>(i)]));
  ASSERT_TRUE(clip.decoder->flush().has_value());
  const auto again = clip.decodeOpen();
  ASSERT_EQ(again.size(), once.size());
  for (std::size_t k = 0; k < once.size(); ++k) EXPECT_EQ(again[k].pts, once[k].pts);
}

}  // namespace
}  // namespace relievo::test
