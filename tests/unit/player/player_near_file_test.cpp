// SPDX-License-Identifier: Apache-2.0
// A misspelt file is found beside its wrong name.
#include "app/player/setup/near_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

TEST(NearFile, FindsASwapAnotherExtensionAndNothingThatIsFar) {
  const test::TemporaryFolder folder;
  for (const char* name : {"sample.mkv", "sample.srt", "holiday 2026.mp4", "a.mkv"})
    std::ofstream(folder / name) << " ";
  EXPECT_EQ(nearFile(folder / "sampel.mkv"), folder / "sample.mkv");
  EXPECT_EQ(nearFile(folder / "sample.mp4").substr(0, (folder / "sample").size()), folder / "sample");
  EXPECT_EQ(nearFile(folder / "Holiday 2026.mp4"), folder / "holiday 2026.mp4");
  EXPECT_EQ(nearFile(folder / "b.mkv"), "") << "one letter says nothing";
  EXPECT_EQ(nearFile(folder / "concert.mkv"), "");
  EXPECT_EQ(nearFile(folder / "away/sample.mkv"), "") << "there is no such folder";
}

TEST(NearFile, AnAddressWithoutItsBeginningIsOfTheWeb) {
  EXPECT_EQ(nearFile("www.example.org/film.mp4"), "https://www.example.org/film.mp4");
}

}  // namespace
}  // namespace relievo
