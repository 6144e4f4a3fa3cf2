// SPDX-License-Identifier: Apache-2.0
// Gray frames; cropping: the part has the samples of the whole, in every memory layout of a picture, without copies.
#include "hal/media/frame.h"

#include <gtest/gtest.h>

#include <vector>

#include "hal/media/halved.h"

namespace relievo {
namespace {

// Reads a sample as the header specifies, independently of the project's own code.
int sampleAt(const Frame& frame, int component_index, int c, int r) {
  const Component& component = frame.components[static_cast<std::size_t>(component_index)];
  const Plane& plane = frame.planes[component.plane];
  const std::uint8_t* at = plane.data + r * plane.stride_bytes + component.offset_bytes + c * component.step_bytes;
  const int word = component.bits > 8 ? at[0] | at[1] << 8 : at[0];
  return (word >> component.shift) & ((1 << component.bits) - 1);
}

// Memory in which every byte differs from its neighbours along rows, columns and planes.
std::vector<std::uint8_t> pattern() {
  std::vector<std::uint8_t> bytes(4096);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>((i * 37 + i / 256 * 11) & 0xFF);
  return bytes;
}

// Every sample of the crop equals the whole's at the same place.
void expectPartOf(const Frame& whole, int x, int y, int width, int height) {
  const Frame part = crop(whole, x, y, width, height);
  EXPECT_EQ(part.width, width);
  EXPECT_EQ(part.height, height);
  EXPECT_EQ(part.owner, whole.owner);
  const int components = whole.model == ColorModel::Gray ? 1 : 3;
  for (int i = 0; i < components; ++i) {
    const bool chroma = whole.model == ColorModel::Yuv && i > 0;
    const int shift_x = chroma ? whole.chroma_shift_x : 0;
    const int shift_y = chroma ? whole.chroma_shift_y : 0;
    for (int r = 0; r < height >> shift_y; ++r) {
      for (int c = 0; c < width >> shift_x; ++c) {
        ASSERT_EQ(sampleAt(part, i, c, r), sampleAt(whole, i, (x >> shift_x) + c, (y >> shift_y) + r))
            << "component " << i << " at " << c << ", " << r;
      }
    }
  }
}

struct Picture {
  std::vector<std::uint8_t> bytes = pattern();
  Frame frame;

  explicit Picture(ColorModel model) {
    frame.width = 16;
    frame.height = 12;
    frame.model = model;
    frame.pts = mediaTime(1.5);
  }
  [[nodiscard]] const std::uint8_t* at(std::size_t i) const { return bytes.data() + i; }
};

// As YUYV.
void pack(Picture& picture) {
  picture.frame.chroma_shift_x = 1;
  picture.frame.components[0] = {.offset_bytes = 0, .step_bytes = 2};
  picture.frame.components[1] = {.offset_bytes = 1, .step_bytes = 4};
  picture.frame.components[2] = {.offset_bytes = 3, .step_bytes = 4};
  picture.frame.planes[0] = {picture.at(0), 36};
}

TEST(FrameCrop, OfGrayBytesBeginsAtTheirFirstByte) {
  Picture picture(ColorModel::Gray);
  picture.frame.planes[0] = {picture.at(0), 20};
  expectPartOf(picture.frame, 3, 5, 7, 4);
  EXPECT_EQ(crop(picture.frame, 3, 5, 7, 4).planes[0].data, picture.at(5 * 20 + 3));
  EXPECT_EQ(crop(picture.frame, 3, 5, 7, 4).pts, mediaTime(1.5));
}

TEST(FrameCrop, GrayOfTwelveBitsInTheUpperPartOfTwoBytes) {
  Picture picture(ColorModel::Gray);
  picture.frame.components[0] = {.step_bytes = 2, .shift = 4, .bits = 12};
  picture.frame.planes[0] = {picture.at(0), 40};
  expectPartOf(picture.frame, 1, 1, 5, 5);
}

TEST(FrameCrop, OfAPictureUpsideDownGoesFromBelowToAbove) {
  Picture picture(ColorModel::Gray);
  picture.frame.planes[0] = {picture.at(11 * 20), -20};
  expectPartOf(picture.frame, 4, 2, 12, 10);
  EXPECT_EQ(crop(picture.frame, 4, 2, 12, 10).planes[0].data, picture.at(9 * 20 + 4));
}

TEST(FrameCrop, OfPlanarYuvMovesChromaByHalfAsMuch) {
  Picture picture(ColorModel::Yuv);
  picture.frame.chroma_shift_x = picture.frame.chroma_shift_y = 1;
  for (std::uint8_t i = 0; i < 3; ++i) picture.frame.components[i].plane = i;
  picture.frame.planes = {Plane{picture.at(0), 24}, Plane{picture.at(1000), 10}, Plane{picture.at(2000), 12}, Plane{}};
  expectPartOf(picture.frame, 6, 4, 8, 6);
}

TEST(FrameCrop, SemiPlanarChromaMovesOnce) {
  Picture picture(ColorModel::Yuv);
  picture.frame.chroma_shift_x = picture.frame.chroma_shift_y = 1;
  picture.frame.components[1] = {.plane = 1, .offset_bytes = 0, .step_bytes = 2};
  picture.frame.components[2] = {.plane = 1, .offset_bytes = 1, .step_bytes = 2};
  picture.frame.planes = {Plane{picture.at(0), 16}, Plane{picture.at(1000), 18}, Plane{}, Plane{}};
  expectPartOf(picture.frame, 6, 4, 8, 6);
  EXPECT_EQ(crop(picture.frame, 6, 4, 8, 6).planes[1].data, picture.at(1000 + 2 * 18 + 6));
}

TEST(FrameCrop, OfPackedYuvKeepsEachPixelsChroma) {
  Picture picture(ColorModel::Yuv);
  pack(picture);
  expectPartOf(picture.frame, 6, 3, 8, 6);
}

TEST(FrameCrop, PackedRgbMovesOnce) {
  Picture picture(ColorModel::Rgb);
  for (std::uint8_t i = 0; i < 3; ++i) picture.frame.components[i] = {.offset_bytes = i, .step_bytes = 4};
  picture.frame.planes[0] = {picture.at(0), 64};
  expectPartOf(picture.frame, 5, 7, 6, 4);
}

TEST(FrameCrop, TheWholeIsItself) {
  Picture picture(ColorModel::Gray);
  picture.frame.planes[0] = {picture.at(0), 20};
  const Frame whole = crop(picture.frame, 0, 0, 16, 12);
  EXPECT_EQ(whole.planes[0].data, picture.at(0));
  EXPECT_EQ(whole.planes[0].stride_bytes, 20);
}

TEST(FrameCrop, KeepsThePictureAlive) {
  auto owner = std::make_shared<int>(1);
  Picture picture(ColorModel::Gray);
  picture.frame.planes[0] = {picture.at(0), 20};
  picture.frame.owner = owner;
  Frame part = crop(picture.frame, 1, 1, 2, 2);
  picture.frame = Frame{};
  EXPECT_EQ(owner.use_count(), 2);
  part = Frame{};
  EXPECT_EQ(owner.use_count(), 1);
}

// Every sample of the half equals the whole's at twice its place.
void expectHalfOf(const Frame& whole) {
  const auto half = halved(whole);
  ASSERT_TRUE(half);
  EXPECT_EQ(half->width, (whole.width + 1) / 2);
  EXPECT_EQ(half->height, (whole.height + 1) / 2);
  EXPECT_EQ(half->pts, whole.pts);
  const int components = whole.model == ColorModel::Gray ? 1 : 3;
  for (int i = 0; i < components; ++i) {
    const bool chroma = whole.model == ColorModel::Yuv && i > 0;
    const int x = chroma ? whole.chroma_shift_x : 0, y = chroma ? whole.chroma_shift_y : 0;
    for (int r = 0; r < (half->height + y) >> y; ++r) {
      for (int c = 0; c < (half->width + x) >> x; ++c) {
        ASSERT_EQ(sampleAt(*half, i, c, r), sampleAt(whole, i, 2 * c, 2 * r)) << i << " at " << c << ", " << r;
      }
    }
  }
}

TEST(FrameHalved, KeepsEverySecondSampleOfEachLayout) {
  for (const int more : {0, 1}) {  // even and odd sizes
    Picture gray(ColorModel::Gray);
    gray.frame.components[0] = {.step_bytes = 2, .bits = 16};
    gray.frame.planes[0] = {gray.at(0), 48};
    Picture planar(ColorModel::Yuv);
    planar.frame.chroma_shift_x = planar.frame.chroma_shift_y = 1;
    planar.frame.components[1] = {.plane = 1};
    planar.frame.components[2] = {.plane = 2};
    planar.frame.planes = {Plane{planar.at(0), 20}, Plane{planar.at(1000), 12}, Plane{planar.at(2000), 12}, Plane{}};
    Picture packed(ColorModel::Rgb);
    for (std::uint8_t i = 0; i < 3; ++i) packed.frame.components[i] = {.offset_bytes = i, .step_bytes = 4};
    packed.frame.planes[0] = {packed.at(1024), -72};  // upside down
    for (Picture* const picture : {&gray, &planar, &packed}) {
      picture->frame.width += more;
      picture->frame.height += more;
      expectHalfOf(picture->frame);
    }
  }
}

TEST(FrameHalved, PackedYuvIsRefused) {
  Picture picture(ColorModel::Yuv);
  pack(picture);
  EXPECT_FALSE(halved(picture.frame));
}

TEST(GrayFrame, HasTheSamplesRowByRowAndKeepsThemAlive) {
  auto samples = std::make_shared<std::vector<std::uint16_t>>();
  for (int i = 0; i < 3 * 2; ++i) samples->push_back(static_cast<std::uint16_t>(10'000 * i + 7));
  const Frame frame = grayFrame(samples, 3, 2);
  EXPECT_EQ(samples.use_count(), 2);
  EXPECT_EQ(frame.model, ColorModel::Gray);
  EXPECT_EQ(frame.range, ColorRange::Full);
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(sampleAt(frame, 0, c, r), 10'000 * (3 * r + c) + 7) << c << " " << r;
  }
}

}  // namespace
}  // namespace relievo
