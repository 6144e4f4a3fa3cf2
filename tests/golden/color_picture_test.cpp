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

// HDR against what was computed on paper. A colour of ITU-T H.273: 9 BT.2020, 16 PQ, 18 HLG.
struct HdrColor {
  const char* what;
  std::array<double, 3> code;  // shares of full range
  std::uint8_t transfer;
  std::array<int, 3> seen;
};

// ITU-R BT.2390 leaves light below its knee as it is: with 203 of 1000 cd/m2 the knee is at 88. The code of a screen is
// 255 (light / 203)^(1 / 2.4). Reference white is a third of the way along the spline, whose weights there are 20/27,
// 4/27 and 7/27: 159 cd/m2. 26 cd/m2 is gray of 18 %.
constexpr std::array<HdrColor, 10> kHdrColors{{
    {"black", {0, 0, 0}, 16, {0, 0, 0}},
    {"gray of 26 cd/m2", {0.3818, 0.3818, 0.3818}, 16, {108, 108, 108}},
    {"white of 203 cd/m2", {0.5807, 0.5807, 0.5807}, 16, {230, 230, 230}},
    {"1000 cd/m2", {0.7518, 0.7518, 0.7518}, 16, {255, 255, 255}},
    {"10000 cd/m2", {1, 1, 1}, 16, {255, 255, 255}},
    // BT.709's red of 80 cd/m2 is 50.2, 5.5 and 1.3 of BT.2020; (80 / 203)^(1 / 2.4) = 0.678.
    {"red of 80 cd/m2", {0.4433, 0.2554, 0.1655}, 16, {173, 0, 0}},
    {"HLG's black", {0, 0, 0}, 18, {0, 0, 0}},
    {"HLG's gray of 26 cd/m2", {0.38, 0.38, 0.38}, 18, {108, 108, 108}},
    {"HLG's white of 203 cd/m2", {0.75, 0.75, 0.75}, 18, {230, 230, 230}},
    {"HLG's most", {1, 1, 1}, 18, {255, 255, 255}},
}};

TEST_F(ColorPictures, HdrIsSeenAsOnAUsualScreen) {
  for (const auto converter : {ColorPicture::Converter::Gpu, ColorPicture::Converter::Cpu}) {
    ColorPicture picture(converter);
    for (const HdrColor& color : kHdrColors) {
      std::vector<std::uint8_t> samples(std::size_t{16} * 9 * 3);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = static_cast<std::uint8_t>(std::lround(255 * color.code[i % 3]));
      }
      Frame frame{.width = 16, .height = 9, .model = ColorModel::Rgb, .range = ColorRange::Full};
      frame.primaries = 9;
      frame.transfer = color.transfer;
      frame.plane_count = 1;
      for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.offset_bytes = i, .step_bytes = 3};
      frame.planes[0] = {samples.data(), std::ptrdiff_t{3} * 16};
      ASSERT_TRUE(picture.setFrame(frame));
      picture.bind(0, {0, 0, 16, 9}, kVolume);
      const auto pixels = textureOf(16, 9);
      for (std::size_t k = 0; k < 3; ++k) {
        // Half a code of PQ is 2 of the screen's; what is left of green and blue in a red of 8 bits is up to 25.
        const int tolerance = color.seen[k] == 0 && color.seen[0] > 0 ? 25 : 3;
        EXPECT_NEAR(pixels[k], color.seen[k], tolerance)
            << color.what << ", " << k << (converter == ColorPicture::Converter::Gpu ? ", GPU" : ", CPU");
      }
      // An SDR film after an HDR one: its codes are shown as they are.
      frame.transfer = kBt709;
      ASSERT_TRUE(picture.setFrame(frame));
      picture.bind(0, {0, 0, 16, 9}, kVolume);
      EXPECT_NEAR(textureOf(16, 9)[0], samples[0], 1) << color.what;
    }
  }
}

TEST_F(ColorPictures, GpuAndCpuMapHdrAlike) {
  Waves waves(160, 90);
  waves.frame.matrix = ColorMatrix::Bt2020;
  for (const auto transfer : std::array<std::uint8_t, 2>{16, 18}) {
    waves.frame.transfer = transfer;
    std::array<std::vector<std::uint8_t>, 2> pixels;
    for (std::size_t i = 0; i < 2; ++i) {
      ColorPicture picture(i == 0 ? ColorPicture::Converter::Gpu : ColorPicture::Converter::Cpu);
      ASSERT_TRUE(picture.setFrame(waves.frame));
      picture.bind(0, {0, 0, 160, 90}, kVolume);
      pixels[i] = textureOf(160, 90);
    }
    double sum = 0;
    for (std::size_t i = 0; i < pixels[0].size(); ++i) sum += std::abs(pixels[0][i] - pixels[1][i]);
    EXPECT_LT(sum / static_cast<double>(pixels[0].size()), 2) << "the CPU's codes are rounded before they are mapped";
  }
}

}  // namespace
}  // namespace relievo
