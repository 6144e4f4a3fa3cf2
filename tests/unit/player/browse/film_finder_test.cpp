// SPDX-License-Identifier: Apache-2.0
// Films are found in folders; a folder that does not answer keeps back only its own films.
#include "app/player/browse/film_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/until.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

class Films : public testing::Test {
 protected:
  void file(const std::string& name) const {
    const std::filesystem::path path(folder_ / name);
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "x";
  }
  [[nodiscard]] std::string place() const { return std::filesystem::path(folder_ / "x").parent_path(); }
  static std::vector<ShelfFilm> filmsBelow(const std::string& folder) {
    FilmFinder finder(false);
    finder.look({folder}, {});
    return finder.filmsIn(folder);
  }
  static std::vector<std::string> titles(const std::vector<ShelfFilm>& films) {
    std::vector<std::string> all;
    for (const ShelfFilm& film : films) all.push_back(film.folder + ":" + film.title);
    return all;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Films, AreFoundInAFolderAndItsFoldersInNaturalOrder) {
  for (const char* name : {"10.mkv", "9.mp4", "notes.txt", "photo.jpg", ".hidden.mkv", "b/2.mkv", "a/1.mkv",
                           ".trash/old.mkv", "a/deep/3.mkv"}) {
    file(name);
  }
  EXPECT_THAT(titles(filmsBelow(place())), ElementsAre(":9", ":10", "a:1", "a/deep:3", "b:2"));
}

TEST_F(Films, ScansAndBareVideoStreamsAreFilms) {
  for (const char* name : {"1.sens", "2.klg", "3.hevc", "4.m2v", "5.sen"}) file(name);
  EXPECT_THAT(titles(filmsBelow(place())), ElementsAre(":1", ":2", ":3", ":4"));
}

// A stick has photos too; they are no films, and hide none.
TEST_F(Films, ManyPicturesBesideThemHideNone) {
  file("film.mkv");
  for (int k = 0; k < 50; ++k) file("photo" + std::to_string(k) + ".jpg");
  EXPECT_THAT(titles(filmsBelow(place())), ElementsAre(":film"));
}

TEST_F(Films, DepthBesideAFilmIsPartOfItAndARecordingIsOneFilm) {
  for (const char* name : {"cup.mkv", "cup-depth.mkv", "scan/depth/1.png", "scan/rgb/1.png"}) file(name);
  const auto films = filmsBelow(place());
  ASSERT_THAT(titles(films), ElementsAre(":cup", ":scan"));
  EXPECT_EQ(films[0].depth_url, place() + "/cup-depth.mkv");
  EXPECT_EQ(films[1].url, place() + "/scan");
}

TEST_F(Films, AreLookedForDownToADepthAndNotThroughLinks) {
  file("1/2/3/4/in.mkv");
  file("1/2/3/4/5/out.mkv");
  std::filesystem::create_directory_symlink(place(), folder_ / "loop");
  EXPECT_THAT(titles(filmsBelow(place())), ElementsAre("1/2/3/4:in"));
}

TEST_F(Films, AreAtMostAThousand) {
  for (int k = 0; k < 1010; ++k) file(std::to_string(k) + ".mkv");
  EXPECT_THAT(filmsBelow(place()), SizeIs(kMostFilms));
  EXPECT_THAT(filmsBelow(folder_ / "absent"), IsEmpty());
}

TEST_F(Films, TheFinderTellsNewsOnceAndForgetsPlacesThatWent) {
  file("a/1.mkv");
  file("b/2.mkv");
  FilmFinder finder;
  EXPECT_FALSE(finder.hasNews());
  finder.look({folder_ / "a", folder_ / "b"}, {folder_ / "a/1.mkv", folder_ / "gone.mkv"});
  ASSERT_TRUE(test::until([&] {
    return finder.filmsIn(folder_ / "a").size() == 1 && finder.filmsIn(folder_ / "b").size() == 1 &&
           finder.there().size() == 1;
  }));
  EXPECT_TRUE(finder.hasNews());
  EXPECT_FALSE(finder.hasNews());
  EXPECT_THAT(finder.there(), ElementsAre(folder_ / "a/1.mkv"));
  finder.look({folder_ / "a"}, {});
  EXPECT_TRUE(finder.hasNews());
  EXPECT_THAT(finder.filmsIn(folder_ / "b"), IsEmpty());
}

TEST_F(Films, WithoutAThreadOfItsOwnTheFinderHasThemAtOnce) {
  file("a/1.mkv");
  FilmFinder finder(false);
  finder.look({folder_ / "a"}, {});
  EXPECT_TRUE(finder.hasNews());
  EXPECT_THAT(finder.filmsIn(folder_ / "a"), SizeIs(1));
  finder.look({folder_ / "a"}, {});
  EXPECT_FALSE(finder.hasNews()) << "nothing has changed";
}

}  // namespace
}  // namespace relievo
