// SPDX-License-Identifier: Apache-2.0
// Recordings whose codes are no plain distances in mm: disparities of 16 bits, floats in four bytes, gray in 48 bits,
// 512 codes a metre, and depth that is the first of two tracks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "app/media/reading/known_kind.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"
#include "tests/support/film/scene_film.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::expectScene;
using test::makeClip;
using test::OpenedFilm;
using test::openFilm;
using test::TemporaryFolder;

using Sample = std::function<std::uint32_t(int, int, int, int)>;
ClipTrack track(const char* codec, const char* format, Sample sample, int frames = 1) {
  ClipTrack track{.codec = codec,
                  .pix_fmt = format,
                  .width = test::kSceneCols,
                  .height = test::kSceneRows,
                  .frames = frames,
                  .sample = std::move(sample)};
  return track;
}
std::uint32_t rounded(double code) {
  return static_cast<std::uint32_t>(std::lround(code));
}

// The true shape of distances whose scale nobody knows.
void expectShape(const OpenedFilm& film, double share) {
  ASSERT_FALSE(film.pair.depth.empty());
  const int c = test::kSceneCols / 2, r = test::kSceneRows / 2;
  expectScene(film, film.distanceAt(c, r) / distanceMm(c, r), {.share = share});
}

// Cityscapes, InStereo2K, DrivingStereo and OAK-D differ in how many codes a pixel has.
TEST(OddCodes, SixteenBitsThatAreNamedDisparityAreNearWhereHigh) {
  for (const char* name : {"a_000000_disparity.png", "left_disp.png", "disparity-map/1.png"}) {
    TemporaryFolder folder;
    std::filesystem::create_directories(folder / "disparity-map");
    makeClip(folder / name, {track("png", "gray16be", [](int, int c, int r, int) {
               const double mm = distanceMm(c, r);
               return mm == 0 ? 0 : rounded(1.6e7 / mm);
             })});
    const OpenedFilm film = openFilm({.url = folder / name});
    EXPECT_EQ(film.info.packing, Packing::DepthAlone);
    expectShape(film, 0.001);
  }
}

// InteriorNet and SceneNet RGB-D store the way to the camera's centre, which is longer in the corners.
TEST(OddCodes, DistancesAlongRaysAreReadAsDepth) {
  struct Camera {
    const char *color, *depth, *more;
    double focal_x, focal_y;  // pixels
  };
  constexpr double kWide = 1.7320508, kHigh = 2.4142136;  // 1 / tan of half of 60 and of 45 degrees
  for (const Camera& camera : {Camera{"cam0/data/7.png", "depth0/data/7.png", "label0/data", 600 * .25, 600 * .225},
                               Camera{"photo/0.png", "depth/0.png", "instance", kWide * 80, kHigh * 54}}) {
    TemporaryFolder folder;
    for (const char* const name : {camera.color, camera.depth})
      std::filesystem::create_directories(std::filesystem::path(folder / name).parent_path());
    std::filesystem::create_directories(folder / camera.more);
    makeClip(folder / camera.color,
             {track("png", "rgb24", [](int k, int c, int r, int) { return rounded(40 * k + c + r / 2.0); })});
    makeClip(folder / camera.depth, {track("png", "gray16be", [&](int, int c, int r, int) {
               const double x = (c - 80) / camera.focal_x, y = (r - 54) / camera.focal_y;
               return rounded(distanceMm(c, r) * std::sqrt(1 + x * x + y * y));
             })});
    const OpenedFilm film = openFilm({.url = folder / "."});
    expectScene(film, 1, {.mm = 1.1});
    EXPECT_NE(plainLine(film.info.reading, film.info.calibration.calibration).find("camera's centre"),
              std::string::npos);
  }
}

// MPI Sintel: a disparity of 4 R + G / 64 + B / 16384 pixels.
TEST(OddCodes, SintelsDisparitiesAreReadFromTheBytesOfRgb) {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder / "disparities/alley");
  makeClip(folder / "disparities/alley/frame_0001.png", {track("png", "rgb24", [](int k, int c, int r, int) {
             const double mm = distanceMm(c, r);
             const std::uint32_t code = mm == 0 ? 0 : rounded(16384 * 120000 / mm);
             return code >> (8 * (2 - k)) & 0xff;
           })});
  expectShape(openFilm({.url = folder / "disparities/alley/frame_0001.png"}), 0.001);
}

// Raw AVI of cameras: "Y16 ", the lower byte first. As YUY2 the same bytes are written, and its name is changed.
TEST(OddCodes, SixteenBitsOfRawAviAreGray) {
  TemporaryFolder folder;
  const std::string path = folder / "depth.avi";
  makeClip(path, {track("rawvideo", "yuyv422", [](int k, int c, int r, int) {
             const std::uint32_t mm = rounded(distanceMm(k == 0 ? c : 2 * c + k - 1, r));
             return k == 0 ? mm & 0xff : mm >> 8;
           })});
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  std::string head(4096, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  file.clear();
  for (std::size_t at = head.find("YUY2"); at != std::string::npos; at = head.find("YUY2", at + 1)) {
    file.seekp(static_cast<std::streamoff>(at)).write("Y16 ", 4);
  }
  file.close();
  const OpenedFilm film = openFilm({.url = path});
  EXPECT_EQ(film.info.color_codec, "rawvideo");
  expectScene(film, 1, {.mm = 0.51});
}

// TartanAir: the bytes of a float in blue, green, red and alpha, the lowest first; its sky lies at 10 km.
TEST(OddCodes, FloatsInFourBytesAreMetres) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {track("png", "rgba", [](int k, int c, int r, int) {
             const double mm = distanceMm(c, r);
             const auto metres = static_cast<float>(mm == 0 ? 10000 : mm / 1000);
             std::uint32_t bits = 0;
             std::memcpy(&bits, &metres, sizeof bits);
             const int byte = k == 0 ? 2 : k == 2 ? 0 : k;
             return bits >> (8 * byte) & 0xff;
           })});
  const OpenedFilm film = openFilm({.url = folder / "a.png"});
  EXPECT_EQ(film.info.packing, Packing::DepthAlone);
  expectScene(film, 1, {.share = 0.002});
}

// 24 bits of a share of 3 m, the highest in red. A half of them is not the depth of the other.
TEST(OddCodes, SteepSlopesOfCodesInThreeBytesAreDepthAsAWhole) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {track("png", "rgb24", [](int k, int c, int r, int) {
             const double mm = r > 54 ? 2900 - 40 * (r - 54) : 2000 + 2.0 * c;
             return rounded(0xffffff * mm / 6000) >> (8 * (2 - k)) & 0xff;
           })});
  EXPECT_EQ(openFilm({.url = folder / "a.png"}).info.packing, Packing::DepthAlone);
}

TEST(OddCodes, GrayOfFortyEightBitsIsReadAsGrayIs) {
  TemporaryFolder folder;
  makeClip(folder / "a.png",
           {track("png", "rgb48be", [](int, int c, int r, int) { return rounded(distanceMm(c, r)); })});
  const OpenedFilm film = openFilm({.url = folder / "a.png"});
  EXPECT_EQ(film.info.packing, Packing::DepthAlone);
  expectScene(film, 1, {.share = 0.001});
}

TEST(OddCodes, TaskonomysNamesSay512CodesAMetre) {
  TemporaryFolder folder;
  const std::string path = folder / "point_0_view_1_domain_depth_zbuffer.png";
  makeClip(path, {track("png", "gray16be", [](int, int c, int r, int) {
             const double mm = distanceMm(c, r);
             return mm == 0 ? 65535 : rounded(0.512 * mm);
           })});
  expectScene(openFilm({.url = path}), 1, {.share = 0.002});
}

// CO3D and Dynamic Replica: the 16 bits are those of a half float.
TEST(OddCodes, GeometricPngsHoldHalfFloats) {
  TemporaryFolder folder;
  const auto half_of = [](double value) {
    int exponent = 0;
    const double significand = std::frexp(value, &exponent);  // .5 to 1
    return rounded(2048 * significand) - 1024 + (static_cast<std::uint32_t>(exponent + 14) << 10);
  };
  const std::string path = folder / "frame000001.jpg.geometric.png";
  makeClip(path, {track("png", "gray16be", [&](int, int c, int r, int) {
             const double mm = distanceMm(c, r);
             return mm == 0 ? 0 : half_of(mm / 250);
           })});
  expectScene(openFilm({.url = path}), 4, {.share = 0.003});
}

// 300 to 1084 are a Kinect's raw codes, and what mm of a near view may be, too.
TEST(OddCodes, AKinectsRawCodesWithoutAHoleAreOffered) {
  const auto offersOf = [](double first, double step) {
    TemporaryFolder folder;
    makeClip(folder / "a.png",
             {track("png", "gray16be", [=](int, int c, int r, int) { return rounded(first + step * (c + r)); })});
    const FilmReading reading = openFilm({.url = folder / "a.png"}).info.reading;
    std::string lines;
    for (const auto& of : {reading.offers, reading.doubts}) {
      for (const std::string& line : of) lines += line + "\n";
    }
    return lines;
  };
  EXPECT_NE(offersOf(450, 1).find("--as kinect-raw"), std::string::npos);
  EXPECT_EQ(offersOf(450, 4).find("--as kinect-raw"), std::string::npos) << "farther than a Kinect's codes";
}

// A network's 16 bits from 0 to 65535 in a file without a telling name.
TEST(OddCodes, GrayOfMoreThanEightBitsIsDepth) {
  TemporaryFolder folder;
  makeClip(
      folder / "a.png",
      {track("png", "gray16be", [](int, int c, int r, int) { return rounded(65535 * (1 - c / 200.0 - r / 800.0)); })});
  EXPECT_EQ(openFilm({.url = folder / "a.png"}).info.packing, Packing::DepthAlone);
}

// Cameras of 12 bits: their codes cannot be the kind's hole of 65535, and that is no error.
TEST(OddCodes, AKindOfSixteenBitsMayBeSaidOfFewer) {
  for (const auto& [format, codes] : {std::pair{"gray12le", 1.0}, {"gray10le", 4.0}}) {
    TemporaryFolder folder;
    makeClip(folder / "a.mkv",
             {track("ffv1", format, [codes](int, int c, int r, int) { return rounded(distanceMm(c, r) / codes); })});
    const OpenedFilm film = openFilm({.url = folder / "a.mkv", .as = findKind("mm")});
    expectScene(film, 1 / codes, {.mm = 0.51});
    EXPECT_EQ(film.info.calibration.calibration.invalid, CodeSet(0));
    const OpenedFilm raw = openFilm({.url = folder / "a.mkv", .as = findKind("kinect-raw")});
    const char* const held = codes == 1 ? "0+1085-4095" : "0";  // what 12 or 10 bits can hold of 0+1085-65535
    EXPECT_EQ(raw.info.calibration.calibration.invalid.text(), held);
  }
}

// Marigold's folder of gray pictures, and Blender's mist pass.
TEST(OddCodes, NearIsDarkInFoldersOfMarigoldAndOfMist) {
  for (const char* name : {"depth_bw", "mist"}) {
    TemporaryFolder folder;
    std::filesystem::create_directories(folder / name);
    const std::string picture = (folder / name) + "/a_pred.png";
    makeClip(picture,
             {track("png", "gray16be", [](int, int c, int r, int) { return rounded(25 * distanceMm(c, r)); })});
    const OpenedFilm film = openFilm({.url = picture});
    EXPECT_EQ(film.info.calibration.calibration.polarity, DepthPolarity::NearIsLow) << name;
    EXPECT_EQ(film.info.packing, Packing::DepthAlone) << name;
  }
}

TEST(OddCodes, OfTwoTracksTheGrayOneIsTheDepth) {
  const auto photo = [](int k, int c, int r, int) {
    return test::yuvCode(k, test::photoOf(c << (k > 0), r << (k > 0)));
  };
  const auto gray = [](int k, int c, int r, int) {
    return k > 0 ? 128u : rounded(16 + 219 * (1 - distanceMm(c, r) / 2100));
  };
  const auto codes = [](int, int c, int r, int) { return rounded(distanceMm(c, r)); };
  const ClipTrack color = track("ffv1", "yuv420p", photo, 4);
  for (const ClipTrack& depth : {track("ffv1", "gray16le", codes, 4), track("ffv1", "yuv420p", gray, 4)}) {
    TemporaryFolder folder;
    makeClip(folder / "a.mkv", {depth, color});
    const OpenedFilm film = openFilm({.url = folder / "a.mkv"});
    ASSERT_FALSE(film.pair.depth.empty());
    EXPECT_EQ(film.pair.color.model, ColorModel::Yuv);
    EXPECT_EQ(test::sampleAt(film.pair.color, 0, 33, 44), photo(0, 33, 44, 0)) << depth.pix_fmt;
    if (depth.pix_fmt == "gray16le") EXPECT_THAT(film.info.reading.doubts, testing::IsEmpty());
    else EXPECT_THAT(film.info.reading.doubts, testing::ElementsAre(testing::HasSubstr("nothing says which end")));
  }
}

TEST(OddCodes, EveryKindsCalibrationIsInTheWordsOfTheCommandLine) {
  std::istringstream lines(kindsText());
  std::string name, rest;
  int kinds = 0;
  while (lines >> name && std::getline(lines, rest)) {
    const KnownKind* const kind = findKind(name);
    ASSERT_NE(kind, nullptr) << name;
    EXPECT_TRUE(parseCalibration(kind->calibration)) << name << ": " << kind->calibration;
    ++kinds;
  }
  EXPECT_GT(kinds, 20);
}

// Infrared is stored as depth is, or in 8 bits, before it or after it, and no track says what it is.
TEST(OddCodes, OfTracksOfGrayTheSmoothOneIsTheDepth) {
  const auto speckle = [](int c, int r) { return (c * 7919 + r * 104729) % 97; };
  const auto color =
      track("ffv1", "yuv444p", [](int k, int c, int r, int) { return test::yuvCode(k, test::photoOf(c, r)); }, 2);
  const auto depth = track("ffv1", "gray16le", [](int, int c, int r, int) { return rounded(distanceMm(c, r)); }, 2);
  const auto infrared = track(
      "ffv1", "gray16le",
      [&](int, int c, int r, int) {
        return rounded(400 + 4e8 / (distanceMm(c, r) * distanceMm(c, r) + 1e5) + speckle(c, r));
      },
      2);
  const auto pale = track("ffv1", "gray", [&](int, int c, int r, int) { return 40 + rounded(speckle(c, r)); }, 2);
  for (const auto& tracks : std::vector<std::vector<ClipTrack>>{{color, infrared, depth},
                                                                {color, depth, infrared},
                                                                {infrared, depth},
                                                                {depth, infrared},
                                                                {color, pale, depth}}) {
    TemporaryFolder folder;
    makeClip(folder / "a.mkv", tracks);
    expectScene(openFilm({.url = folder / "a.mkv"}), 1, {.mm = 0.51});
  }
}

}  // namespace
}  // namespace relievo
