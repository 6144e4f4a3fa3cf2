// SPDX-License-Identifier: Apache-2.0
// Which sound and which subtitles a film begins with.
#include "app/media/tracks/film_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

FilmTrack track(const char* language, bool by_default = false, bool forced = false) {
  return {.stream = 1, .language = language, .by_default = by_default, .forced = forced};
}

TEST(FilmTracks, SoundIsTheFirstLanguageThatIsThere) {
  const std::vector<FilmTrack> tracks{track("eng", true), track("jpn"), track("fre")};
  EXPECT_EQ(chooseSound(tracks, "kor,jpn,eng"), 1u);
  EXPECT_EQ(chooseSound(tracks, "ja"), 1u) << "two letters mean the same";
  EXPECT_EQ(chooseSound(tracks, "fra"), 2u) << "both codes of three letters do";
  EXPECT_EQ(chooseSound(tracks, "FR-ca"), 2u);
  EXPECT_EQ(chooseSound(tracks, "kor"), 0u);
  EXPECT_EQ(chooseSound({track("eng"), track("ger", true)}, ""), 1u) << "the film's own mark";
  EXPECT_EQ(chooseSound({track(""), track("")}, "eng"), 0u);
  EXPECT_FALSE(chooseSound({}, "eng"));
}

TEST(FilmTracks, SubtitlesAreOffUnlessSomethingAsksForThem) {
  EXPECT_FALSE(chooseSubtitles({track("eng"), track("ger")}, "", ""));
  EXPECT_EQ(chooseSubtitles({track("eng"), track("ger")}, "de", ""), 1u);
  EXPECT_EQ(chooseSubtitles({track("eng"), track("ger", false, true)}, "", ""), 1u);
  EXPECT_EQ(chooseSubtitles({track("eng"), track("ger", true)}, "kor", ""), 1u);
  FilmTrack file = track("");
  file.stream = -1;
  EXPECT_EQ(chooseSubtitles({track("eng", true), file}, "", ""), 1u) << "who puts a file there wants it";
}

TEST(FilmTracks, SubtitleFilesAreChosenByTheLanguageOfTheDesktop) {
  std::vector<FilmTrack> files{track("de"), track("en.sdh"), track("pt-BR")};
  for (FilmTrack& file : files) file.stream = -1;
  EXPECT_EQ(chooseSubtitles(files, "", "en_GB.UTF-8"), 1u);
  EXPECT_EQ(chooseSubtitles(files, "", "pt_PT"), 2u);
  EXPECT_EQ(chooseSubtitles(files, "de", "en_GB.UTF-8"), 0u) << "what is asked for comes first";
  EXPECT_EQ(chooseSubtitles(files, "", "C.UTF-8"), 0u);
  EXPECT_FALSE(chooseSubtitles({track("eng")}, "", "en_GB.UTF-8")) << "a track of the film is not shown unasked";
}

TEST(FilmTracks, FilesBesideTheFilmAreItsOwnByTheirNames) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a film.mkv", "a film.srt", "a film.de.ASS", "a film.de.Forced.srt", "a film 2.srt",
                           "a film.txt", "other.srt"}) {
    std::ofstream(folder / name) << "x";
  }
  std::vector<std::string> found;
  for (const FilmTrack& file : subtitleFilesOf(folder / "a film.mkv")) {
    found.push_back(file.path.substr(file.path.rfind('/') + 1) + " " + file.language + " " + file.codec);
  }
  EXPECT_THAT(found, ElementsAre("a film.srt  srt", "a film.de.ASS de ass", "a film.de.Forced.srt de.Forced srt"));
  EXPECT_THAT(subtitleFilesOf("http://host/film.mkv"), IsEmpty());
}

TEST(FilmTracks, ATrackIsToldByItsNumberLanguageAndTitle) {
  std::vector<FilmTrack> tracks{track("eng"), track("jpn")};
  tracks[1].title = "Director";
  EXPECT_EQ(describeTrack(tracks, 1), "2 of 2, jpn, Director");
  EXPECT_EQ(describeTrack(tracks, std::nullopt), "off");
  EXPECT_EQ(describeTrack({}, std::nullopt), "none in this film");
}

}  // namespace
}  // namespace relievo
