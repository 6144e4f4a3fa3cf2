// SPDX-License-Identifier: Apache-2.0
// The FFmpeg decoder's pixel formats: samples exact to the bit, read in place or converted.
#include <gtest/gtest.h>

#include <cstring>
#include <ostream>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/pictures/picture.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/drivers/ffmpeg/decoded_clip.h"

extern "C" {
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace relievo::test {
namespace {

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

}  // namespace
}  // namespace relievo::test
