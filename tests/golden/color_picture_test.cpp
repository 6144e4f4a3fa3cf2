// SPDX-License-Identifier: Apache-2.0
// The two ways to convert a colour picture, by the GPU and by the CPU, show the same; what is uploaded is no larger
// than what is seen.
#include "app/render/gl/color_picture.h"

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "drivers/egl/egl.h"
#include "platform/clock.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};

// Planar YUV 4:2:0 with waves in each plane.
struct Waves {
  Waves(int width, int height) {
    frame.width = width;
    frame.height = height;
    frame.model = ColorModel::Yuv;
    frame.matrix = ColorMatrix::Bt709;
    frame.range = ColorRange::Limited;
    frame.chroma_shift_x = frame.chroma_shift_y = 1;
    frame.plane_count = 3;
    for (std::uint8_t i = 0; i < 3; ++i) {
      const int cols = i == 0 ? width : (width + 1) / 2, rows = i == 0 ? height : (height + 1) / 2;
      for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < cols; ++c) {
          const double wave = std::sin(20.0 * c / cols + i) * std::cos(13.0 * r / rows);
          planes[i].push_back(static_cast<std::uint8_t>(128 + (i == 0 ? 90 : 40) * wave));
        }
      }
      frame.planes[i] = {planes[i].data(), cols};
      frame.components[i] = {.plane = i, .step_bytes = 1, .bits = 8};
    }
  }
  Frame frame;
  std::array<std::vector<std::uint8_t>, 3> planes;
};

class ColorPictures : public testing::Test {
 protected:
  void SetUp() override {
    display_ = makeOffscreenDisplay({}, clock_);
    if (!display_->open({16, 16})) GTEST_SKIP() << "this machine has no EGL with GLES 3";
    ASSERT_TRUE(display_->beginFrame());
  }
  void TearDown() override { display_->close(); }

  // The pixels of the texture that is bound to unit 0, if it has this size.
  static std::vector<std::uint8_t> textureOf(int width, int height) {
    GLint texture = 0;
    glActiveTexture(GL_TEXTURE0);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture);
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, static_cast<GLuint>(texture), 0);
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(4 * width * height));
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glDeleteFramebuffers(1, &framebuffer);
    return pixels;
  }

  MonotonicClock clock_;
  std::unique_ptr<Display> display_;
};

TEST_F(ColorPictures, GpuAndCpuMakeTheSame) {
  const Waves waves(160, 90);
  std::vector<std::uint8_t> by_gpu;
  for (const auto converter : {ColorPicture::Converter::Gpu, ColorPicture::Converter::Cpu}) {
    ColorPicture picture(converter);
    ASSERT_TRUE(picture.setFrame(waves.frame));
    picture.bind(0, {0, 0, 160, 90}, kVolume);
    const auto pixels = textureOf(160, 90);
    if (by_gpu.empty()) {
      by_gpu = pixels;
      continue;
    }
    int worst = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) worst = std::max(worst, std::abs(pixels[i] - by_gpu[i]));
    EXPECT_LE(worst, 3) << "GL interpolates chroma in few bits";
  }
}

TEST_F(ColorPictures, NoMoreThanFourTimesThePixelsThatAreSeenIsUploaded) {
  constexpr PixelArea kSeen{0, 0, 160, 90};
  for (const int times : {1, 2, 3, 5, 9}) {
    const Waves waves(160 * times, 90 * times);
    ColorPicture picture;
    ASSERT_TRUE(picture.setFrame(waves.frame));
    EXPECT_EQ(picture.uploadedBytes(), 0U);
    picture.bind(0, kSeen, kVolume);
    EXPECT_LT(picture.uploadedBytes(), std::size_t{4} * 4 * 160 * 90) << times;
    EXPECT_GE(picture.uploadedBytes(), std::size_t{3} * 160 * 90 / 2);
  }
}

TEST_F(ColorPictures, APictureIsUploadedOnceUntilItIsSeenLarger) {
  const Waves waves(640, 360);
  for (const auto converter : {ColorPicture::Converter::Gpu, ColorPicture::Converter::Cpu}) {
    ColorPicture picture(converter);
    ASSERT_TRUE(picture.setFrame(waves.frame));
    picture.bind(0, {0, 0, 160, 90}, kVolume);
    const std::size_t once = picture.uploadedBytes();
    picture.bind(0, {0, 0, 160, 90}, kVolume);
    picture.bind(0, {160, 0, 160, 90}, kVolume);
    EXPECT_EQ(picture.uploadedBytes(), once);
    picture.bind(0, {0, 0, 640, 360}, kVolume);
    const bool has_planes = converter == ColorPicture::Converter::Gpu;
    EXPECT_EQ(picture.uploadedBytes(), once + (has_planes ? 0 : 4 * 640 * 360));
  }
}

}  // namespace
}  // namespace relievo
