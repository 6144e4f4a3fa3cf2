// SPDX-License-Identifier: Apache-2.0
// PFM, dpt and npy files, written here byte by byte: every type of number, byte order and shape, and damaged files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "drivers/floats/floats.h"
#include "drivers/registry.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/failing_disk.h"
#include "tests/unit/drivers/decoded_film.h"

namespace relievo {
namespace {

using test::DecodedFilm;
using test::decodeFilm;

constexpr std::size_t kCols = 23, kRows = 17;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A slope that falls to the lower right, no two samples alike.
double slope(std::size_t r, std::size_t c) {
  return 1.5 + 2.0 * static_cast<double>(r) + 0.05 * static_cast<double>(c);
}

template <class T>
std::string bytesOf(T value, bool swapped) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

double valueAt(const Frame& frame, std::size_t c, std::size_t r) {
  return test::sampleAt(frame, 0, static_cast<int>(c), static_cast<int>(r)) * frame.value_per_code;
}

template <class Truth>
void expectValues(const Frame& frame, Truth&& truth, double factor = 1) {
  ASSERT_EQ(frame.width, static_cast<int>(kCols));
  ASSERT_EQ(frame.height, static_cast<int>(kRows));
  ASSERT_EQ(frame.model, ColorModel::Gray);
  const double tolerance = factor == 1 ? 0.51 * std::abs(frame.value_per_code) : 0.51;
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t c = 0; c < kCols; ++c) {
      const double read = factor == 1 ? valueAt(frame, c, r)
                                      : test::sampleAt(frame, 0, static_cast<int>(c), static_cast<int>(r)) / factor;
      ASSERT_NEAR(read, truth(r, c), tolerance) << c << ", " << r;
    }
  }
}

// Rows from the bottom up; the sign of the scale is the byte order.
std::string pfm(bool high_bytes_first, const std::string& scale, double factor = 1) {
  std::string file = "Pf\n" + std::to_string(kCols) + " " + std::to_string(kRows) + "\n" + scale + "\n";
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t c = 0; c < kCols; ++c) {
      const std::size_t r = kRows - 1 - i;
      const bool hole = r == 3 && c == 4;
      file += bytesOf(hole ? kInfinity : static_cast<float>(factor * slope(r, c)), high_bytes_first);
    }
  }
  return file;
}
double slopeWithHole(std::size_t r, std::size_t c) {
  return r == 3 && c == 4 ? 0 : slope(r, c);
}

TEST(Pfm, ComesTheRightWayUpInEitherByteOrderWithItsHoles) {
  const test::TemporaryFolder folder;
  for (const bool high_first : {false, true}) {
    SCOPED_TRACE(high_first);
    write(folder / "d.pfm", pfm(high_first, high_first ? "0.00333" : "-0.00333"));
    const DecodedFilm picture = decodeFilm(folder / "d.pfm");
    EXPECT_EQ(picture.stream.codec, "pfm");
    ASSERT_EQ(picture.frames.size(), 1u);
    expectValues(picture.frames[0], slopeWithHole);
  }
}

TEST(Pfm, AnyRangeSurvives) {
  const test::TemporaryFolder folder;
  for (const double factor : {1e-6, 1e-3, 100.0, 1e6}) {
    SCOPED_TRACE(factor);
    write(folder / "d.pfm", pfm(false, "-1", factor));
    const DecodedFilm picture = decodeFilm(folder / "d.pfm");
    ASSERT_EQ(picture.frames.size(), 1u);
    const Frame& frame = picture.frames[0];
    EXPECT_LT(frame.value_per_code, 1e-4 * factor * slope(kRows - 1, kCols - 1));
    expectValues(frame, [&](std::size_t r, std::size_t c) { return factor * slopeWithHole(r, c); });
  }
}

TEST(Pfm, NegativeDisparitiesAreTurned) {
  const test::TemporaryFolder folder;
  write(folder / "d.pfm", pfm(false, "-1", -1));
  const DecodedFilm picture = decodeFilm(folder / "d.pfm");
  ASSERT_EQ(picture.frames.size(), 1u);
  EXPECT_LT(picture.frames[0].value_per_code, 0);
  // Minus infinity and infinity are holes alike.
  expectValues(picture.frames[0], [](std::size_t r, std::size_t c) { return -slopeWithHole(r, c); });
}

TEST(Pfm, ASeriesKeepsTheScaleOfItsFirstPictureWithNumbers) {
  const test::TemporaryFolder folder;
  for (int i = 0; i <= 3; ++i) write(folder / ("d" + std::to_string(i) + ".pfm"), pfm(false, "-1", i == 3 ? 10 : i));
  const DecodedFilm film = decodeFilm(folder / "d%d.pfm");
  ASSERT_EQ(film.frames.size(), 4u);
  for (int c = 0; c < int{kCols}; ++c) EXPECT_EQ(test::sampleAt(film.frames[0], 0, c, 1), 0u) << "nothing but holes";
  expectValues(film.frames[1], slopeWithHole);
  expectValues(film.frames[2], [](std::size_t r, std::size_t c) { return 2 * slopeWithHole(r, c); });
  EXPECT_EQ(film.frames[3].value_per_code, film.frames[1].value_per_code);
  EXPECT_EQ(test::sampleAt(film.frames[3], 0, kCols - 1, kRows - 1), 65535u) << "beyond the scale, but no hole";
}

TEST(Pfm, ThreeComponentsAreColourUnlessTheyAreEqual) {
  const test::TemporaryFolder folder;
  for (const bool equal : {true, false}) {
    std::string file = "PF\n2 2\n-1.0\n";
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) file += bytesOf(equal ? 0.25F * static_cast<float>(i) : k == i ? 1.0F : 0.0F, false);
    }
    write(folder / "c.pfm", file);
    const DecodedFilm picture = decodeFilm(folder / "c.pfm");
    ASSERT_EQ(picture.frames.size(), 1u);
    const Frame& frame = picture.frames[0];
    ASSERT_EQ(frame.model, equal ? ColorModel::Gray : ColorModel::Rgb);
    if (equal) continue;
    EXPECT_EQ(test::sampleAt(frame, 0, 0, 1), 255u) << "red, in the file's first row, at the bottom";
    EXPECT_EQ(test::sampleAt(frame, 1, 0, 1), 0u);
    EXPECT_EQ(test::sampleAt(frame, 2, 0, 0), 255u);
  }
}

std::string dpt(std::uint32_t rows, const std::string& samples) {
  return "PIEH" + bytesOf(static_cast<std::uint32_t>(kCols), false) + bytesOf(rows, false) + samples;
}

TEST(Dpt, RowsComeFromTheTopAndTheSkyIsAHole) {
  const test::TemporaryFolder folder;
  std::string samples;
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t c = 0; c < kCols; ++c) {
      samples += bytesOf(r == 3 && c == 4 ? 1e10F : static_cast<float>(slope(r, c)), false);
    }
  }
  for (const char* const name : {"frame_0001.dpt", "frame_0002.dpt"}) write(folder / name, dpt(kRows, samples));
  const DecodedFilm picture = decodeFilm(folder / "frame_0001.dpt");
  EXPECT_EQ(picture.stream.codec, "dpt");
  EXPECT_EQ(picture.stream.width, static_cast<int>(kCols));
  ASSERT_EQ(picture.frames.size(), 1u);
  expectValues(picture.frames[0], slopeWithHole);
  EXPECT_EQ(decodeFilm(folder / "").frames.size(), 2u) << "a folder of them";
}

TEST(Dpt, OpticalFlowAndCutFilesAreNoDepth) {
  const test::TemporaryFolder folder;
  const std::string samples(kRows * kCols * sizeof(float), '\x3f');
  for (const std::string& bytes : {samples + samples, samples.substr(4)}) {
    write(folder / "frame_0001.dpt", dpt(kRows, bytes));
    const DecodedFilm picture = decodeFilm(folder / "frame_0001.dpt");
    EXPECT_TRUE(picture.frames.empty());
    EXPECT_EQ(picture.damaged, 1u);
  }
  write(folder / "frame_0001.dpt", dpt(0x80000000, samples));
  EXPECT_FALSE(drivers::makeMediaSource(folder / "frame_0001.dpt")->open(folder / "frame_0001.dpt"));
}

std::string npy(const std::string& type, bool fortran, const std::string& shape, const std::string& numbers,
                char version = 1) {
  std::string text =
      "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': (" + shape + "), }";
  while ((text.size() + (version == 1 ? 11 : 13)) % 64 != 0) text += ' ';
  text += '\n';
  std::string file = "\x93NUMPY";
  file += version;
  file += '\0';
  file += bytesOf(static_cast<std::uint16_t>(text.size()), false);
  if (version > 1) file += std::string(2, '\0');
  return file + text + numbers;
}

template <class T>
std::string numbers(bool swapped, bool fortran, double factor = 1) {
  std::string bytes;
  for (std::size_t i = 0; i < kRows * kCols; ++i) {
    const std::size_t r = fortran ? i % kRows : i / kCols, c = fortran ? i / kRows : i % kCols;
    bytes += bytesOf(static_cast<T>(std::is_integral_v<T> ? std::round(factor * slope(r, c)) : slope(r, c)), swapped);
  }
  return bytes;
}
std::string shape() {
  return std::to_string(kRows) + ", " + std::to_string(kCols);
}

TEST(Npy, FloatsComeInEveryWidthOrderAndByteOrder) {
  const test::TemporaryFolder folder;
  for (const bool fortran : {false, true}) {
    for (const auto& [type, bytes] : std::vector<std::pair<std::string, std::string>>{
             {"<f4", numbers<float>(false, fortran)},
             {">f4", numbers<float>(true, fortran)},
             {"<f8", numbers<double>(false, fortran)},
             {">f8", numbers<double>(true, fortran)},
             {"<i4", numbers<std::int32_t>(false, fortran, 1e4)},
         }) {
      SCOPED_TRACE(type + (fortran ? " Fortran" : " C"));
      write(folder / "z.npy", npy(type, fortran, shape(), bytes, fortran ? 2 : 1));
      const DecodedFilm picture = decodeFilm(folder / "z.npy");
      ASSERT_EQ(picture.frames.size(), 1u);
      const double factor = type == "<i4" ? 1e4 : 1;
      expectValues(picture.frames[0],
                   [&](std::size_t r, std::size_t c) { return std::round(1e6 * factor * slope(r, c)) / 1e6; });
    }
  }
}

// Three components of 8 bytes: 403 MB a picture, of which the file has nothing.
TEST(Npy, APictureOfOver300MegabytesIsRefusedBeforeItIsAllocated) {
  const test::TemporaryFolder folder;
  write(folder / "depth.npy", npy("<f8", false, "2, 4096, 4096, 3", ""));
  const auto opened = drivers::makeMediaSource(folder / "depth.npy")->open(folder / "depth.npy");
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("300 MB"));
}

TEST(Npy, NumbersOfHalfPrecisionAreReadExactly) {
  const test::TemporaryFolder folder;
  // 1, -2, 4, infinity, the smallest number 2^-24, 0.333251953125
  std::string bytes;
  for (const int half : {0x3c00, 0xc000, 0x4400, 0x7c00, 0x0001, 0x3555}) {
    bytes += bytesOf(static_cast<std::uint16_t>(half), false);
  }
  write(folder / "z.npy", npy("<f2", false, "2, 3", bytes));
  const DecodedFilm picture = decodeFilm(folder / "z.npy");
  ASSERT_EQ(picture.frames.size(), 1u);
  const Frame& frame = picture.frames[0];
  EXPECT_NEAR(valueAt(frame, 0, 0), 1, frame.value_per_code);
  EXPECT_EQ(valueAt(frame, 1, 0), 0);
  EXPECT_NEAR(valueAt(frame, 2, 0), 4, frame.value_per_code);
  EXPECT_EQ(valueAt(frame, 0, 1), 0);
  EXPECT_EQ(test::sampleAt(frame, 0, 1, 1), 1u) << "the smallest number is no hole";
  EXPECT_NEAR(valueAt(frame, 2, 1), 0.333251953125, frame.value_per_code);
}

TEST(Npy, WholeNumbersThatFitAreCodesAsTheyAre) {
  const test::TemporaryFolder folder;
  for (const auto& [type, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"<u2", numbers<std::uint16_t>(false, false, 1000)},
           {">u2", numbers<std::uint16_t>(true, false, 1000)},
           {"<i4", numbers<std::int32_t>(false, false, 1000)},
           {"<i8", numbers<std::int64_t>(false, false, 1000)},
       }) {
    SCOPED_TRACE(type);
    write(folder / "z.npy", npy(type, false, shape() + ", 1", bytes));
    const DecodedFilm picture = decodeFilm(folder / "z.npy");
    ASSERT_EQ(picture.frames.size(), 1u);
    EXPECT_EQ(picture.frames[0].value_per_code, 0);
    expectValues(
        picture.frames[0], [](std::size_t r, std::size_t c) { return std::round(1000 * slope(r, c)) / 1000; }, 1000);
  }
}

TEST(Npy, AnArrayOfPicturesIsAFilm) {
  const test::TemporaryFolder folder;
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += numbers<float>(false, false);
  bytes.resize(bytes.size() - 10);  // the last picture is cut off
  write(folder / "z.npy", npy("<f4", false, "4, " + shape(), bytes));
  const DecodedFilm film = decodeFilm(folder / "z.npy");
  ASSERT_EQ(film.frames.size(), 3u);
  expectValues(film.frames[2], slope);
  EXPECT_EQ(film.frames[2].pts - film.frames[0].pts, 2 * (film.frames[1].pts - film.frames[0].pts));
  EXPECT_GT(film.frames[1].pts, film.frames[0].pts);
}

TEST(Npy, AFilmIsLostWhenTheDiskFails) {
  const test::TemporaryFolder folder;
  write(folder / "z.npy", npy("<f4", false, "4, 1000, 1000", std::string(16'000'000, 'a')));
  const auto source = makeNpySource();
  ASSERT_TRUE(source->open(folder / "z.npy").has_value());
  EXPECT_EQ(test::endOnFailingDisk(*source), ErrorCode::Lost);
}

// A camera's organised cloud: x to the right, y down, z away from it; 0, 0, 0 for a hole. Its normals are no cloud.
TEST(Npy, PointsAreTheirDistances) {
  for (const bool normals : {false, true}) {
    const test::TemporaryFolder folder;
    std::string bytes;
    for (std::size_t r = 0; r < kRows; ++r) {
      for (std::size_t c = 0; c < kCols; ++c) {
        const double z = r == 3 ? 0 : slope(r, c), x = z * (static_cast<double>(c) - 11) / 30,
                     y = z * (static_cast<double>(r) - 8) / 30;
        const double length = normals ? std::max(1e-9, std::hypot(x, y, z)) : 1;
        for (const double part : {x, y, z}) bytes += bytesOf(static_cast<float>(part / length), false);
      }
    }
    write(folder / "z.npy", npy("<f4", false, shape() + ", 3", bytes));
    const DecodedFilm film = decodeFilm(folder / "z.npy");
    ASSERT_EQ(film.frames.size(), 1u);
    if (normals) EXPECT_EQ(film.frames[0].model, ColorModel::Rgb);
    else expectValues(film.frames[0], [](std::size_t r, std::size_t c) { return r == 3 ? 0 : slope(r, c); });
  }
}

TEST(Npy, APictureOfFewerComponentsThanTheFirstIsLeftOut) {
  const test::TemporaryFolder folder;
  std::string cloud;
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t c = 0; c < kCols; ++c) {
      const double z = slope(r, c), x = z * (static_cast<double>(c) - 11) / 30,
                   y = z * (static_cast<double>(r) - 8) / 30;
      for (const double part : {x, y, z}) cloud += bytesOf(static_cast<float>(part), false);
    }
  }
  write(folder / "d0.npy", npy("<f4", false, shape() + ", 3", cloud));
  write(folder / "d1.npy", npy("<f4", false, shape(), numbers<float>(false, false)));
  write(folder / "d2.npy", npy("<f4", false, shape() + ", 3", cloud));
  const DecodedFilm film = decodeFilm(folder / "d%d.npy");
  ASSERT_EQ(film.frames.size(), 2u);
  expectValues(film.frames[1], slope);
}

TEST(Npy, OtherArraysAreRefused) {
  const test::TemporaryFolder folder;
  const std::string bytes = numbers<float>(false, false);
  for (const std::string& file :
       {npy("<c8", false, shape(), bytes), npy("|b1", false, shape(), bytes), npy("<f4", false, "391,", bytes),
        npy("<f4", false, "0, 23", bytes), npy("<f4", false, "70000, 2", bytes), npy("<f4", false, "32768, 32768", ""),
        npy("<f4", false, "18446744073709551615, 18446744073709551615", ""), npy("<f4", true, "2, 4, 7", bytes),
        npy("<f4", false, "2, 2, 2, 2, 2", bytes), npy("<f4", false, shape() + ", 2", bytes + bytes),
        std::string("\x93NUMPY\x01\0\xff\xff{", 11)}) {
    write(folder / "z.npy", file);
    EXPECT_FALSE(drivers::makeMediaSource(folder / "z.npy")->open(folder / "z.npy")) << file.substr(0, 80);
  }
}

TEST(FloatCodesOfAFilm, AValueFarBeyondAllOthersMeansNothingThere) {
  const test::TemporaryFolder folder;
  for (const float far : {1e4F, 65504.0F, 1e9F, 1e10F, kInfinity}) {
    SCOPED_TRACE(far);
    std::string bytes = numbers<float>(false, false);
    for (std::size_t i = 0; i < 40; ++i) {
      const float nearly = far * (1 + 1e-4F * static_cast<float>(i % 3));  // as of a depth buffer
      std::memcpy(&bytes[4 * i], &nearly, 4);
    }
    write(folder / "z.npy", npy("<f4", false, shape(), bytes));
    const DecodedFilm picture = decodeFilm(folder / "z.npy");
    ASSERT_EQ(picture.frames.size(), 1u);
    expectValues(picture.frames[0], [](std::size_t r, std::size_t c) { return r * kCols + c < 40 ? 0 : slope(r, c); });
    EXPECT_LT(picture.frames[0].value_per_code, 0.005);
  }
}

}  // namespace
}  // namespace relievo
