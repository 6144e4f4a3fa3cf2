// SPDX-License-Identifier: Apache-2.0
// The FFmpeg decoder: samples exact to the bit, references to pictures, colour signalling, damage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/picture.h"
#include "tests/support/film/clip_maker.h"

extern "C" {
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::sampleAt;
using test::TemporaryFolder;

// Every code of 16 bits, without pattern (a multiplicative hash, its upper half).
std::uint32_t scattered(int component, int column, int row, int frame) {
  const auto n = static_cast<std::uint32_t>(column + 1000 * row + 1'000'000 * frame + 7 * component);
  return (n * 2654435761u) >> 16;
}

struct Clip {
  std::unique_ptr<MediaSource> source = makeFfmpegSource();
  std::unique_ptr<VideoDecoder> decoder = makeFfmpegDecoder();
  std::vector<Packet> packets;

  // Of the one video stream.
  explicit Clip(const std::string& path) {
    EXPECT_TRUE(source->open(path).has_value());
    while (auto packet = source->read().value()) packets.push_back(*packet);
  }
  [[nodiscard]] const StreamInfo& stream() const { return source->streams().at(0); }

  std::vector<Frame> decode() {
    EXPECT_TRUE(decoder->open(stream()).has_value());
    return decodeOpen();
  }
  std::vector<Frame> decodeOpen() {
    std::vector<Frame> frames;
    const auto receiveAll = [&] {
      while (auto frame = decoder->receive().value()) frames.push_back(*frame);
    };
    for (const Packet& packet : packets) {
      while (decoder->feed(packet).value() == Feed::Full) receiveAll();
    }
    EXPECT_TRUE(decoder->drain().has_value());
    receiveAll();
    EXPECT_EQ(decoder->state(), VideoDecoder::State::Ended);
    return frames;
  }
};

int chromaColumns(const Frame& frame, int component) {
  if (frame.model != ColorModel::Yuv || component == 0) return frame.width;
  return (frame.width + (1 << frame.chroma_shift_x) - 1) >> frame.chroma_shift_x;
}
int chromaRows(const Frame& frame, int component) {
  if (frame.model != ColorModel::Yuv || component == 0) return frame.height;
  return (frame.height + (1 << frame.chroma_shift_y) - 1) >> frame.chroma_shift_y;
}

// The number of samples that differ from what was written into frame k.
int wrongSamples(const Frame& frame, int k) {
  int wrong = 0;
  const int components = frame.model == ColorModel::Gray ? 1 : 3;
  for (int i = 0; i < components; ++i) {
    const std::uint32_t mask = (1u << frame.components[static_cast<std::size_t>(i)].bits) - 1;
    for (int r = 0; r < chromaRows(frame, i); ++r) {
      for (int c = 0; c < chromaColumns(frame, i); ++c) {
        if (sampleAt(frame, i, c, r) != (scattered(i, c, r, k) & mask)) ++wrong;
      }
    }
  }
  return wrong;
}

struct Format {
  const char* codec;
  const char* pix_fmt;
  const char* file;
  ColorModel model;
  int bits;
};
void PrintTo(const Format& format, std::ostream* out) {
  *out << format.codec << " " << format.pix_fmt;
}

class ExactFormats : public testing::TestWithParam<Format> {};

TEST_P(ExactFormats, EveryCodeComesBackAsItWasWritten) {
  const Format& format = GetParam();
  TemporaryFolder folder;
  const std::string path = folder / format.file;
  const int frames = std::strchr(format.file, '%') == nullptr && std::strstr(format.file, ".mkv") == nullptr ? 1 : 5;
  makeClip(path, {ClipTrack{.codec = format.codec,
                            .pix_fmt = format.pix_fmt,
                            .width = 67,
                            .height = 41,
                            .frames = frames,
                            .sample = scattered}});
  Clip clip(path);
  const auto read = clip.decode();
  ASSERT_EQ(read.size(), static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) {
    const Frame& frame = read[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame.width, 67);
    EXPECT_EQ(frame.height, 41);
    EXPECT_EQ(frame.model, format.model);
    EXPECT_EQ(frame.components[0].bits, format.bits);
    EXPECT_EQ(wrongSamples(frame, k), 0) << "frame " << k;
  }
}

// The last four are big endian inside the decoder: converted, and exact all the same.
INSTANTIATE_TEST_SUITE_P(Ffmpeg, ExactFormats,
                         testing::Values(Format{"ffv1", "gray", "a.mkv", ColorModel::Gray, 8},
                                         Format{"ffv1", "gray10le", "a.mkv", ColorModel::Gray, 10},
                                         Format{"ffv1", "gray12le", "a.mkv", ColorModel::Gray, 12},
                                         Format{"ffv1", "gray16le", "a.mkv", ColorModel::Gray, 16},
                                         Format{"ffv1", "yuv420p", "a.mkv", ColorModel::Yuv, 8},
                                         Format{"ffv1", "yuv422p10le", "a.mkv", ColorModel::Yuv, 10},
                                         Format{"ffv1", "yuv444p16le", "a.mkv", ColorModel::Yuv, 16},
                                         Format{"ffv1", "bgr0", "a.mkv", ColorModel::Rgb, 8},
                                         Format{"ffv1", "gbrp12le", "a.mkv", ColorModel::Rgb, 12},
                                         Format{"png", "rgb24", "a.png", ColorModel::Rgb, 8},
                                         Format{"png", "gray", "%02d.png", ColorModel::Gray, 8},
                                         Format{"tiff", "gray16le", "a.tiff", ColorModel::Gray, 16},
                                         Format{"png", "gray16be", "a.png", ColorModel::Gray, 16},
                                         Format{"png", "gray16be", "%02d.png", ColorModel::Gray, 16},
                                         Format{"png", "ya16be", "a.png", ColorModel::Gray, 16},
                                         Format{"png", "rgb48be", "a.png", ColorModel::Rgb, 16}));

TEST(FfmpegPixelFormats, EachCanBeReadInPlaceOrConverted) {
  int in_place = 0;
  for (const AVPixFmtDescriptor* d = av_pix_fmt_desc_next(nullptr); d != nullptr; d = av_pix_fmt_desc_next(d)) {
    const AVPixelFormat format = av_pix_fmt_desc_get_id(d);
    if ((d->flags & AV_PIX_FMT_FLAG_HWACCEL) != 0) {
      EXPECT_FALSE(ffmpeg::describable(format)) << d->name;
      continue;
    }
    if (ffmpeg::describable(format)) {
      ++in_place;
      continue;
    }
    const auto nearest = static_cast<AVPixelFormat>(ffmpeg::nearestDescribable(format));
    EXPECT_TRUE(ffmpeg::describable(nearest)) << d->name;
    EXPECT_NE(sws_isSupportedOutput(nearest), 0) << d->name;
  }
  EXPECT_GT(in_place, 80);
}

TEST(FfmpegPixelFormats, LayoutsThatAFrameCannotSayAreNotTakenForOnesThatItCan) {
  for (const char* name : {"pal8", "monob", "monow", "gray16be", "yuv420p10be", "grayf32le", "gbrpf32le", "bayer_rggb8",
                           "xyz12le", "uyyvyy411", "rgb565le", "rgb8", "x2rgb10le"}) {
    EXPECT_FALSE(ffmpeg::describable(av_get_pix_fmt(name))) << name;
  }
  for (const char* name : {"gray", "gray9le", "gray16le", "ya8", "ya16le", "yuvj420p", "nv12", "nv21", "p010le",
                           "yuyv422", "uyvy422", "rgb0", "bgra", "rgba64le", "gbrp10le", "yuva444p16le"}) {
    EXPECT_TRUE(ffmpeg::describable(av_get_pix_fmt(name))) << name;
  }
}

TEST(FfmpegPixelFormats, ConversionKeepsTheFinestOfWhatIsThere) {
  const auto nearest = [](const char* name) {
    return std::string(
        av_get_pix_fmt_name(static_cast<AVPixelFormat>(ffmpeg::nearestDescribable(av_get_pix_fmt(name)))));
  };
  EXPECT_EQ(nearest("gray12be"), "gray12le");
  EXPECT_EQ(nearest("yuv420p10be"), "yuv420p10le");
  EXPECT_EQ(nearest("grayf32le"), "gray16le");
  EXPECT_EQ(nearest("monob"), "gray");
  EXPECT_EQ(nearest("pal8"), "rgb24");
  EXPECT_EQ(nearest("rgb565le"), "rgb24");
  EXPECT_EQ(nearest("bayer_rggb8"), "rgb24");
  EXPECT_EQ(nearest("uyyvyy411"), "yuv420p");
}

Frame frameOfFormat(const char* name) {
  ffmpeg::FramePtr picture(av_frame_alloc());
  picture->format = av_get_pix_fmt(name);
  picture->width = picture->height = 16;
  EXPECT_EQ(av_frame_get_buffer(picture.get(), 0), 0) << name;
  return ffmpeg::frameOf(std::move(picture), {0, 1});
}

TEST(FfmpegPixelFormats, ChromaSubsamplingIsTold) {
  const auto shifts = [](const char* name) {
    const Frame frame = frameOfFormat(name);
    return std::pair{int{frame.chroma_shift_x}, int{frame.chroma_shift_y}};
  };
  EXPECT_EQ(shifts("yuv420p"), (std::pair{1, 1}));
  EXPECT_EQ(shifts("yuv422p"), (std::pair{1, 0}));
  EXPECT_EQ(shifts("yuv440p"), (std::pair{0, 1}));
  EXPECT_EQ(shifts("yuv410p"), (std::pair{2, 2}));
  EXPECT_EQ(shifts("nv12"), (std::pair{1, 1}));
  EXPECT_EQ(shifts("rgb24"), (std::pair{0, 0}));
}

TEST(FfmpegPixelFormats, TheFormatItselfMayMeanFullRange) {
  EXPECT_EQ(frameOfFormat("yuvj420p").range, ColorRange::Full);
  EXPECT_EQ(frameOfFormat("yuvj444p").range, ColorRange::Full);
  EXPECT_EQ(frameOfFormat("yuv420p").range, ColorRange::Unspecified);
  EXPECT_EQ(frameOfFormat("gray12le").range, ColorRange::Full);
  EXPECT_EQ(frameOfFormat("bgr0").range, ColorRange::Full);
}

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
  EXPECT_DOUBLE_EQ(converter.valuePerCode(), per_code);
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
}  // namespace relievo
