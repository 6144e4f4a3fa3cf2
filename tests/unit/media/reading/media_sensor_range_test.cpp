// SPDX-License-Identifier: Apache-2.0
// Distances of sensors whose noise reaches the highest codes, and numbers that no sensor measures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/media/reading/codes/measured_codes.h"
#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/float_reading.h"
#include "app/media/reading/recording_place.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"
#include "tests/support/film/scene_film.h"

namespace relievo {
namespace {

using test::distanceMm;
using test::makeGrayFrame;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr int kCols = test::kSceneCols, kRows = test::kSceneRows;

// A stereo camera with a focal length of 425 pixels, a baseline of 50 mm and 32 steps a pixel.
constexpr double kSteps = 425.0 * 50 * 32;
std::uint32_t stereoMm(double step) {
  return static_cast<std::uint32_t>(std::lround(kSteps / std::round(step)));
}
// The scene, and right of it the sky, where the camera returns all that it can between 10 and 65 m.
std::uint32_t sceneUnderTheSky(int c, int r) {
  const double mm = distanceMm(c, r);
  if (c > 120) return stereoMm(11 + (7 * c + r) % 75);
  return mm == 0 ? 0 : stereoMm(kSteps / mm);
}

template <class Sample>
test::ClipTrack pictures(const char* format, Sample&& sample) {
  return {.codec = "png",
          .pix_fmt = format,
          .width = kCols,
          .height = kRows,
          .frames = 1,
          .sample = [sample](int k, int c, int r, int) { return static_cast<std::uint32_t>(sample(k, c, r)); }};
}

const KnownKind* kindIn(const Frame& frame) {
  return sensorKind(frame, CodeCount(frame));
}

TEST(SensorRange, AStereoCamerasDistancesMayReachTheHighestCode) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a_depth.png",
                 {pictures("gray16be", [](int, int c, int r) { return sceneUnderTheSky(c, r); })});
  const test::OpenedFilm film = test::openFilm({.url = folder / "a_depth.png"});
  EXPECT_EQ(film.info.calibration.calibration.unit_mm, 1.0);
  EXPECT_EQ(film.info.calibration.calibration.polarity, DepthPolarity::NearIsLow);
  EXPECT_TRUE(std::isnan(film.heightAt(2, 50)));
  EXPECT_NEAR(film.distanceAt(kCols / 2, kRows / 2), distanceMm(kCols / 2, kRows / 2), 4);  // half a step
}

// Without any hole it is told by its steps alone.
TEST(SensorRange, StepsThatGrowWithTheDistanceAreAStereoCameras) {
  const auto steps = [](int c, int r) { return stereoMm(11 + (c + 160 * r) % 1200); };
  const Frame measured = makeGrayFrame(kCols, kRows, 16, {}, steps);
  EXPECT_TRUE(hasStereoSteps(CodeCount(measured)));
  EXPECT_EQ(kindIn(measured), findKind("mm"));
  // The same brightness in as many even shades, and in all of them.
  const Frame even = makeGrayFrame(kCols, kRows, 16, {}, [&](int c, int r) { return steps(c, r) / 257 * 257; });
  EXPECT_FALSE(hasStereoSteps(CodeCount(even)));
  const Frame smooth = makeGrayFrame(kCols, kRows, 16, {}, [](int c, int r) { return 300 + 3 * c + 600 * r; });
  EXPECT_FALSE(hasStereoSteps(CodeCount(smooth)));
  EXPECT_EQ(kindIn(smooth), nullptr);
}

// A few wild distances, of another camera than a stereo one, around a scene of which most is a hole.
TEST(SensorRange, AFewWildDistancesMakeNoBrightness) {
  const auto picture = [](double times) {
    return makeGrayFrame(kCols, kRows, 16, {}, [=](int c, int r) {
      const double mm = distanceMm(c, r);
      if (c < 40 || mm == 0) return 0u;
      return c == 80 ? 30000u + 331u * static_cast<std::uint32_t>(r) : static_cast<std::uint32_t>(times * mm);
    });
  };
  EXPECT_EQ(kindIn(picture(1)), findKind("mm"));
  EXPECT_EQ(kindIn(picture(25)), nullptr) << "the scene itself fills the codes";
}

// Kinect and Xtion, whose recordings have 5000 codes a metre, begin at .35 m.
TEST(SensorRange, FarViewsOfWhatIsNearForAKinectAreInMillimetres) {
  const auto picture = [](std::uint32_t nearest) {
    return makeGrayFrame(kCols, kRows, 16, {}, [=](int c, int r) {
      const auto mm = static_cast<std::uint32_t>(10 * distanceMm(c, r));
      return c > 140 ? nearest + static_cast<std::uint32_t>(r) : mm;
    });
  };
  EXPECT_EQ(kindIn(picture(1200)), findKind("mm"));
  EXPECT_EQ(kindIn(picture(2000)), findKind("tum"));
  const Frame fine = picture(2000);
  EXPECT_THAT(readCodes(fine, CodeCount(fine), {}).offer, HasSubstr("--as ycb"));
}

// What a code is worth follows from how its steps grow: z = f b s / k for whole k, in codes. The focal lengths,
// baselines and steps are those of the makers' data sheets; TUM's Kinects and the Xtion have 75 mm and 8 steps a pixel.
TEST(SensorRange, AStereoCamerasStepsTellItsUnit) {
  const auto stereo = [](double focal_px, double baseline_mm, double steps, double codes_a_mm) {
    const double constant = focal_px * baseline_mm * steps * codes_a_mm;
    return makeGrayFrame(kCols, kRows, 16, {}, [=](int c, int r) {
      const double mm = distanceMm(c, r) * (c > 100 ? 2 : 1);
      return mm == 0 ? 0 : static_cast<std::uint32_t>(std::lround(constant / std::round(constant / codes_a_mm / mm)));
    });
  };
  const auto kindOfCamera = [&](double focal_px, double baseline_mm, double steps, double codes_a_mm) {
    return kindIn(stereo(focal_px, baseline_mm, steps, codes_a_mm));
  };
  EXPECT_EQ(kindOfCamera(385, 50, 32, 1), findKind("mm")) << "RealSense D435, 640 columns";
  EXPECT_EQ(kindOfCamera(910, 50, 32, 1), findKind("mm")) << "RealSense D435, 1280 columns";
  EXPECT_EQ(kindOfCamera(575, 75, 8, 1), findKind("mm")) << "Kinect";
  EXPECT_EQ(kindOfCamera(620, 75, 8, 5), findKind("tum"));
  EXPECT_EQ(kindOfCamera(555, 75, 8, 10), findKind("ycb")) << "Xtion, in tenths of a mm";
  EXPECT_EQ(kindOfCamera(640, 18, 32, 10), findKind("ycb")) << "RealSense D405, 1280 columns";
  // A wider picture with the constant of TUM's Kinects: RealSense D455, 1280 columns.
  EXPECT_EQ(kindBySteps(CodeCount(stereo(640, 75, 8, 5)), kCols), findKind("tum"));
  EXPECT_EQ(kindBySteps(CodeCount(stereo(640, 95, 32, 1)), 1280), nullptr);
  // Without steps the range decides, as for a renderer.
  const Frame even = makeGrayFrame(kCols, kRows, 16, {}, [](int c, int r) { return 5000u + 3 * c + 60 * r; });
  EXPECT_FALSE(stereoConstant(CodeCount(even)));
}

// .25 m at 5000 codes a metre: a hand in front, and one picture of three.
TEST(SensorRange, AFewNearSamplesMakeNoMillimetres) {
  const auto picture = [](int near_from) {
    return makeGrayFrame(kCols, kRows, 16, {}, [=](int c, int r) {
      return c >= near_from ? 1200u + static_cast<std::uint32_t>(r) : 5u * static_cast<std::uint32_t>(distanceMm(c, r));
    });
  };
  EXPECT_EQ(kindIn(picture(kCols - 2)), findKind("tum"));
  EXPECT_EQ(kindIn(picture(kCols - 20)), findKind("mm"));
  CodeCount three(picture(kCols));
  three.addLater(picture(kCols)), three.addLater(picture(kCols - 20));
  EXPECT_EQ(sensorKind(picture(kCols), three), findKind("tum"));
}

// Recorders in mm lay out their folders as TUM does, whose codes are fifths of a mm.
TEST(SensorRange, AFolderLaidOutAsTumsMayBeInMillimetres) {
  const auto film = [](double times) {
    const test::TemporaryFolder folder;
    for (const char* const name : {"rgb", "depth"}) std::filesystem::create_directories(folder / name);
    std::ofstream(folder / "associations.txt") << "1.5 rgb/1.png 1.5 depth/1.png\n";
    test::makeClip(folder / "rgb/1.png", {pictures("rgb24", [](int k, int c, int r) { return 40u * k + c + r / 2; })});
    test::makeClip(folder / "depth/1.png", {pictures("gray16be", [=](int, int c, int r) {
                     return static_cast<std::uint32_t>(std::lround(times * distanceMm(c, r)));
                   })});
    return test::openFilm({.url = folder / "."});
  };
  const test::OpenedFilm mm = film(1), tum = film(5);
  EXPECT_EQ(mm.info.calibration.calibration.unit_mm, 1.0);
  EXPECT_THAT(mm.info.reading.doubts, Contains(HasSubstr("--as tum")));
  EXPECT_EQ(tum.info.calibration.calibration.unit_mm, 0.2);
  for (const test::OpenedFilm* const of : {&mm, &tum}) EXPECT_NEAR(of->distanceAt(80, 54), distanceMm(80, 54), 1);
}

// Distances that could be mm as well are TUM's where names or a list beside it or above it say so, whatever words the
// path has.
TEST(SensorRange, TumsLayoutSaysItsUnitWhereThePicturesDoNot) {
  const test::TemporaryFolder folder;
  const auto expectTum = [&](const std::string& place, const std::string& name, const std::string& list) {
    for (const char* const of : {"/rgb", "/depth"}) std::filesystem::create_directories(folder / (place + of));
    const std::string rgb = "/rgb/" + name + ".png", depth = "/depth/" + name + ".png";
    test::makeClip(folder / (place + rgb), {pictures("rgb24", [](int k, int c, int r) { return 40 * k + c + r / 2; })});
    test::makeClip(folder / (place + depth),
                   {pictures("gray16be", [](int, int c, int r) { return 2800 + 9 * c + r; })});
    const std::string camera = place.substr(place.find('/') + 1), top = place.substr(0, place.find('/'));
    if (!list.empty()) {
      const std::string under = list == "above" ? camera : ".";
      std::ofstream(folder / ((list == "above" ? top : place) + "/associations.txt"))
          << "1.5 " + under + rgb + " 1.5 " + under + depth + "\n";
    }
    const test::OpenedFilm film = test::openFilm({.url = folder / (list == "above" ? top : place)});
    EXPECT_EQ(film.info.calibration.calibration.unit_mm, 0.2) << place;
  };
  expectTum("t1", "10.225000", "");
  expectTum("t2/cam", "0", "above");
  expectTum("kitti_mix/fr", "0", "beside");
}

// Redwood's times are no seconds, and its codes are mm.
TEST(SensorRange, SecondsAndListsAloneAreTums) {
  const test::TemporaryFolder folder;
  const auto kindOfDepth = [&](const std::string& name, const std::string& time) {
    std::filesystem::create_directories(folder / (name + "/depth"));
    std::ofstream(folder / (name + "/depth/" + time + ".png")) << "-";
    return lookAtPlace(folder / (name + "/depth/" + time + ".png"), "").kind;
  };
  EXPECT_EQ(kindOfDepth("t", "1305031102.160407"), findKind("tum"));
  EXPECT_EQ(kindOfDepth("s", "10.225000"), nullptr);
  std::filesystem::create_directories(folder / "s/rgb");
  EXPECT_EQ(kindOfDepth("s", "10.225000"), findKind("tum")) << "beside rgb";
  EXPECT_EQ(kindOfDepth("r", "0000001-000000033369"), nullptr);
  EXPECT_EQ(kindOfDepth("n", "1403636579763555584"), nullptr);
  for (const char* const list : {"associations.txt", "associate.txt", "association.txt", "assoc.txt"}) {
    std::ofstream(folder / ("n/" + std::string(list))) << "1 rgb/1.jpg 1 depth/1.png\n";
    EXPECT_EQ(kindOfDepth("n", "1403636579763555584"), findKind("tum")) << list;
    std::filesystem::remove(folder / ("n/" + std::string(list)));
  }
}

// 65535 in metres: as arrays of floats have it that were divided by 1000.
TEST(SensorRange, TheHighestCodeIsAHoleInMetresToo) {
  const auto meaning = [](std::uint32_t farthest, double value) {
    Frame frame = makeGrayFrame(kCols, kRows, 16, {}, [=](int c, int r) {
      const double mm = distanceMm(c, r);
      return c > 120 ? farthest : static_cast<std::uint32_t>(std::lround(mm / (1000 * value)));
    });
    frame.value_per_code = value;
    return readMeaning(DepthClues{.codec = "npy", .path = "depth.npy"}, nullptr, frame).value();
  };
  const DepthCalibration hole = meaning(13107, 0.005).calibration.calibration;
  EXPECT_EQ(hole.invalid, CodeSet::parse("0+13107").value());
  EXPECT_LT(hole.far_mm, 4000);
  // The same share at 65.53 m is a background behind a gap, and told as such.
  const DepthMeaning wall = meaning(13106, 0.005);
  EXPECT_THAT(wall.reading.doubts, Contains(HasSubstr("taken for background")));
  EXPECT_THAT(meaning(13107, 0.005).reading.doubts, Not(Contains(HasSubstr("taken for background"))));
}

// A gripper below, too near to be measured: 65.535 is none of the numbers that tell distances from disparities.
TEST(SensorRange, AHoleBelowDoesNotMakeDistancesDisparities) {
  const auto meaning = [](const char* codec, const auto& metres) {
    Frame frame = makeGrayFrame(kCols, 100, 16, {}, [=](int, int r) {
      return r < 70 ? static_cast<std::uint32_t>(std::lround(metres(r) / 0.005)) : 13107u;
    });
    frame.value_per_code = 0.005;
    return readMeaning(DepthClues{.codec = codec, .path = "frame." + std::string(codec)}, nullptr, frame).value();
  };
  const auto floor = [](int r) { return 9 - 8.2 * r / 69; };
  // A window behind a desk, a hand before it: without the hole the view is nearest below.
  const auto room = [](int r) { return r < 33 ? 3.0 : r < 66 ? 9.0 : 0.11; };
  for (const char* const codec : {"npy", "pfm"}) {
    for (const DepthMeaning& read : {meaning(codec, floor), meaning(codec, room)}) {
      const DepthCalibration& distances = read.calibration.calibration;
      EXPECT_EQ(distances.unit_mm, 5.0) << codec;
      EXPECT_EQ(distances.polarity, DepthPolarity::NearIsLow) << codec;
      EXPECT_EQ(distances.invalid, CodeSet::parse("0+13107").value()) << codec;
      EXPECT_LT(distances.far_mm, 10'000) << codec;
    }
  }
}

// Brightness of 0 to 65535 in floats.
TEST(SensorRange, TheHighestNumberOfAnEvenRangeIsNoHole) {
  Frame frame = makeGrayFrame(kCols, kRows, 16, {}, [](int c, int r) { return 1u + 2 * (c + 160 * r) % 13107; });
  frame.value_per_code = 5;
  ASSERT_GT(CodeCount(frame).of(13107), 0u);
  EXPECT_FALSE(fullCode(frame, CodeCount(frame)));
}

TEST(SensorRange, CodesThatWouldBeNearerThanAnySensorSeesAreDoubted) {
  const auto doubts = [](std::uint32_t nearest) {
    const Frame frame = makeGrayFrame(kCols, kRows, 16, {}, [=](int c, int r) { return nearest + (c + r) % 11; });
    const DepthClues clues{.codec = "npy", .path = "depth.npy"};
    return readMeaning(clues, kindOf(clues, frame), frame).value().reading.doubts;
  };
  EXPECT_THAT(doubts(5), Contains(HasSubstr("nearer than a sensor sees")));
  EXPECT_THAT(doubts(300), Not(Contains(HasSubstr("nearer than a sensor sees"))));
}

}  // namespace
}  // namespace relievo
