// SPDX-License-Identifier: Apache-2.0
// TIFF files of several pages, by libtiff and written here byte by byte: a film, whatever lies between its pages.
#include <gtest/gtest.h>
#include <tiff.h>

#include <algorithm>
#include <fstream>

#include "drivers/tiff/tiff_pages.h"
#include "tests/support/byte_writer.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/failing_disk.h"
#include "tests/support/film/float_tiff.h"
#include "tests/unit/drivers/decoded_film.h"

namespace relievo {
namespace {

using test::DecodedFilm;
using test::decodeFilm;

test::FloatTiff pageOf(int number, std::uint32_t side = 40) {
  test::FloatTiff page{.width = side, .height = side / 2};
  for (std::uint32_t i = 0; i < page.width * page.height; ++i)
    page.samples.push_back(static_cast<float>(number) + 0.001F * static_cast<float>(i));
  return page;
}

void expectPage(const Frame& frame, int number) {
  const test::FloatTiff page = pageOf(number);
  ASSERT_EQ(frame.width, 40);
  ASSERT_EQ(frame.height, 20);
  for (int r = 0; r < 20; r += 3) {
    for (int c = 0; c < 40; c += 3) {
      const double value = test::sampleAt(frame, 0, c, r) * frame.value_per_code;
      ASSERT_NEAR(value, static_cast<double>(page.samples[static_cast<std::size_t>(r * 40 + c)]), 0.001) << number;
    }
  }
}

TEST(TiffPages, AreAFilmInAnyLayoutAndAnotherSizeIsLeftOut) {
  const test::TemporaryFolder folder;
  for (const std::uint32_t tile : {0u, 16u}) {
    SCOPED_TRACE(tile);
    const std::string path = folder / (std::to_string(tile) + ".tif");
    for (int number = 1; number <= 4; ++number) {
      test::FloatTiff page = pageOf(number, number == 2 ? 20 : 40);
      page.tile = tile;
      page.compression = number % 2 == 1 ? COMPRESSION_LZW : COMPRESSION_NONE;
      (number == 1 ? test::writeFloatTiff : test::addFloatPage)(path, page);
    }
    const DecodedFilm film = decodeFilm(path);
    ASSERT_EQ(film.frames.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) expectPage(film.frames[i], i == 0 ? 1 : static_cast<int>(i) + 2);
    EXPECT_EQ(film.frames[2].pts - film.frames[0].pts, 2 * film.stream.frame_period);
    ASSERT_EQ(film.notes.size(), 1u);
    EXPECT_EQ(film.notes[0], "1 of its 4 pages are left out: they are of another size or type");
  }
}

// Pages of 16 bits in one strip, with their high bytes first: `codes` for each page.
std::string swappedPages(const std::vector<int>& codes) {
  std::string file("MM\0*", 4);
  const auto append = [&file](std::uint32_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) file += static_cast<char>(value >> (8 * i));
  };
  append(8, 4);
  constexpr std::uint32_t kSide = 16, kBytes = kSide * kSide * 2, kTags = 10;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const auto strip = static_cast<std::uint32_t>(file.size()) + 2 + 12 * kTags + 4;
    append(kTags, 2);
    for (const auto& [tag, value] : std::initializer_list<std::pair<std::uint32_t, std::uint32_t>>{
             {256, kSide}, {257, kSide}, {258, 16}, {259, 1}, {262, 1}, {277, 1}, {278, kSide}, {339, 1}}) {
      append(tag, 2), append(3, 2), append(1, 4), append(value, 2), append(0, 2);
    }
    append(273, 2), append(4, 2), append(1, 4), append(strip, 4);
    append(279, 2), append(4, 2), append(1, 4), append(kBytes, 4);
    append(i + 1 < codes.size() ? strip + kBytes : 0, 4);
    for (std::uint32_t k = 0; k < kSide * kSide; ++k) append(static_cast<std::uint32_t>(codes[i]), 2);
  }
  return file;
}

TEST(TiffPages, WithHighBytesFirstComeAsTheyAre) {
  const test::TemporaryFolder folder;
  const std::string file = swappedPages({700, 1234, 40000});
  std::ofstream(folder / "p.tif", std::ios::binary) << file;
  const DecodedFilm film = decodeFilm(folder / "p.tif");
  ASSERT_EQ(film.frames.size(), 3u);
  EXPECT_EQ(test::sampleAt(film.frames[0], 0, 3, 3), 700u);
  EXPECT_EQ(test::sampleAt(film.frames[2], 0, 15, 15), 40000u);

  std::ofstream(folder / "cut.tif", std::ios::binary) << file.substr(0, file.size() - 100);
  const DecodedFilm cut = decodeFilm(folder / "cut.tif");
  EXPECT_EQ(cut.frames.size(), 2u);
  EXPECT_EQ(cut.missed, 1u);
}

TEST(TiffPages, AreLostWhenTheDiskFails) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "p.tif";
  std::ofstream(path, std::ios::binary) << swappedPages({700, 1234, 40000});
  const auto source = drivers::makeMediaSource(path);
  ASSERT_TRUE(source->open(path));
  EXPECT_EQ(test::endOnFailingDisk(*source), ErrorCode::Lost);
}

// 600 entries give the same megabyte.
TEST(TiffPages, ThatWouldFillTheMemoryAreDamaged) {
  const test::TemporaryFolder folder;
  constexpr std::uint32_t kEntries = 600, kMegabyte = 1 << 20;
  test::ByteWriter file_bytes;
  file_bytes.raw({"II*\0\x08\0\0\0", 8}).add(static_cast<std::uint16_t>(kEntries));
  for (std::uint32_t i = 0; i < kEntries; ++i) {
    file_bytes.add(static_cast<std::uint16_t>(40000 + i)).add(std::uint16_t{1}).add(kMegabyte).add(std::uint32_t{0});
  }
  std::ofstream(folder / "p.tif", std::ios::binary) << file_bytes.bytes() << std::string(kMegabyte, '\0');
  const auto file = AnsweredFile::open(folder / "p.tif");
  ASSERT_TRUE(file);
  const auto pages = tiff::Pages::of(*file);
  ASSERT_TRUE(pages);
  EXPECT_EQ(pages->page(*file, 0).error().code, ErrorCode::Corrupt);
}

// 18 bytes each: a directory of one entry, and the place of the next.
TEST(TiffPages, AreNotListedWithoutEnd) {
  constexpr std::uint32_t kPages = 70'000, kBytes = 18;
  constexpr std::uint16_t kOne = 1, kWidth = 256, kLong = 4;
  test::ByteWriter bytes;
  bytes.raw({"II*\0\x08\0\0\0", 8});
  for (std::uint32_t i = 1; i <= kPages; ++i) {
    bytes.add(kOne)
        .add(kWidth)
        .add(kLong)
        .add(std::uint32_t{1})
        .add(std::uint32_t{40})
        .add(i < kPages ? 8 + i * kBytes : 0);
  }
  const test::TemporaryFolder folder;
  std::ofstream(folder / "p.tif", std::ios::binary) << bytes.bytes();
  const auto file = AnsweredFile::open(folder / "p.tif");
  ASSERT_TRUE(file);
  const auto pages = tiff::Pages::of(*file);
  ASSERT_TRUE(pages);
  EXPECT_LE(pages->count(), std::size_t{1} << 16);
}

TEST(TiffPages, ThatFollowThemselvesEnd) {
  const test::TemporaryFolder folder;
  std::string file = swappedPages({5, 6});
  constexpr std::size_t kNext = 8 + 2 + 120 + 2 + 120 + 4 + 512;  // behind the second page's directory
  for (std::size_t i = 0; i < 4; ++i) file[kNext + i] = i == 3 ? '\x08' : '\0';
  std::ofstream(folder / "p.tif", std::ios::binary) << file;
  EXPECT_EQ(decodeFilm(folder / "p.tif").frames.size(), 2u);
}

}  // namespace
}  // namespace relievo
