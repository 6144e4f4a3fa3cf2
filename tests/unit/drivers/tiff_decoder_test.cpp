// SPDX-License-Identifier: Apache-2.0
// Z buffers as TIFF files, read through the FFmpeg source: every layout, and files that are no Z buffers.
#include <gtest/gtest.h>
#include <tiff.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "tests/support/film/clip_maker.h"
#include "tests/support/film/float_tiff.h"
#include "tests/unit/drivers/decoded_film.h"

namespace relievo {
namespace {

using test::DecodedFilm;
using test::decodeFilm;

// A slope of 10 m and values that are none, in a picture with odd sides.
test::FloatTiff zBuffer() {
  test::FloatTiff z{.width = 53, .height = 37};
  for (std::uint32_t i = 0; i < z.width * z.height; ++i) z.samples.push_back(0.005F * static_cast<float>(i) + 0.2002F);
  z.samples[5] = 0;
  z.samples[6] = -3;
  z.samples[7] = std::numeric_limits<float>::infinity();
  z.samples[8] = std::numeric_limits<float>::quiet_NaN();
  z.samples[9] = 1e10F;
  return z;
}

void expectSame(const Frame& frame, const test::FloatTiff& z) {
  ASSERT_EQ(frame.width, static_cast<int>(z.width));
  ASSERT_EQ(frame.height, static_cast<int>(z.height));
  EXPECT_EQ(frame.model, ColorModel::Gray);
  EXPECT_EQ(frame.range, ColorRange::Full);
  EXPECT_LE(frame.value_per_code, 0.0005);
  for (int r = 0; r < frame.height; ++r) {
    for (int c = 0; c < frame.width; ++c) {
      const double value = static_cast<double>(z.samples[static_cast<std::size_t>(r) * z.width + c]);
      const bool none = !(value > 0) || value > 1e9;
      const double read = test::sampleAt(frame, 0, c, r) * frame.value_per_code;
      ASSERT_NEAR(read, none ? 0 : value, 0.5001 * frame.value_per_code) << c << ", " << r;
    }
  }
}

TEST(TiffDecoder, NumbersKeepTheirValuesHoweverTheyAreStored) {
  const test::TemporaryFolder folder;
  test::FloatTiff plain = zBuffer(), deflated = plain, lzw = plain, tiled = plain;
  deflated.compression = COMPRESSION_ADOBE_DEFLATE;
  deflated.predictor = 3;  // of floating point
  lzw.compression = COMPRESSION_LZW;
  tiled.compression = COMPRESSION_LZW;
  tiled.tile = 16;
  for (const test::FloatTiff& one : {plain, deflated, lzw, tiled}) {
    SCOPED_TRACE(one.compression + one.tile);
    test::writeFloatTiff(folder / "z.tif", one);
    const DecodedFilm z = decodeFilm(folder / "z.tif");
    EXPECT_EQ(z.decoder, "tiff");
    ASSERT_EQ(z.frames.size(), 1u);
    expectSame(z.frames[0], one);
  }
}

TEST(TiffDecoder, LargeNumbersAreNoHoles) {
  const test::TemporaryFolder folder;
  test::FloatTiff z = zBuffer();
  for (float& sample : z.samples) sample *= sample < 1e9F ? 40 : 1;  // disparities of 8 to 400
  test::writeFloatTiff(folder / "z.tif", z);
  const DecodedFilm disparities = decodeFilm(folder / "z.tif");
  EXPECT_EQ(disparities.decoder, "tiff");
  ASSERT_EQ(disparities.frames.size(), 1u);
  const Frame& frame = disparities.frames[0];
  EXPECT_NEAR(test::sampleAt(frame, 0, 52, 36) * frame.value_per_code, static_cast<double>(z.samples.back()), 0.02);
}

TEST(TiffDecoder, NumberedFilesAreAFilmWithoutTheDamagedOnes) {
  const test::TemporaryFolder folder;
  test::FloatTiff z = zBuffer();
  for (int i = 1; i <= 5; ++i) {
    z.samples[0] = static_cast<float>(i);
    test::writeFloatTiff(folder / ("z" + std::to_string(i) + ".tif"), z);
  }
  {
    std::fstream cut(folder / "z3.tif", std::ios::in | std::ios::out | std::ios::binary);
    cut.seekp(4);
    cut.write("\xff\xff\xff\x7f", 4);  // the directory lies beyond the file's end
  }
  const DecodedFilm film = decodeFilm(folder / "z%d.tif");
  EXPECT_EQ(film.decoder, "tiff");
  EXPECT_EQ(film.damaged, 1u);
  ASSERT_EQ(film.frames.size(), 4u);
  const Duration period = film.frames[1].pts - film.frames[0].pts;
  EXPECT_GT(period, Duration(0));
  const Duration gap = film.frames[2].pts - film.frames[1].pts;
  EXPECT_NEAR(static_cast<double>((gap - 2 * period).count()), 0, 1)
      << "the lost picture leaves a gap; rounded to 1 ns";
  EXPECT_NEAR(test::sampleAt(film.frames[3], 0, 0, 0) * film.frames[3].value_per_code, 5, 0.001);
}

}  // namespace
}  // namespace relievo
