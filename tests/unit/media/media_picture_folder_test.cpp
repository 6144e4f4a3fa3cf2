// SPDX-License-Identifier: Apache-2.0
// Recordings of single pictures, opened as the programs open them and read as pairs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "app/media/pair_reader.h"
#include "platform/whole_file.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/real_backends.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::sampleAt;
using test::TemporaryFolder;

class PictureFolder : public testing::Test {
 protected:
  // A PNM written by hand, every sample of which is `value`: 8 bits RGB, or 16 bits gray.
  void picture(const std::string& name, int value) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    const bool color = path.extension() == ".ppm";
    file << (color ? "P6\n8 6\n255\n" : "P5\n8 6\n65535\n");
    for (int i = 0; i < 48; ++i) {
      if (color) file.put(static_cast<char>(value)).put(static_cast<char>(value)).put(static_cast<char>(value));
      else file.put(static_cast<char>(value >> 8)).put(static_cast<char>(value & 255));
    }
  }
  // "ms colour:depth" of every pair.
  [[nodiscard]] std::string story(const SourceOptions& options, std::optional<MediaTime> from = std::nullopt) const {
    PairReader reader(kReal);
    if (auto opened = reader.open(options); !opened) return opened.error().message;
    if (from && !reader.seek(*from)) return "no seek";
    std::string text;
    for (auto pair = reader.next(); pair && *pair; pair = reader.next()) {
      char words[64];
      const Frame& depth = (*pair)->depth;
      std::snprintf(words, sizeof words, "%s%.6g %u:%d", text.empty() ? "" : ", ", 1e3 * toSeconds((*pair)->color.pts),
                    sampleAt((*pair)->color, 0, 3, 3), depth.empty() ? -1 : static_cast<int>(sampleAt(depth, 0, 3, 3)));
      text += words;
    }
    return text;
  }
  TemporaryFolder folder_;
};

TEST_F(PictureFolder, SecondsInNamesAreTheFilmsTimesAndPairIt) {
  picture("t/rgb/1305031102.175304.ppm", 1), picture("t/rgb/1305031102.211214.ppm", 2),
      picture("t/rgb/1305031102.243211.ppm", 3);
  picture("t/depth/1305031102.160407.pgm", 1001), picture("t/depth/1305031102.226738.pgm", 1002),
      picture("t/depth/1305031102.262886.pgm", 1003);
  EXPECT_EQ(story({.url = folder_ / "t"}), "0 1:1001, 35.91 2:1002, 67.907 3:1003");
}

// ARKitScenes, Polycam and NICE-SLAM's Replica, Virtual KITTI.
TEST_F(PictureFolder, OtherNamesAndDeeperFoldersAreFound) {
  picture("a/lowres_wide/41069021_305.377.ppm", 1), picture("a/lowres_wide/41069021_305.477.ppm", 2);
  picture("a/lowres_depth/41069021_305.377.pgm", 1001), picture("a/lowres_depth/41069021_305.477.pgm", 1002);
  EXPECT_EQ(story({.url = folder_ / "a"}), "0 1:1001, 100 2:1002");
  picture("b/keyframes/images/7.ppm", 3), picture("b/keyframes/depth/7.pgm", 1003), picture("b/mesh/1/2.ppm", 9);
  EXPECT_EQ(story({.url = folder_ / "b"}), "0 3:1003");
  picture("c/rgb/Camera_0/rgb_00000.ppm", 4), picture("c/depth/Camera_0/depth_00000.pgm", 1004);
  picture("c/rgb/Camera_1/rgb_00000.ppm", 9), picture("c/depth/Camera_1/depth_00000.pgm", 9);
  EXPECT_EQ(story({.url = folder_ / "c"}), "0 4:1004");
}

TEST_F(PictureFolder, NamesAndCameraFilesGiveTheUnit) {
  picture("m/undistorted_color_images/a_i0_0.ppm", 1), picture("m/undistorted_depth_images/a_d0_0.pgm", 8000);
  picture("v/rgb/Camera_0/rgb_00000.ppm", 1), picture("v/depth/Camera_0/depth_00000.pgm", 2000);
  picture("r/results/frame000000.ppm", 1), picture("r/results/depth000000.pgm", 13107);
  std::ofstream(folder_ / "r/cam_params.json") << R"({"camera": {"w": 1200, "h": 680, "scale": 6553.5}})";
  for (const char* name : {"o/color/1.ppm", "n/images/1.ppm", "i/images/1.ppm", "f/1.left.ppm"}) picture(name, 1);
  for (const char* name : {"o/depth/1.pgm", "n/depths/1.pgm", "i/depth/1.pgm", "f/1.left.depth.pgm"})
    picture(name, 13107);
  std::ofstream(folder_ / "o/camera_intrinsic.json") << R"({"depth_scale": 4000.0, "height": 480})";  // Open3D
  std::ofstream(folder_ / "n/transforms.json") << R"({"depth_unit_scale_factor": 0.0005, "frames": []})";
  std::ofstream(folder_ / "i/transforms.json") << R"({"integer_depth_scale": 0.000125, "frames": []})";
  std::ofstream(folder_ / "f/_camera_settings.json") << R"({"camera_settings": [{"name": "left"}]})";
  const auto unit = [&](const char* name) {
    PairReader reader(kReal);
    EXPECT_TRUE(reader.open({.url = folder_ / name}));
    return reader.info().calibration.calibration.unit_mm.value_or(0);
  };
  EXPECT_EQ(unit("m"), 0.25);
  const std::string point = "b/0f37bd0737e349de9d536263a4bdd60d";
  picture(point + "_i0_3.ppm", 7), picture(point + "_d0_3.pgm", 8000);
  EXPECT_EQ(unit("b"), 0.25) << "Matterport3D without its folders";
  EXPECT_EQ(unit((point + "_d0_3.pgm").c_str()), 0.25);
  EXPECT_EQ(story({.url = folder_ / "b"}), "0 7:8000");
  EXPECT_EQ(unit("v"), 10);
  EXPECT_NEAR(unit("r"), 1000 / 6553.5, 1e-6);
  EXPECT_EQ(unit("o"), 0.25);
  EXPECT_EQ(unit("n"), 0.5);
  EXPECT_EQ(unit("i"), 0.125);
  EXPECT_EQ(unit("f"), 0.1);
  picture("s/results/frame000000.ppm", 1), picture("s/results/depth000000.pgm", 13107);
  std::ofstream(folder_ / "s/traj.txt") << "1 0 0 0\n";
  EXPECT_EQ(unit("s"), 0.15259) << "NICE-SLAM's Replica without its cam_params.json";
  picture("k/color/1560000072.05.ppm", 1), picture("k/depth/1560000072.05.pgm", 2568);
  EXPECT_NE(unit("k"), 0.2) << "not TUM's, whose colour is in rgb/";
  picture("l/color/1560000072.05.ppm", 1), picture("l/aligned_depth/1560000072.05.pgm", 2568);
  EXPECT_EQ(unit("l"), 1) << "OpenLORIS";
  picture("l/depth/1560000072.05.pgm", 2000), picture("l/depth/1560000072.08.pgm", 2000);
  EXPECT_EQ(unit("l"), 1) << "the depth that lies in the colour's view is taken";
  EXPECT_EQ(story({.url = folder_ / "l"}), "0 1:2568");
}

// Stray Scanner: times that are no multiples of a period.
TEST_F(PictureFolder, APosesTableBesideTheDepthHasItsTimes) {
  for (const int k : {0, 1, 2}) picture("s/depth/00000" + std::to_string(k) + ".pgm", 1000 + k);
  const auto write = [&](const char* last) {
    std::ofstream(folder_ / "s/odometry.csv")
        << "timestamp, frame, x, y, z, qx, qy, qz, qw\n5363.400000, 000000, 0, 0, 0, 0, 0, 0, 1\n"
           "5363.416700, 000001, 0, 0, 0, 0, 0, 0, 1\n"
        << last;
  };
  const auto times = [&] {
    PairReader reader(kReal);
    std::string text;
    EXPECT_TRUE(reader.open({.url = folder_ / "s/depth"}));
    for (auto pair = reader.next(); pair && *pair; pair = reader.next())
      text += std::to_string((*pair)->color.pts.time_since_epoch() / 1us) + " ";
    return text;
  };
  write("5363.500001, 000002, 0, 0, 0, 0, 0, 0, 1\n");
  EXPECT_EQ(times(), "0 16700 100001 ");
  write("5363.500001, 000007, 0, 0, 0, 0, 0, 0, 1\n");
  EXPECT_EQ(times(), "0 33333 66666 ") << "a picture without a line";
}

TEST_F(PictureFolder, AGapInTheNumbersIsTimeAndSeeksFindEveryPicture) {
  for (const int k : {5, 6, 9, 10})
    picture("frame-" + std::to_string(k) + ".color.ppm", k),
        picture("frame-" + std::to_string(k) + ".depth.pgm", 1000 + k);
  const SourceOptions options{.url = folder_ / ".", .frames_per_s = 10};
  EXPECT_EQ(story(options), "0 5:1005, 100 6:1006, 400 9:1009, 500 10:1010");
  EXPECT_EQ(story(options, MediaTime(100ms)), "100 6:1006, 400 9:1009, 500 10:1010");
  EXPECT_EQ(story(options, MediaTime(101ms)), "100 6:1006, 400 9:1009, 500 10:1010");
}

TEST_F(PictureFolder, TwoFoldersWhoseNamesAreFromOneClockKeepTheirDistance) {
  for (int k = 0; k < 5; ++k)
    picture("c/" + std::to_string(k + 2) + ".ppm", k + 2), picture("d/" + std::to_string(k) + ".pgm", 1000 + k);
  const SourceOptions options{.url = folder_ / "c", .depth_url = folder_ / "d", .frames_per_s = 10};
  EXPECT_EQ(story(options), "0 2:1002, 100 3:1003, 200 4:1004, 300 5:-1, 400 6:-1");
  EXPECT_EQ(story(options, MediaTime(100ms)), "100 3:1003, 200 4:1004, 300 5:-1, 400 6:-1");
  // Too far apart to be one count: they begin together.
  EXPECT_EQ(story({.url = folder_ / "c/*.ppm", .depth_url = folder_ / "d/%d.pgm", .frames_per_s = 10}), story(options));
  picture("e/100.pgm", 1), picture("e/101.pgm", 2);
  EXPECT_EQ(story({.url = folder_ / "c", .depth_url = folder_ / "e", .frames_per_s = 10}),
            "0 2:1, 100 3:2, 200 4:-1, 300 5:-1, 400 6:-1");
}

// Distances from `near` to `far` mm, row by row, with a hole in each row; RealSense's and many others' 16 bits.
void slope(const std::filesystem::path& path, int near, int far) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << "P5\n32 24\n65535\n";
  for (int i = 0; i < 32 * 24; ++i) {
    const int mm = i % 32 == 0 ? 0 : near + (far - near) * i / (32 * 24 - 1);
    file.put(static_cast<char>(mm >> 8)).put(static_cast<char>(mm & 255));
  }
}

TEST_F(PictureFolder, NearAndFarHoldForTheWholeRecording) {
  for (int k = 10; k < 40; ++k) {
    picture("f/rgb/" + std::to_string(k) + ".ppm", k);
    // First a hand comes into view, then the far end of the room.
    slope(folder_ / ("f/depth/" + std::to_string(k) + ".pgm"), k < 20 ? 570 : 220, k < 25 ? 2130 : 3640);
  }
  PairReader reader(kReal);
  ASSERT_TRUE(reader.open({.url = folder_ / "f"}));
  const DepthCalibration& read = reader.info().calibration.calibration;
  EXPECT_EQ(read.unit_mm, 1.0);
  EXPECT_LE(read.near_mm, 220);
  EXPECT_GE(read.near_mm, 0.85 * 220);
  EXPECT_GE(read.far_mm, 3640);
  EXPECT_LE(read.far_mm, 1.15 * 3640);
  ASSERT_FALSE(reader.info().reading.why.empty());
  EXPECT_NE(reader.info().reading.why.back().find("0.2"), std::string::npos) << reader.info().reading.why.back();
  // The pictures come in their order all the same.
  const auto pair = reader.next();
  ASSERT_TRUE(pair && *pair);
  EXPECT_EQ(sampleAt((*pair)->depth, 0, 31, 23), 2130u);
}

// 5000 codes a metre look like mm while all is near, mm look like 5000 a metre while all is far.
TEST_F(PictureFolder, TheUnitIsToldFromTheWholeRecording) {
  const struct {
    const char* name;
    int first_low, first_high, later_low, later_high;
    double unit_mm, near_mm, far_mm;
  } kFolders[] = {{"tum", 4000, 4900, 4100, 17000, 0.2, 800, 3400}, {"mm", 5200, 8100, 640, 7900, 1, 640, 8100}};
  for (const auto& folder : kFolders) {
    const std::string name = folder.name;
    for (int k = 10; k < 40; ++k) {
      picture(name + "/rgb/" + std::to_string(k) + ".ppm", k);
      const bool later = k > 25;
      slope(folder_ / (name + "/depth/" + std::to_string(k) + ".pgm"), later ? folder.later_low : folder.first_low,
            later ? folder.later_high : folder.first_high);
    }
    PairReader reader(kReal);
    ASSERT_TRUE(reader.open({.url = folder_ / name}));
    const DepthCalibration& read = reader.info().calibration.calibration;
    EXPECT_EQ(read.unit_mm, folder.unit_mm) << name;
    EXPECT_LE(read.near_mm, folder.near_mm) << name;
    EXPECT_GE(read.near_mm, 0.85 * folder.near_mm) << name;
    EXPECT_GE(read.far_mm, folder.far_mm) << name;
    EXPECT_LE(read.far_mm, 1.15 * folder.far_mm) << name;
  }
}

TEST_F(PictureFolder, APictureBeyondThoseLookedAtIsToldOnce) {
  for (int k = 0; k < 64; ++k) {
    picture("o/rgb/" + std::to_string(100 + k) + ".ppm", k);
    const bool strange = k == 4 || k == 5;  // not among the pictures that are looked at when the folder is opened
    slope(folder_ / ("o/depth/" + std::to_string(100 + k) + ".pgm"), 570, strange ? 4000 : 2130);
  }
  PairReader reader(kReal);
  ASSERT_TRUE(reader.open({.url = folder_ / "o"}));
  EXPECT_LT(reader.info().calibration.calibration.far_mm, 2500);
  testing::internal::CaptureStderr();
  for (auto pair = reader.next(); pair && *pair; pair = reader.next()) {
  }
  const std::string said = testing::internal::GetCapturedStderr();
  const std::size_t option = said.find("--calibration near=");
  ASSERT_NE(option, std::string::npos) << said;
  EXPECT_EQ(said.find("--calibration", option + 1), std::string::npos) << said;
  // With the option that the message suggests, the strange picture is within near and far.
  int near = 0, far = 0;
  ASSERT_EQ(std::sscanf(said.c_str() + option, "--calibration near=%d,far=%d", &near, &far), 2);
  EXPECT_LE(near, 570);
  EXPECT_GE(far, 4000);
  EXPECT_LE(far, 4600);
}

// Recorders state as the highest code what their sensor can measure, or what the picture holds.
TEST_F(PictureFolder, CodesOfAPgmStayWhateverItsHighestOneIs) {
  slope(folder_ / "p/depth/1.pgm", 600, 2130);
  std::string text = *readWholeFile(folder_ / "p/depth/1.pgm", FileSize::Recording, "");
  text.replace(0, std::string("P5\n32 24\n65535").size(), "P5\n# made by 4.2\n32 24\n10000");
  std::ofstream(folder_ / "p/depth/1.pgm", std::ios::binary) << text;
  picture("p/rgb/1.ppm", 9);
  for (const char* url : {"p", "p/depth/1.pgm"}) {
    PairReader reader(kReal);
    ASSERT_TRUE(reader.open({.url = folder_ / url}));
    EXPECT_EQ(reader.info().calibration.calibration.unit_mm, 1.0) << url;
    const auto pair = reader.next();
    ASSERT_TRUE(pair && *pair);
    EXPECT_EQ(sampleAt((*pair)->depth, 0, 31, 23), 2130u) << url;
  }
}

TEST_F(PictureFolder, NyusRawDepthIsReadAsItWasMeant) {
  picture("n/r-1294886362.665769-31.ppm", 9), picture("n/r-1294886363.665769-32.ppm", 9);
  picture("n/d-1294886362.660000-41.pgm", 0x2c01), picture("n/d-1294886363.660000-42.pgm", 0xff07);  // bytes swapped
  EXPECT_EQ(story({.url = folder_ / "n"}), "0 9:300, 1000 9:2047");
  // The bytes have been put in order by then, so that naming the kind changes nothing.
  EXPECT_EQ(story({.url = folder_ / "n", .as = findKind("nyu-raw")}), "0 9:300, 1000 9:2047");
  const auto last = [&](const std::string& url) {
    PairReader reader(kReal);
    if (!reader.open({.url = url, .as = findKind("nyu-raw")})) return -1;
    const auto pair = reader.next();
    if (!pair || !*pair || (*pair)->depth.empty()) return -1;
    const Frame& depth = (*pair)->depth;
    return static_cast<int>(sampleAt(depth, 0, depth.width - 1, depth.height - 1));
  };
  slope(folder_ / "o/d-1294886362.660000-41.pgm", 400, 900);  // in order from the beginning
  EXPECT_EQ(last(folder_ / "o/d-*.pgm"), 900);
  picture("m/depth-1.pgm", 0x2c01), picture("m/depth-2.pgm", 0xff07);  // by a name that no reader knows
  EXPECT_EQ(last(folder_ / "m/depth-*.pgm"), 300);
}

// As depthy leaves them: each is a photo, and no film of 30 a second.
TEST_F(PictureFolder, PairsWithUnrelatedNamesArePhotosThatStand) {
  picture("p/cat-image.ppm", 1), picture("p/cat-depth.pgm", 1001);
  picture("p/old house-image.ppm", 2), picture("p/old house-depth.pgm", 1002);
  EXPECT_EQ(story({.url = folder_ / "p"}), "0 1:1001, 5000 2:1002");
  EXPECT_EQ(story({.url = folder_ / "p/old house-image.ppm"}), "0 2:1002");
  EXPECT_EQ(story({.url = folder_ / "p", .frames_per_s = 10}), "0 1:1001, 100 2:1002");
  PairReader reader(kReal);
  ASSERT_TRUE(reader.open({.url = folder_ / "p"}));
  ASSERT_FALSE(reader.info().notes.empty());
  EXPECT_NE(reader.info().notes.back().find("photos"), std::string::npos) << reader.info().notes.back();
  picture("q/a-1-x-image.ppm", 1), picture("q/a-1-x-depth.pgm", 1001);
  picture("q/a-2-x-image.ppm", 2), picture("q/a-2-x-depth.pgm", 1002);
  EXPECT_EQ(story({.url = folder_ / "q"}), "0 1:1001, 33.3333 2:1002");
}

// "1.jpg" and its depth "1.png", which no word tells apart; a mask or a smaller copy is no depth.
TEST_F(PictureFolder, GrayOf16BitsBesideAPhotoOfItsNameIsItsDepth) {
  const auto save = [&](const std::string& name, const char* codec, const char* format, std::uint32_t value) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    test::ClipTrack track{.codec = codec, .pix_fmt = format, .width = 16, .height = 16, .frames = 1};
    track.sample = [value](int, int, int, int) { return value; };
    test::makeClip(folder_ / name, {track});
  };
  for (const std::string stem : {"p/0001", "p/0002", "m/0001", "m/0002"}) save(stem + ".jpg", "mjpeg", "yuvj444p", 128);
  save("p/0001.png", "png", "gray16be", 1001), save("p/0002.png", "png", "gray16be", 1002);
  save("m/0001.png", "png", "gray", 255), save("m/0002.png", "png", "gray", 255);
  EXPECT_EQ(story({.url = folder_ / "p"}), "0 128:1001, 33.3333 128:1002");
  EXPECT_EQ(story({.url = folder_ / "m"}), "0 128:-1, 33.3333 128:-1");
}

TEST_F(PictureFolder, ADamagedFirstPictureHidesNoOther) {
  std::ofstream(folder_ / "1.ppm") << "P6";
  picture("2.ppm", 2), picture("3.ppm", 3);
  EXPECT_EQ(story({.url = folder_ / "%d.ppm", .frames_per_s = 10}), "100 2:-1, 200 3:-1");
}

TEST_F(PictureFolder, ARateThatHasNoEffectIsTold) {
  const auto toldFor = [&](const std::string& url, double rate) {
    PairReader reader(kReal);
    EXPECT_TRUE(reader.open({.url = url, .frames_per_s = rate})) << url;
    const auto& notes = reader.info().notes;
    return std::ranges::any_of(notes, [](const std::string& note) { return note.starts_with("--fps has no effect"); });
  };
  test::makeClip(folder_ / "film.mkv", {{.frames = 3}});
  test::makeClip(folder_ / "raw.h264", {{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 3}});
  picture("s/1305031102.175304.ppm", 1), picture("s/1305031102.211214.ppm", 2);
  picture("n/1.ppm", 1), picture("n/2.ppm", 2);
  EXPECT_TRUE(toldFor(folder_ / "film.mkv", 10));
  EXPECT_TRUE(toldFor(folder_ / "s", 10));
  EXPECT_FALSE(toldFor(folder_ / "raw.h264", 10));
  EXPECT_FALSE(toldFor(folder_ / "n", 10));
  EXPECT_FALSE(toldFor(folder_ / "n/1.ppm", 10)) << "one picture";
}

}  // namespace
}  // namespace relievo
