// SPDX-License-Identifier: Apache-2.0
// What lies beside a recording and gives its distances: Middlebury's calib.txt, Depthkit's files and
// LeRobot's info.json, written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::kSceneCols;
using test::kSceneRows;
using test::write;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// Two cameras 120 mm apart.
constexpr double kFocal = 400, kBaseline = 120, kOffset = 20;
std::string calib(double size, const std::string& more) {
  std::ostringstream text;
  text << "cam0=[" << size * kFocal << " 0 80; 0 " << size * kFocal << " 54; 0 0 1]\ncam1=[" << size * kFocal
       << " 0 100; 0 400 54; 0 0 1]\ndoffs=" << size * kOffset << "\nbaseline=" << kBaseline << "\n"
       << more;
  return text.str();
}
// Middlebury 2014: Z = baseline * f / (d + doffs); 0 for a hole.
double disparityAt(int c, int r) {
  const double mm = distanceMm(c, r);
  return mm == 0 ? 0 : kBaseline * kFocal / mm - kOffset;
}

// Rows from the bottom up; a negative scale says little endian.
void writePfm(const std::string& path, double size) {
  std::string bytes = "Pf\n160 108\n-1\n";
  for (int r = kSceneRows - 1; r >= 0; --r) {
    for (int c = 0; c < kSceneCols; ++c) {
      const double px = disparityAt(c, r);
      const auto value = px == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(size * px);
      char word[4];
      std::memcpy(word, &value, 4);
      bytes.append(word, 4);
    }
  }
  write(path, bytes);
}
void writePng(const std::string& path, const std::string& format, double codes_per_pixel) {
  ClipTrack track{.codec = "png", .pix_fmt = format, .width = kSceneCols, .height = kSceneRows, .frames = 1};
  track.sample = [=](int, int c, int r, int) {
    return static_cast<std::uint32_t>(std::lround(codes_per_pixel * disparityAt(c, r)));
  };
  test::makeClip(path, {track});
}

class CalibTxt : public testing::Test {
 protected:
  void SetUp() override {
    ClipTrack photo{.codec = "png", .pix_fmt = "rgb24", .width = kSceneCols, .height = kSceneRows, .frames = 1};
    photo.sample = [](int k, int c, int r, int) {
      return static_cast<std::uint32_t>(255 * test::photoOf(c, r)[static_cast<std::size_t>(k)]);
    };
    test::makeClip(folder_ / "im0.png", {photo});
  }
  test::OpenedFilm open(const std::string& depth, const SourceOptions& more = {}) {
    SourceOptions options = more;
    options.url = folder_ / "im0.png";
    options.depth_url = folder_ / depth;
    return test::openFilm(options);
  }
  static void expectDistances(const test::OpenedFilm& film, double pixels_off = 0) {
    ASSERT_TRUE(film.info.has_depth);
    for (int c = 20; c < kSceneCols; c += 7) {
      const double mm = distanceMm(c, 60);
      EXPECT_NEAR(film.distanceAt(c, 60), mm, 0.003 * mm + pixels_off * mm * mm / (kBaseline * kFocal)) << c;
    }
    EXPECT_TRUE(std::isnan(film.heightAt(5, 60)));
  }
  test::TemporaryFolder folder_;
};

TEST_F(CalibTxt, GivesTheDistancesOfDisparities) {
  writePfm(folder_ / "disp0.pfm", 1);
  for (const char* range : {"vmin=3\nvmax=26\n", "", "vmin=9\nvmax=2\n"}) {
    write(folder_ / "calib.txt", calib(1, range));
    const test::OpenedFilm film = open("disp0.pfm");
    expectDistances(film);
    EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("calib.txt"))) << range;
    EXPECT_THAT(partLines(film.info.reading), Contains("kind=disparities in pixels: file beside it, said"));
  }
  write(folder_ / "calib.txt", calib(1, "vmin=3\nvmax=26\n"));
  EXPECT_NEAR(open("disp0.pfm").info.calibration.calibration.far_mm, kBaseline * kFocal / (3 + kOffset), 5);
}

TEST_F(CalibTxt, HoldsForPicturesOfAnotherSize) {
  writePfm(folder_ / "disp0.pfm", 1);
  write(folder_ / "calib.txt", calib(2, "width=320\nheight=216\nvmin=6\nvmax=52\n"));
  expectDistances(open("disp0.pfm"));
}

TEST_F(CalibTxt, HoldsForPicturesOfWholeNumbers) {
  write(folder_ / "calib.txt", calib(1, "vmin=3\nvmax=26\n"));
  writePng(folder_ / "disp0.png", "gray", 1);
  expectDistances(open("disp0.png"), 0.5);
  writePng(folder_ / "disp1.png", "gray16be", 256);
  expectDistances(open("disp1.png"), 1.0 / 512);
}

TEST_F(CalibTxt, IsForDisparitiesAlone) {
  write(folder_ / "calib.txt", calib(1, ""));
  writePfm(folder_ / "depth0.pfm", 1);
  const test::OpenedFilm named = open("depth0.pfm");
  EXPECT_THAT(named.info.reading.why, Contains(HasSubstr("distances")));
  expectDistances(open("depth0.pfm", {.as = findKind("middlebury")}));
  // The user's value wins over the side file; a file of that name from another program is ignored.
  writePfm(folder_ / "disp0.pfm", 1);
  EXPECT_NEAR(open("disp0.pfm", {.command_line = {{"unit", "1000"}}}).distanceAt(80, 54), 1000 * disparityAt(80, 54),
              100);
  for (const char* text :
       {"P0: 718 0 607 0\n", "cam0=[0 0 0]\nbaseline=12\n", "cam0=[400 0 1]\nbaseline=nan\n", "cam0=["}) {
    write(folder_ / "calib.txt", text);
    EXPECT_THAT(open("disp0.pfm").info.reading.why, Not(Contains(HasSubstr("calib.txt")))) << text;
  }
}

// Without the cameras the distances have no scale, but the law is known: Z = k / d.
TEST_F(CalibTxt, NamesAloneMakeEightBitsInverseDepth) {
  for (const char* name : {"disp.png", "disparity/left.png"}) {
    std::filesystem::create_directory(folder_ / "disparity");
    writePng(folder_ / name, "gray", 4);
    const test::OpenedFilm film = open(name);
    const DepthCalibration& read = film.info.calibration.calibration;
    EXPECT_EQ(read.law, DepthLaw::Inverse) << name;
    EXPECT_EQ(read.polarity, DepthPolarity::NearIsHigh) << name;
    EXPECT_THAT(partLines(film.info.reading), Contains("law=inverse: name, likely")) << name;
    EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("the name says disparity"))) << name;
    for (int c = 20; c < kSceneCols; c += 7) {
      const double ratio = disparityAt(80, 54) / disparityAt(c, 60);
      EXPECT_NEAR(film.distanceAt(c, 60) / film.distanceAt(80, 54), ratio, 0.06 * ratio) << name << " " << c;
    }
    EXPECT_TRUE(std::isnan(film.heightAt(5, 60))) << name;
    EXPECT_EQ(open(name, {.as = findKind("near-dark")}).info.calibration.calibration.polarity,
              DepthPolarity::NearIsLow);
  }
  writePng(folder_ / "display.png", "gray", 4);
  EXPECT_EQ(open("display.png").info.calibration.calibration.law, DepthLaw::Linear);
}

// Colour above, hue from 0.9 to 2.4 m below.
class DepthkitFile : public testing::Test {
 protected:
  void SetUp() override {
    ClipTrack film{.pix_fmt = "yuv444p", .width = kSceneCols, .height = 2 * kSceneRows, .frames = 2};
    film.sample = [](int k, int c, int r, int) {
      if (r < kSceneRows) return test::yuvCode(k, test::photoOf(c, r));
      const double mm = distanceMm(c, r - kSceneRows);
      return test::yuvCode(k, mm == 0 ? std::array{0.0, 0.0, 0.0} : test::hueColor((mm - 900) / 1500));
    };
    test::makeClip(folder_ / "clip.mkv", {film});
  }
  test::TemporaryFolder folder_;
};

TEST_F(DepthkitFile, IsReadInMetresAndMillimetresAsTextAndAsset) {
  const struct {
    const char *name, *text;
  } files[] = {
      {"clip.txt", R"({"format": "perpixel", "perspectives": [{"nearClip": 0.9, "farClip": 2.4}]})"},
      {"clip_meta.txt", R"({"_versionMajor": 0, "nearClip" : 900.0, "farClip":2400})"},
      {"clip.json", R"({"perspectives": [{"nearClip": 0.9, "farClip": 2.4}, {"nearClip": 0.3, "farClip": 3}]})"},
      {"clip.asset", "MonoBehaviour:\n  m_Name: clip\n  farClip: 2.4\n  nearClip: 0.9\n"},
      {"clip.Metadata.asset", R"(TextAsset: "{\"nearClip\": 0.9, \"farClip\": 2.4}")"},
      {"clip_meta.asset", R"(TextAsset: "{\"nearClip\": 0.9, \"farClip\": 2.4}")"},
  };
  for (const auto& file : files) {
    write(folder_ / file.name, file.text);
    const test::OpenedFilm film = test::openFilm({.url = folder_ / "clip.mkv"});
    ASSERT_TRUE(film.info.has_depth) << file.name;
    EXPECT_EQ(film.info.packing, Packing::TopBottom) << file.name;
    EXPECT_EQ(film.info.calibration.calibration.near_mm, 900) << file.name;
    EXPECT_EQ(film.info.calibration.calibration.far_mm, 2400) << file.name;
    EXPECT_NEAR(film.distanceAt(80, 54), distanceMm(80, 54), 0.005 * distanceMm(80, 54)) << file.name;
    EXPECT_TRUE(std::isnan(film.heightAt(5, 54))) << file.name;
    std::filesystem::remove(folder_ / file.name);
  }
}

TEST_F(DepthkitFile, TellsOfSeveralCamerasAndOfACameraOnItsSide) {
  write(folder_ / "clip.txt",
        R"({"perspectives": [{"nearClip": 0.9, "farClip": 2.4, "extrinsics": {"e00": 0, "e01": -1, "e10": 1, "e11": 0}},
            {"nearClip": 0.3, "farClip": 3, "extrinsics": {"e00": 1, "e10": 0}}]})");
  const auto why = test::openFilm({.url = folder_ / "clip.mkv"}).info.reading.why;
  EXPECT_THAT(why, Contains(HasSubstr("first of 2 cameras")));
  EXPECT_THAT(why, Contains(HasSubstr("on its side")));
}

TEST_F(DepthkitFile, OtherTextsTellNothing) {
  for (const char* text : {"nearClip farClip", R"({"nearClip": 3, "farClip": 1})", R"({"nearClip": "a", "farClip": 2})",
                           R"({"xnearClip": 1, "farClip": 2})", "\"nearClip\"", "nearClip:"}) {
    write(folder_ / "clip.txt", text);
    EXPECT_THAT(test::openFilm({.url = folder_ / "clip.mkv"}).info.reading.why, Not(Contains(HasSubstr("clip.txt"))))
        << text;
  }
}

// LeRobot: 12 bits, code 4095 (f(z) - f(min)) / (f(max) - f(min)), f(z) = log(z + shift) or z; 0 for a hole.
struct Quantised {
  const char *pix_fmt, *info;
  double min_mm, max_mm, shift_mm;
  bool logarithmic;
};

class LeRobotFile : public testing::Test {
 protected:
  static double onScale(const Quantised& q, double mm) { return q.logarithmic ? std::log(mm + q.shift_mm) : mm; }
  [[nodiscard]] std::string makeFilm(const Quantised& q, const std::string& camera) const {
    const std::string folder = folder_ / ("set/videos/" + camera + "/chunk-000");
    std::filesystem::create_directories(folder);
    ClipTrack film{.codec = "libx265", .pix_fmt = q.pix_fmt, .width = kSceneCols, .height = kSceneRows, .frames = 2};
    film.options = {{"x265-params", "lossless=1:log-level=none"}};
    film.sample = [q](int k, int c, int r, int) {
      const double mm = distanceMm(c, r), low = onScale(q, q.min_mm);
      if (k > 0) return 2048u;
      if (mm == 0) return 0u;
      return static_cast<std::uint32_t>(std::lround(4095 * (onScale(q, mm) - low) / (onScale(q, q.max_mm) - low)));
    };
    test::makeClip(folder + "/file-000.mp4", {film});
    std::filesystem::create_directories(folder_ / "set/meta");
    write(folder_ / "set/meta/info.json",
          R"({"codebase_version": "v3.0", "features": {"observation.images.top": {"info": {"is_depth_map": false}}, )"
          R"("observation.images.top_depth": {"dtype": "video", "info": )" +
              std::string(q.info) + "}}}");
    return folder + "/file-000.mp4";
  }
  test::TemporaryFolder folder_;
};

constexpr Quantised kUsual{"gray12le", R"({"is_depth_map": true})", 10, 10000, 3500, true};

TEST_F(LeRobotFile, SaysHowTheDepthFilmsAreQuantised) {
  const Quantised all[] = {
      kUsual,
      {"yuv420p12le",
       R"({"video.is_depth_map": true, "video.depth_min": 0.05, "video.depth_max": 5.0, "video.shift": 0.0})", 50, 5000,
       0, true},
      {"gray12le", R"({"is_depth_map": true, "video.depth_min": 0, "video.depth_max": 20, "video.use_log": false})", 0,
       20000, 3500, false}};
  for (const Quantised& q : all) {
    const test::OpenedFilm film = test::openFilm({.url = makeFilm(q, "observation.images.top_depth")});
    ASSERT_TRUE(film.info.has_depth) << q.info;
    EXPECT_EQ(film.info.packing, Packing::DepthAlone) << q.info;
    for (int c = 20; c < kSceneCols; c += 7) {
      EXPECT_NEAR(film.distanceAt(c, 60), distanceMm(c, 60), 0.002 * distanceMm(c, 60) + q.max_mm / 4095) << c;
    }
    EXPECT_TRUE(std::isnan(film.heightAt(5, 60))) << q.info;
    EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("meta/info.json"))) << q.info;
    EXPECT_THAT(film.info.reading.doubts, testing::IsEmpty()) << q.info;
  }
}

TEST_F(LeRobotFile, BelongsToItsOwnCamerasAloneAndMustMakeSense) {
  EXPECT_THAT(test::openFilm({.url = makeFilm(kUsual, "observation.images.top")}).info.reading.why,
              Not(Contains(HasSubstr("info.json"))));
  for (const char* info :
       {R"({"is_depth_map": true, "video.depth_max": 0})", R"({"is_depth_map": true, "video.shift": -1})",
        R"({"is_depth_map": true, "video.depth_max": 1e300})", R"({"is_depth_map": 1})", "3", "[]"}) {
    Quantised odd = kUsual;
    odd.info = info;
    EXPECT_THAT(test::openFilm({.url = makeFilm(odd, "observation.images.top_depth")}).info.reading.why,
                Not(Contains(HasSubstr("info.json"))))
        << info;
  }
  // By the kind's name, wherever the film lies; that there is one is told.
  const std::string elsewhere = makeFilm(kUsual, "elsewhere");
  EXPECT_THAT(test::openFilm({.url = elsewhere}).info.reading.doubts, Contains(HasSubstr("--as lerobot")));
  const test::OpenedFilm named = test::openFilm({.url = elsewhere, .as = findKind("lerobot")});
  EXPECT_NEAR(named.distanceAt(80, 54), distanceMm(80, 54), 4);
}

}  // namespace
}  // namespace relievo
