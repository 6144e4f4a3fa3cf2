// SPDX-License-Identifier: Apache-2.0
// Depth in floating point, opened without any option: what it is taken for, and the distances that come out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/float_reading.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/float_tiff.h"
#include "tests/support/film/opened_film.h"
#include "tests/unit/media/reading/pfm_writer.h"

namespace relievo {
namespace {

using test::TemporaryFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr int kCols = 64, kRows = 48;
constexpr float kHole = std::numeric_limits<float>::infinity();

// A floor that comes nearer towards the bottom, with nothing in the top left corner.
double metresAt(int c, int r) {
  return c < 8 && r < 8 ? 0 : 4.0 - 0.05 * r + 0.001 * c;
}

template <class Value>
void writePfm(const std::string& path, Value&& value) {
  test::writePfm(path, kCols, kRows,
                 [&](int c, int r) { return metresAt(c, r) == 0 ? kHole : static_cast<float>(value(metresAt(c, r))); });
}

// Each distance is the true one times the same number, holes are holes.
void expectDistances(const test::OpenedFilm& film) {
  ASSERT_TRUE(film.info.has_depth);
  const double scale = film.distanceAt(30, 20) / metresAt(30, 20);
  for (int r = 0; r < kRows; r += 3) {
    for (int c = 0; c < kCols; c += 5) {
      const bool hole = std::isnan(film.heightAt(c, r));
      ASSERT_EQ(hole, metresAt(c, r) == 0) << c << ", " << r;
      if (hole) continue;
      ASSERT_NEAR(film.distanceAt(c, r) / scale, metresAt(c, r), 0.002) << c << ", " << r;
    }
  }
}

TEST(FloatReading, MetresMillimetresAndDisparitiesComeOutAlike) {
  const TemporaryFolder folder;
  writePfm(folder / "depth.pfm", [](double m) { return m; });
  writePfm(folder / "depth-mm.pfm", [](double m) { return 1000 * m; });
  writePfm(folder / "disp.pfm", [](double m) { return 900 / m; });
  writePfm(folder / "0006.pfm", [](double m) { return 900 / m; });  // PFM is mostly disparity
  for (const char* name : {"depth.pfm", "depth-mm.pfm", "disp.pfm", "0006.pfm"}) {
    SCOPED_TRACE(name);
    expectDistances(test::openFilm({.url = folder / name}));
  }
  const auto& metres = test::openFilm({.url = folder / "depth.pfm"}).info.calibration.calibration;
  EXPECT_NEAR(metres.near_mm, 0.9 * 1650, 20);
  EXPECT_NEAR(metres.far_mm, 1.1 * 4060, 20);
  const auto& mm = test::openFilm({.url = folder / "depth-mm.pfm"}).info.calibration.calibration;
  EXPECT_NEAR(mm.near_mm, metres.near_mm, 1);
}

TEST(FloatReading, APfmWithoutANameOfDepthMayBeMetres) {
  const TemporaryFolder folder;
  writePfm(folder / "img_0_1.pfm", [](double m) { return m; });  // AirSim
  const test::OpenedFilm film = test::openFilm({.url = folder / "img_0_1.pfm"});
  expectDistances(film);
  EXPECT_NEAR(film.distanceAt(30, 20), 1000 * metresAt(30, 20), 4);
}

TEST(FloatReading, TheCommandLineSpeaksOfTheFilesNumbers) {
  const TemporaryFolder folder;
  writePfm(folder / "0006.pfm", [](double m) { return 10 * m; });  // decimetres
  SourceOptions options{.url = folder / "0006.pfm"};
  options.command_line = {{"unit", "100"}};
  const test::OpenedFilm film = test::openFilm(options);
  expectDistances(film);
  EXPECT_NEAR(film.distanceAt(30, 20), 1000 * metresAt(30, 20), 4);

  writePfm(folder / "depth.pfm", [](double m) { return 900 / m; });
  SourceOptions inverse{.url = folder / "depth.pfm"};
  inverse.command_line = {{"law", "inverse"}};
  expectDistances(test::openFilm(inverse));
}

TEST(FloatReading, CentimetresAreOfferedAndSaid) {
  const TemporaryFolder folder;
  writePfm(folder / "depth.pfm", [](double m) { return 100 * m; });
  const test::OpenedFilm guessed = test::openFilm({.url = folder / "depth.pfm"});
  EXPECT_THAT(guessed.info.reading.offers, Contains(HasSubstr("if cm: --as unreal")));
  SourceOptions said{.url = folder / "depth.pfm"};
  said.as = findKind("unreal");
  const test::OpenedFilm film = test::openFilm(said);
  expectDistances(film);
  EXPECT_NEAR(film.distanceAt(30, 20), 1000 * metresAt(30, 20), 4);
  writePfm(folder / "depth.pfm", [](double m) { return m; });
  EXPECT_THAT(test::openFilm({.url = folder / "depth.pfm"}).info.reading.offers, Not(Contains(HasSubstr("cm"))));
}

TEST(FloatReading, RelativeDisparitiesThatBeginAtZeroAreLinear) {
  const TemporaryFolder folder;
  writePfm(folder / "disp.pfm", [](double m) { return (4.06 - m) / 2; });
  const test::OpenedFilm film = test::openFilm({.url = folder / "disp.pfm"});
  EXPECT_EQ(film.info.calibration.calibration.law, DepthLaw::Linear);
  EXPECT_GT(film.heightAt(30, 40), film.heightAt(30, 10) + 0.5);
}

TEST(FloatReading, DepthWithoutColourIsFeltAndShownAsGray) {
  const TemporaryFolder folder;
  writePfm(folder / "depth.pfm", [](double m) { return m; });
  const test::OpenedFilm film = test::openFilm({.url = folder / "depth.pfm"});
  EXPECT_EQ(film.info.packing, Packing::DepthAlone);
  EXPECT_EQ(film.pair.color.model, ColorModel::Gray);
  EXPECT_EQ(test::sampleAt(film.pair.color, 0, 2, 2), 0u) << "a hole is black";
  EXPECT_GT(test::sampleAt(film.pair.color, 0, 30, 40), test::sampleAt(film.pair.color, 0, 30, 10) + 50);
  EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("distances in m")));
  EXPECT_THAT(film.info.reading.offers, Contains(HasSubstr("disparities: --calibration law=inverse")));
}

TEST(FloatReading, InAFolderTheDepthsOwnNameTells) {
  for (const char* name : {"disp_left.tif", "depth_left.tif"}) {
    const TemporaryFolder folder;
    test::makeClip(folder / "left_rgb.png",
                   {{.codec = "png", .pix_fmt = "rgb24", .width = kCols, .height = kRows, .frames = 1}});
    test::FloatTiff tiff{.width = kCols, .height = kRows};
    for (int i = 0; i < kCols * kRows; ++i) tiff.samples.push_back(17.25F + static_cast<float>(i % kCols));
    test::writeFloatTiff(folder / name, tiff);
    const test::OpenedFilm film = test::openFilm({.url = folder / ""});
    ASSERT_TRUE(film.info.has_depth) << name;
    const bool disparities = std::string(name) == "disp_left.tif";
    EXPECT_THAT(film.info.reading.why, Contains(HasSubstr(disparities ? ": disparities" : ": distances"))) << name;
  }
}

// The floor is nearer below: a view that is nearer above says that the custom may be wrong.
TEST(FloatReading, NumbersWithoutANameAreDoubtedIfTheyMakeTheFloorFar) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const auto& value) {
    test::FloatTiff tiff{.width = kCols, .height = kRows};
    for (int i = 0; i < kCols * kRows; ++i) {
      const double metres = metresAt(i % kCols, i / kCols);
      tiff.samples.push_back(metres == 0 ? 0 : static_cast<float>(value(metres)));
    }
    test::writeFloatTiff(folder / name, tiff);
    return test::openFilm({.url = folder / name});
  };
  const auto disparity = [](double m) { return 90 / m; };
  for (const char* name : {"LEFT_GT.tif", "depth.tif"}) {
    const test::OpenedFilm seen = write(name, disparity);
    EXPECT_TRUE(seen.info.calibration.calibration.unit_mm) << name;
    EXPECT_THAT(seen.info.reading.doubts, Contains(AllOf(HasSubstr("nearer above"), HasSubstr("law=inverse"))));
  }
  const test::OpenedFilm metres = write("GT.tif", [](double m) { return m; });
  expectDistances(metres);
  EXPECT_THAT(metres.info.reading.doubts, IsEmpty());
  // Distances do not begin at 0: such numbers are relative, whatever the name says.
  const test::OpenedFilm relative = write("rel_depth.tif", [](double m) { return (4.07 - m) / 3; });
  EXPECT_GT(relative.heightAt(30, 40), relative.heightAt(30, 10) + 0.5);
  EXPECT_THAT(relative.info.reading.doubts, Contains(HasSubstr("unit=1000")));
}

// A level view, whose numbers tell nothing but that they begin at 0: a network's, in either direction.
TEST(FloatReading, NumbersThatBeginAt0AreDoubtedAsDistances) {
  const auto doubtsOf = [](double nearest) {
    Frame frame = test::makeGrayFrame(kCols, kRows, 16, {},
                                      [&](int c, int) { return static_cast<int>(nearest * 1e4) + c * 400; });
    frame.value_per_code = 1e-4;
    return readMeaning({.codec = "npy", .path = "depth/moon.npy"}, nullptr, frame).value().reading.doubts;
  };
  EXPECT_THAT(doubtsOf(0.002), Contains(HasSubstr("law=inverse")));
  EXPECT_THAT(doubtsOf(0.4), IsEmpty());
}

// Numbers of 2 and more that rise or fall downwards, or else to the right.
DepthMeaning meaningOfArray(const char* path, bool near_high, bool tilted = true) {
  Frame frame = test::makeGrayFrame(kCols, kRows, 16, {}, [&](int c, int r) {
    const int step = tilted ? r : c;
    return near_high ? 20'000 + 500 * step : 60'000 - 500 * step;
  });
  frame.value_per_code = 1e-4;
  return readMeaning({.codec = "npy", .path = path}, nullptr, frame).value();
}

// As Video Depth Anything's, far from 0 and without holes.
TEST(FloatReading, AnArrayWithoutHolesIsRelativeDisparitiesIfThatMakesTheFloorNear) {
  for (const char* path : {"film_depths.npz/depths.npy", "a.npy", "depth.npy"}) {
    const DepthMeaning seen = meaningOfArray(path, true);
    EXPECT_EQ(seen.calibration.calibration.polarity, DepthPolarity::NearIsHigh) << path;
    EXPECT_EQ(seen.calibration.calibration.law, DepthLaw::Linear) << path;
    EXPECT_THAT(seen.reading.doubts, Contains(HasSubstr("unit=1000"))) << path;
    EXPECT_TRUE(meaningOfArray(path, false).calibration.calibration.unit_mm) << path;
  }
}

TEST(FloatReading, ALevelArrayIsDistancesUnlessItsProgramWritesDisparities) {
  const DepthMeaning program = meaningOfArray("film_depths.npz/depths.npy", true, false);
  EXPECT_EQ(program.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  EXPECT_THAT(program.reading.doubts, Contains(HasSubstr("unit=1000")));
  const DepthMeaning unnamed = meaningOfArray("film.npy", true, false);
  EXPECT_TRUE(unnamed.calibration.calibration.unit_mm);
  EXPECT_THAT(unnamed.reading.doubts, Contains(HasSubstr("law=inverse")));
  EXPECT_THAT(meaningOfArray("depth/film.npy", true, false).reading.doubts, IsEmpty());
}

// AirSim's distances and a stereo camera's disparities, both without a word: what makes the view near below.
TEST(FloatReading, OfAPfmWithoutANameTheViewTellsOrItIsDoubted) {
  const auto meaningOf = [](const char* path, auto&& value) {
    Frame frame =
        test::makeGrayFrame(kCols, kRows, 16, {}, [&](int c, int r) { return std::lround(100 * value(c, r)); });
    frame.value_per_code = 0.01;
    return readMeaning({.codec = "pfm", .path = path}, nullptr, frame).value();
  };
  const auto street = [](int, int r) { return 20 + 3 * (kRows - r); };
  const DepthMeaning distances = meaningOf("a/1.pfm", street);
  EXPECT_EQ(distances.calibration.calibration.unit_mm, 10);
  EXPECT_THAT(distances.reading.doubts, Contains(HasSubstr("law=inverse")));
  EXPECT_THAT(meaningOf("a/img_0_1_1636123456700400000.pfm", street).reading.doubts, IsEmpty());
  const DepthMeaning disparities = meaningOf("a/1.pfm", [](int, int r) { return 20 + 3 * r; });
  EXPECT_EQ(disparities.calibration.calibration.law, DepthLaw::Inverse);
  EXPECT_THAT(disparities.reading.doubts, IsEmpty());
  const DepthMeaning level = meaningOf("a/1.pfm", [](int c, int) { return 20 + c; });
  EXPECT_EQ(level.calibration.calibration.law, DepthLaw::Inverse);
  EXPECT_THAT(level.reading.doubts, Contains(HasSubstr("unit=1000")));
}

// Rooms are farther away.
TEST(FloatReading, DistancesUpTo1AreDoubtedWithTheWaysToScaleThem) {
  const auto doubtsOf = [](double least) {
    Frame frame = test::makeGrayFrame(kCols, kRows, 16, {},
                                      [&](int c, int r) { return std::lround(10'000 * least) + 40 * (kRows - r) + c; });
    frame.value_per_code = 1e-4;
    return readMeaning({.codec = "npy", .path = "depth.npy"}, nullptr, frame).value().reading.doubts;
  };
  EXPECT_THAT(doubtsOf(0.1), Contains(HasSubstr("unit=10000")));
  EXPECT_THAT(doubtsOf(0.7), Contains(HasSubstr("depth buffer")));
  EXPECT_THAT(doubtsOf(2), IsEmpty());
}

TEST(FloatReading, NamesTellWhatTheNumbersAre) {
  EXPECT_EQ(namesDisparity("a/Disparity/left/7.tif"), true);
  EXPECT_EQ(namesDisparity("disp0.npy"), true);
  EXPECT_EQ(namesDisparity("disp/depth_map_7.pfm"), false) << "the file's own name first";
  EXPECT_EQ(namesDisparity("disp/a/b/c.tif"), std::nullopt) << "the last three names only";
  EXPECT_EQ(namesDisparity("a/img_Car_0_2_1534.pfm"), false) << "AirSim's";
  EXPECT_EQ(namesDisparity("a/img__1_4_1534.pfm"), true);
  EXPECT_EQ(namesDisparity("a/img__1_3_1534.pfm"), std::nullopt);
  EXPECT_EQ(namesDisparity("img_data/take_2_left/disp_0001.pfm"), true);
}

TEST(FloatReading, AnExrIsDistancesUnlessItsNameSaysDisparity) {
  Frame frame = test::makeGrayFrame(kCols, kRows, 16, {}, [](int, int r) { return 20'000 + 300 * r; });
  frame.value_per_code = 0.001;
  const auto law = [&](const char* path) {
    const auto meaning = readMeaning({.codec = "exr", .path = path}, nullptr, frame).value();
    return meaning.calibration.calibration.law;
  };
  EXPECT_EQ(law("left_disparity.exr"), DepthLaw::Inverse);
  EXPECT_EQ(law("z.exr"), DepthLaw::Linear);
}

// An array of rows x columns x 3, in colours from blue (far) over cyan, yellow and red to dark red.
TEST(FloatReading, AnArrayOfColoursIsReadThroughItsColourMap) {
  const TemporaryFolder folder;
  std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (48, 64, 3), }";
  header.resize(117, ' ');
  std::ofstream file(folder / "depth.npy", std::ios::binary);
  file << std::string("\x93NUMPY\x01\0", 8) << static_cast<char>(header.size() + 1) << '\0' << header << '\n';
  for (int i = 0; i < kCols * kRows; ++i) {
    const double s = 0.1 + 0.8 * (i / kCols) / kRows;
    for (const double middle : {3.0, 2.0, 1.0}) {
      file.put(static_cast<char>(std::lround(255 * std::clamp(1.5 - std::abs(4 * s - middle), 0.0, 1.0))));
    }
  }
  file.close();
  const test::OpenedFilm film = test::openFilm({.url = folder / "depth.npy"});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.calibration.calibration.code, DepthCode::Jet);
  EXPECT_NEAR(film.heightAt(9, 36) - film.heightAt(9, 12), 0.8 / 2, 0.005);
}

}  // namespace
}  // namespace relievo
