// SPDX-License-Identifier: Apache-2.0
// The file of a FilmWriter: it appears whole or not at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/unit/author/written_films.h"

namespace relievo::test {
namespace {

using testing::ElementsAre;

std::vector<std::string> filesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

TEST(AuthorFilmWriterFile, IsThereWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::string path = folder / "film.mkv";
  {
    auto writer = FilmWriter::create(path, formatOf(64, 48));
    ASSERT_TRUE(writer.has_value());
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_LE(filesIn(folder / "").size(), 1u);  // the temporary file, if it has a name
    ASSERT_TRUE((*writer)->writeColor(colorPicture(64, 48, 0), MediaTime{}, true).has_value());
  }
  EXPECT_TRUE(filesIn(folder / "").empty());
}

TEST(AuthorFilmWriterFile, OldOneStaysUntilTheNewOneIsWhole) {
  const TemporaryFolder folder;
  const std::string path = folder / "film.mkv";
  std::ofstream(path) << "old";
  {
    auto writer = FilmWriter::create(path, formatOf(64, 48));
  }
  std::string left;
  std::ifstream(path) >> left;
  EXPECT_EQ(left, "old");
  EXPECT_THAT(filesIn(folder / ""), ElementsAre("film.mkv"));
}

TEST(AuthorFilmWriterFile, NameMayLookLikeAnAddress) {
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  writeFilm(
      "a:b%03d.mkv", formatOf(64, 48), regularTimes(2),
      [](int) { return depthPicture(64, 48, [](int, int) { return std::uint8_t{77}; }); },
      [](int k) { return k == 0; });
  std::filesystem::current_path(before);
  EXPECT_THAT(filesIn(folder / ""), ElementsAre("a:b%03d.mkv"));
}

TEST(AuthorFilmWriterFile, RefusesWhatItCannotWrite) {
  const TemporaryFolder folder;
  const auto code = [&](const std::string& name, const FilmFormat& format) {
    const auto writer = FilmWriter::create(folder / name, format);
    return writer ? std::optional<ErrorCode>() : writer.error().code;
  };
  EXPECT_EQ(code("film.avi", formatOf(64, 48)), ErrorCode::InvalidArgument);
  EXPECT_EQ(code("nowhere/film.mkv", formatOf(64, 48)), ErrorCode::NotFound);
  EXPECT_EQ(code("film.mkv", formatOf(65, 48)), ErrorCode::InvalidArgument);  // odd colour
  EXPECT_TRUE(filesIn(folder / "").empty());
}

TEST(AuthorFilmWriterFile, RefusesTimesThatDoNotRise) {
  const TemporaryFolder folder;
  auto writer = FilmWriter::create(folder / "film.mkv", formatOf(64, 48));
  ASSERT_TRUE(writer.has_value());
  ASSERT_TRUE((*writer)->writeColor(colorPicture(64, 48, 0), mediaTime(1.0), true).has_value());
  static_cast<void>((*writer)->writeColor(colorPicture(64, 48, 1), mediaTime(1.0), false));
  const auto totals = (*writer)->finish();
  ASSERT_FALSE(totals.has_value());
  EXPECT_EQ(totals.error().code, ErrorCode::Corrupt);
  EXPECT_EQ((*writer)->writeColor(colorPicture(64, 48, 2), mediaTime(2.0), false).error().code, ErrorCode::Corrupt);
}

}  // namespace
}  // namespace relievo::test
