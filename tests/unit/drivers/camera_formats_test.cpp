// SPDX-License-Identifier: Apache-2.0
// The colours of a camera's pictures, by Documentation/userspace-api/media/v4l/colorspaces-details.rst.
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include "drivers/v4l2/formats.h"

namespace relievo::v4l2 {
namespace {

struct Told {
  std::uint32_t format, space, encoding = V4L2_YCBCR_ENC_DEFAULT, range = V4L2_QUANTIZATION_DEFAULT;
  bool extended = true;
};

Frame frameOf(const Told& told) {
  v4l2_pix_format picture{};
  picture.width = 64;
  picture.height = 48;
  picture.pixelformat = told.format;
  picture.colorspace = told.space;
  picture.priv = told.extended ? V4L2_PIX_FMT_PRIV_MAGIC : 0;
  picture.ycbcr_enc = told.encoding;
  picture.quantization = told.range;
  return layoutOf(*findFormat(told.format), picture)->frame;
}

TEST(CameraFormats, WhatTheDriverLeavesOpenFollowsFromItsColourSpace) {
  const auto yuyv = [](std::uint32_t space) { return frameOf({V4L2_PIX_FMT_YUYV, space}); };
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_DEFAULT).matrix, ColorMatrix::Bt601);
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_SRGB).matrix, ColorMatrix::Bt601) << "a webcam";
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_SRGB).range, ColorRange::Limited);
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_SMPTE170M).matrix, ColorMatrix::Bt601);
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_REC709).matrix, ColorMatrix::Bt709) << "HDMI";
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_REC709).range, ColorRange::Limited);
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_BT2020).matrix, ColorMatrix::Bt2020);
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_JPEG).matrix, ColorMatrix::Bt601);
  EXPECT_EQ(yuyv(V4L2_COLORSPACE_JPEG).range, ColorRange::Full);
  EXPECT_EQ(frameOf({V4L2_PIX_FMT_RGB24, V4L2_COLORSPACE_REC709}).range, ColorRange::Full);
  EXPECT_EQ(frameOf({V4L2_PIX_FMT_GREY, V4L2_COLORSPACE_SRGB}).range, ColorRange::Full);
}

TEST(CameraFormats, WhatTheDriverTellsIsTaken) {
  const Told told{V4L2_PIX_FMT_NV12, V4L2_COLORSPACE_SRGB, V4L2_YCBCR_ENC_709, V4L2_QUANTIZATION_FULL_RANGE};
  EXPECT_EQ(frameOf(told).matrix, ColorMatrix::Bt709);
  EXPECT_EQ(frameOf(told).range, ColorRange::Full);
  Told older = told;
  older.extended = false;  // these fields mean nothing then
  EXPECT_EQ(frameOf(older).matrix, ColorMatrix::Bt601);
  EXPECT_EQ(frameOf(older).range, ColorRange::Limited);
  EXPECT_EQ(frameOf({V4L2_PIX_FMT_Z16, V4L2_COLORSPACE_SRGB, 0, V4L2_QUANTIZATION_LIM_RANGE}).range, ColorRange::Full);
}

}  // namespace
}  // namespace relievo::v4l2
