// SPDX-License-Identifier: Apache-2.0
// The choice among a screen's modes; timings of CTA-861-G, table 1.
#include "drivers/egl/kms/kms_mode.h"

#include <gtest/gtest.h>

#include <vector>

namespace relievo::kms {
namespace {

drmModeModeInfo make(int width, int height, int htotal, int vtotal, int clock_khz, unsigned flags = 0,
                     unsigned type = 0) {
  drmModeModeInfo mode{};
  mode.hdisplay = static_cast<std::uint16_t>(width);
  mode.vdisplay = static_cast<std::uint16_t>(height);
  mode.htotal = static_cast<std::uint16_t>(htotal);
  mode.vtotal = static_cast<std::uint16_t>(vtotal);
  mode.clock = static_cast<std::uint32_t>(clock_khz);
  mode.flags = flags;
  mode.type = type;
  return mode;
}

const drmModeModeInfo kFullHd = make(1920, 1080, 2200, 1125, 148'500, 0, DRM_MODE_TYPE_PREFERRED);
const drmModeModeInfo kFullHdInterlaced = make(1920, 1080, 2200, 1125, 74'250, DRM_MODE_FLAG_INTERLACE);
const drmModeModeInfo kHd = make(1280, 720, 1650, 750, 74'250);
const drmModeModeInfo kHd50 = make(1280, 720, 1980, 750, 74'250);
const drmModeModeInfo kFullHdPacked = make(1920, 1080, 2750, 1125, 74'250, DRM_MODE_FLAG_3D_FRAME_PACKING);
const drmModeModeInfo kHdPacked = make(1280, 720, 1650, 750, 74'250, DRM_MODE_FLAG_3D_FRAME_PACKING);
const drmModeModeInfo kFullHdHalves = make(1920, 1080, 2200, 1125, 148'500, DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF);
const drmModeModeInfo kHdTopBottom = make(1280, 720, 1650, 750, 74'250, DRM_MODE_FLAG_3D_TOP_AND_BOTTOM);
const drmModeModeInfo kOtherStereo = make(1280, 720, 1650, 750, 74'250, DRM_MODE_FLAG_3D_L_DEPTH);
// Modes in the order of a television.
const std::vector kTelevision{kFullHdInterlaced, kOtherStereo, kHd,           kHd50,       kFullHd,
                              kFullHdHalves,     kHdPacked,    kFullHdPacked, kHdTopBottom};

bool same(const drmModeModeInfo* chosen, const drmModeModeInfo& expected) {
  return chosen != nullptr && chosen->hdisplay == expected.hdisplay && chosen->htotal == expected.htotal &&
         chosen->flags == expected.flags;
}

TEST(KmsMode, IsTheFirstOfTheSizeAskedFor) {
  EXPECT_TRUE(same(chooseMode(kTelevision, {1280, 720}), kHd));
  EXPECT_TRUE(same(chooseMode(kTelevision, {1920, 1080}), kFullHd)) << "not the interlaced one";
}

TEST(KmsMode, IsElseTheScreensFavourite) {
  EXPECT_TRUE(same(chooseMode(kTelevision, {640, 480}), kFullHd));
  EXPECT_TRUE(same(chooseMode(std::vector{kFullHdInterlaced, kHd50, kHd}, {640, 480}), kHd50)) << "or the first";
  EXPECT_EQ(chooseMode(std::vector{kFullHdInterlaced, kOtherStereo, kHdPacked}, {1280, 720}), nullptr);
  EXPECT_EQ(chooseMode({}, {1280, 720}), nullptr);
}

// As `play` opens a screen without --size.
TEST(KmsMode, IsTheScreensFavouriteWhereNoSizeIsAskedFor) {
  EXPECT_TRUE(same(chooseMode(kTelevision, {.film_size = true}), kFullHd));
}

TEST(KmsMode, SendsTheSignalThatIsAskedFor) {
  EXPECT_TRUE(same(chooseMode(kTelevision, {1920, 1080, StereoSignal::FramePacking}), kFullHdPacked));
  EXPECT_TRUE(same(chooseMode(kTelevision, {1280, 720, StereoSignal::FramePacking}), kHdPacked));
  EXPECT_TRUE(same(chooseMode(kTelevision, {640, 480, StereoSignal::FramePacking}), kHdPacked));
  EXPECT_TRUE(same(chooseMode(kTelevision, {1280, 720, StereoSignal::SideBySideHalf}), kFullHdHalves));
  EXPECT_TRUE(same(chooseMode(kTelevision, {1280, 720, StereoSignal::TopAndBottom}), kHdTopBottom));
  EXPECT_EQ(chooseMode(std::vector{kHd}, {1280, 720, StereoSignal::TopAndBottom}), nullptr);
}

TEST(KmsMode, TheSignalsAreThoseOfAllModes) {
  const StereoSignals all = stereoSignals(kTelevision);
  EXPECT_TRUE(all.frame_packing && all.side_by_side_half && all.top_and_bottom);
  const StereoSignals one = stereoSignals(std::vector{kHd, kHdTopBottom, kOtherStereo});
  EXPECT_FALSE(one.frame_packing || one.side_by_side_half);
  EXPECT_TRUE(one.top_and_bottom);
  EXPECT_TRUE(one.has(StereoSignal::None));
  EXPECT_TRUE(one.has(StereoSignal::TopAndBottom));
  EXPECT_FALSE(one.has(StereoSignal::SideBySideHalf));
  EXPECT_FALSE(one.has(StereoSignal::FramePacking));
}

// HDMI 1.4a, figure 8-1: 1080 + 45 + 1080 lines, 720 + 30 + 720.
TEST(KmsMode, FramePackingIsBothEyesAndTheBlankingBetweenThem) {
  const ScanOut full_hd = scanOut(kFullHdPacked, Packing::Tall), hd = scanOut(kHdPacked, Packing::Tall),
                plain = scanOut(kFullHdHalves, Packing::Tall);
  EXPECT_EQ(full_hd.width, 1920);
  EXPECT_EQ(full_hd.height, 2205);
  EXPECT_EQ(full_hd.eye_gap_rows, 45);
  EXPECT_EQ(hd.height, 1470);
  EXPECT_EQ(hd.eye_gap_rows, 30);
  EXPECT_EQ(plain.height, 1080);
  EXPECT_EQ(plain.eye_gap_rows, 0);
  EXPECT_EQ(full_hd.plane_height, 2205);
}

// As kmsprint shows it on a Raspberry Pi: a plane of 1920x1080 on a frame buffer of 3840x1080.
TEST(KmsMode, OfTwoHalvesThePlaneIsToldOfTheLeftOne) {
  const ScanOut halves = scanOut(kFullHdPacked, Packing::Beside), plain = scanOut(kFullHdHalves, Packing::Beside);
  EXPECT_EQ(halves.width, 3840);
  EXPECT_EQ(halves.height, 1080);
  EXPECT_EQ(halves.plane_width, 1920);
  EXPECT_EQ(halves.plane_height, 1080);
  EXPECT_EQ(halves.eye_gap_rows, 0);
  EXPECT_EQ(plain.width, 1920);
  for (const char* driver : {"amdgpu", "i915", "xe", "nouveau", "vkms", ""}) {
    EXPECT_EQ(packingOf(driver), Packing::Tall) << driver;
  }
  EXPECT_EQ(packingOf("vc4"), Packing::Beside);
}

TEST(KmsMode, FramePackingOfAnotherSizeIsNotChosen) {
  const drmModeModeInfo small = make(720, 576, 864, 625, 27'000, DRM_MODE_FLAG_3D_FRAME_PACKING);
  EXPECT_FALSE(stereoSignals(std::vector{kHd, small}).frame_packing);
  EXPECT_EQ(chooseMode(std::vector{kHd, small}, {720, 576, StereoSignal::FramePacking}), nullptr);
}

TEST(KmsMode, ThePeriodIsThatOfItsPixelClock) {
  EXPECT_NEAR(toSeconds(refreshPeriod(kFullHd)), 1.0 / 60, 1e-8);
  EXPECT_NEAR(toSeconds(refreshPeriod(kHd50)), 1.0 / 50, 1e-8);
  EXPECT_NEAR(toSeconds(refreshPeriod(kFullHdPacked)), 1.0 / 24, 1e-8);
  EXPECT_EQ(refreshPeriod({}), Duration(0));
}

}  // namespace
}  // namespace relievo::kms
