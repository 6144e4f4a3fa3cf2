// SPDX-License-Identifier: Apache-2.0
#include "app/media/folder/picture_series.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

TEST(PictureSeries, PicturesThatAShellHasListedAreOneFilm) {
  const test::TemporaryFolder folder;
  const auto files = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names) std::ofstream(folder / name) << "x";
  };
  files({"f-1.png", "f-2.png", "f-10.png", "g-1.png", "f-1.jpg"});
  const auto path = [&](const char* name) { return folder / name; };
  EXPECT_EQ(seriesOf({path("f-1.png"), path("f-10.png"), path("f-2.png")}), folder / "f-*.png");
  EXPECT_EQ(seriesOf({path("f-1.png"), path("f-2.png")}), std::nullopt) << "not all that the pattern names";
  EXPECT_EQ(seriesOf({path("f-1.png"), path("f-1.jpg")}), std::nullopt);
  EXPECT_EQ(seriesOf({path("f-1.png")}), std::nullopt);
  EXPECT_EQ(seriesOf({path("f-1.png"), path("a.mkv")}), std::nullopt);
  std::filesystem::create_directory(folder / "a");
  std::filesystem::create_directory(folder / "b");
  files({"a/1.png", "b/1.png"});
  EXPECT_EQ(seriesOf({path("a/1.png"), path("b/1.png")}), std::nullopt);
}

}  // namespace
}  // namespace relievo
