// SPDX-License-Identifier: Apache-2.0
// Numbers on both sides of 0, opened without any option.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/media/reading/depth_meaning.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/opened_film.h"
#include "tests/unit/media/reading/pfm_writer.h"

namespace relievo {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kCols = 64, kRows = 48;

// A floor that comes nearer towards the bottom, with nothing in the top left corner.
double metresAt(int c, int r) {
  return c < 8 && r < 8 ? std::numeric_limits<double>::infinity() : 4.0 - 0.05 * r + 0.001 * c;
}

template <class Value>
void writePfm(const std::string& path, Value&& value) {
  test::writePfm(path, kCols, kRows, [&](int c, int r) {
    const double metres = metresAt(c, r);
    return std::isinf(metres) ? metres : value(metres);
  });
}

// As MiDaS's and other networks' raw output: scaled and shifted as it happens.
TEST(SignedNumbers, AreNearWhereTheyAreLarge) {
  const test::TemporaryFolder folder;
  writePfm(folder / "moon.pfm", [](double m) { return 2.5 - m; });
  const test::OpenedFilm film = test::openFilm({.url = folder / "moon.pfm"});
  EXPECT_EQ(film.info.calibration.calibration.law, DepthLaw::Linear);
  EXPECT_EQ(film.info.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  const double scale = (film.heightAt(30, 40) - film.heightAt(30, 10)) / (metresAt(30, 10) - metresAt(30, 40));
  EXPECT_GT(scale, 0.35) << "of the box, a metre; the scene is 2.4 m deep";
  EXPECT_NEAR(film.heightAt(12, 44) - film.heightAt(60, 4), scale * (metresAt(60, 4) - metresAt(12, 44)), 0.01);
  EXPECT_TRUE(std::isnan(film.heightAt(2, 2)));
  EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("numbers of -1.5")));
  EXPECT_THAT(film.info.reading.doubts, IsEmpty());

  SourceOptions said{.url = folder / "moon.pfm"};
  said.command_line = {{"polarity", "near-low"}};
  const test::OpenedFilm turned = test::openFilm(said);
  EXPECT_LT(turned.heightAt(30, 40), turned.heightAt(30, 10));
  writePfm(folder / "sun.pfm", [](double m) { return m - 2.5; });
  EXPECT_THAT(test::openFilm({.url = folder / "sun.pfm"}).info.reading.doubts,
              Contains(HasSubstr("polarity=near-low")));
}

TEST(SignedNumbers, AreNoDistancesInAnyUnit) {
  Frame frame = test::makeGrayFrame(kCols, kRows, 16, {}, [](int c, int r) { return 1024 + 100 * r + c; });
  frame.value_per_code = 0.001;
  frame.value_at_zero = -2.5;
  DepthClues clues{.codec = "pfm", .path = "moon.pfm"};
  clues.command_line = {{"unit", "1000"}};
  const auto meaning = readMeaning(clues, nullptr, frame);
  ASSERT_FALSE(meaning);
  EXPECT_THAT(meaning.error().message, HasSubstr("no distances"));
}

}  // namespace
}  // namespace relievo
