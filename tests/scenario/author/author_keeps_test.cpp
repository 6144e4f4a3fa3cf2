// SPDX-License-Identifier: Apache-2.0
// Sound, subtitles, languages, chapters and titles through relievo-author.
#include "tests/scenario/author/author_keeps.h"

#include <algorithm>

namespace relievo::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST_F(AuthorKeeps, KeepsEverythingInMatroska) {
  const std::string said = author("-o @/out.mkv");
  EXPECT_THAT(said, HasSubstr("kept: sound aac eng, sound aac jpn \"Director\", subtitles subrip eng, subtitles subrip "
                              "jpn, title \"A walk\", 3 chapters"));
  const std::string out = folder_ / "out.mkv";
  EXPECT_THAT(tracksOf(out, "a"), ElementsAreArray(tracksOf(film_, "a")));
  EXPECT_THAT(tracksOf(out, "s"), ElementsAreArray(tracksOf(film_, "s")));
  for (const int track : {0, 1}) {
    expectSameSound(out, track);
    EXPECT_EQ(wordsOf(out, track), wordsOf(film_, track));
  }
  EXPECT_THAT(wordsOf(out, 1), HasSubstr("こんにちは"));
  EXPECT_EQ(chaptersOf(out), chaptersOf(film_));
  EXPECT_THAT(chaptersOf(out), SizeIs(3));
  EXPECT_THAT(say("ffprobe -v error -show_entries format_tags=title -of default=nk=1:nw=1 " + out), "A walk\n");
}

TEST_F(AuthorKeeps, AFilmThatIsNamedByItsAddress) {
  ASSERT_EQ(std::system(inFolder("cp @/film.mkv '@/two words.mkv'").c_str()), 0);
  for (const char* address : {"file://@/two%20words.mkv", "file:@/film.mkv"}) {
    const std::string said = author("--force -o @/out.mkv", address);
    EXPECT_THAT(said, HasSubstr("kept: sound aac eng")) << address;
    EXPECT_THAT(tracksOf(folder_ / "out.mkv", "a"), ElementsAreArray(tracksOf(film_, "a"))) << address;
    EXPECT_THAT(chaptersOf(folder_ / "out.mkv"), SizeIs(3)) << address;
  }
}

TEST_F(AuthorKeeps, TextBecomesTheTextOfMp4) {
  const std::string said = author("-o @/out.mp4");
  EXPECT_THAT(said, HasSubstr("subtitles subrip eng as mov_text"));
  const std::string out = folder_ / "out.mp4";
  EXPECT_THAT(tracksOf(out, "a"), ElementsAre("aac|eng", "aac|jpn"));
  EXPECT_THAT(say("ffprobe -v error -select_streams a:1 -show_entries stream_tags=handler_name -of csv " + out),
              HasSubstr("Director"));
  EXPECT_THAT(tracksOf(out, "s"), ElementsAre("mov_text|eng", "mov_text|jpn"));
  for (const int track : {0, 1}) {
    expectSameSound(out, track);
    EXPECT_EQ(wordsOf(out, track), wordsOf(film_, track));
  }
  EXPECT_THAT(say("ffprobe -v error -show_chapters -of compact " + out), HasSubstr("Middle"));
  EXPECT_THAT(say("ffprobe -v error -show_entries format_tags=title -of default=nk=1:nw=1 " + out), "A walk\n");

  // And back: Matroska has no mov_text.
  author("-o @/back.mkv", "@/out.mp4");
  EXPECT_EQ(wordsOf(folder_ / "back.mkv", 0), wordsOf(film_, 0));
}

// As of two who speak at once. MP4 shows one text at a time; a film without sound has no other packets between them.
TEST_F(AuthorKeeps, TextsThatBeginTogetherAreShownTogether) {
  std::ofstream(folder_ / "two.srt") << "1\n00:00:00,200 --> 00:00:00,700\n- Who, me?\n\n"
                                        "2\n00:00:00,200 --> 00:00:00,900\n<i>- Yes, you</i>\n\n"
                                        "3\n00:00:01,100 --> 00:00:01,700\nLater\n\n"
                                        "4\n00:00:01,100 --> 00:00:01,500\nLast\n\n";
  const auto made = [&](const std::string& sound) {
    const std::string make =
        "ffmpeg -v error -y -i @/film.mkv -i @/two.srt -map 0:v " + sound + " -map 1 -c copy @/both.mkv";
    EXPECT_EQ(std::system(inFolder(make).c_str()), 0);
    author("--force -o @/out.mp4", "@/both.mkv");
    std::string words = wordsOf(folder_ / "out.mp4", 0);
    std::erase(words, '\r');
    return words;
  };
  EXPECT_EQ(made("-map 0:a"),
            "1\n00:00:00,200 --> 00:00:00,900\n- Who, me?\n<i>- Yes, you</i>\n\n"
            "2\n00:00:01,100 --> 00:00:01,700\nLater\nLast\n\n");
  const std::string without_sound = made("");
  EXPECT_THAT(without_sound, HasSubstr("\n- Who, me?\n<i>- Yes, you</i>\n\n2\n"));
  EXPECT_THAT(without_sound, HasSubstr("\nLater\nLast\n\n"));
}

TEST_F(AuthorKeeps, SoundInATransportStreamAndSaysWhatItCannotHold) {
  const std::string said = author("-o @/out.ts");
  const std::string out = folder_ / "out.ts";
  EXPECT_THAT(tracksOf(out, "a"), ElementsAre("aac|eng", "aac|jpn"));
  expectSameSound(out, 0);
  expectSameSound(out, 1);
  EXPECT_THAT(said, HasSubstr("note: subtitles subrip eng: left out, since a transport stream cannot hold it"));
  EXPECT_THAT(said, HasSubstr("note: 3 chapters: left out"));
}

TEST_F(AuthorKeeps, SoundInHls) {
  author("-o @/out.m3u8");
  const std::string out = folder_ / "out.m3u8";
  EXPECT_THAT(tracksOf(folder_ / "out.segments/init.mp4", "a"), ElementsAre("aac|eng", "aac|jpn"));
  const double begins = timesOf(out, "v:0").front();
  EXPECT_NEAR(timesOf(out, "a:0").front() - begins, timesOf(film_, "a:0").front() - timesOf(film_, "v:0").front(),
              0.03);
}

// The transport stream's clock begins at 1.4 s; its sound comes with headers that other containers do not want.
TEST_F(AuthorKeeps, SoundOfATransportStreamInMatroska) {
  author("-o @/way.ts");
  author("-o @/out.mkv", "@/way.ts");
  EXPECT_THAT(tracksOf(folder_ / "out.mkv", "a"), ElementsAre("aac|eng", "aac|jpn"));
  expectSameSound(folder_ / "out.mkv", 0);
}

// Two broadcasts one after the other: the times begin again in the middle.
TEST_F(AuthorKeeps, SoundGoesOnWhereATransportStreamsTimesJump) {
  author("--no-subtitles -o @/way.ts");
  ASSERT_EQ(std::system(inFolder("cat @/way.ts @/way.ts > @/twice.ts").c_str()), 0);
  author("-o @/out.mkv", "@/twice.ts");
  const std::vector<double> once = timesOf(film_, "a:0"), twice = timesOf(folder_ / "out.mkv", "a:0");
  const std::vector<double> pictures = timesOf(folder_ / "out.mkv", "v:0");
  EXPECT_NEAR(static_cast<double>(twice.size()), 2.0 * static_cast<double>(once.size()), 4);
  EXPECT_EQ(pictures.size(), 100u);
  EXPECT_NEAR(twice.back(), pictures.back(), 0.3);
  EXPECT_TRUE(std::ranges::is_sorted(twice));
}

// The larger picture's, though the other programme has more pictures and an earlier clock.
TEST_F(AuthorKeeps, OfSeveralProgrammesThePicturesOwnSoundInTime) {
  const std::string make =
      "ffmpeg -v error -y -itsoffset 30 -f lavfi -i testsrc=s=128x96:r=25:d=2 -f lavfi -i testsrc2=s=64x48:r=50:d=2"
      " -itsoffset 30 -f lavfi -i sine=440:d=2 -f lavfi -i sine=880:d=2 -map 0 -map 2 -map 1 -map 3 -c:v libx264"
      " -c:a aac -metadata:s:a:0 language=eng -metadata:s:a:1 language=jpn"
      " -program program_num=1:st=0:st=1 -program program_num=2:st=2:st=3 @/two.ts";
  ASSERT_EQ(std::system(inFolder(make).c_str()), 0);
  author("--depth @/pictures.mkv -o @/out.mkv", "@/two.ts");
  EXPECT_THAT(tracksOf(folder_ / "out.mkv", "a"), ElementsAre("aac|eng"));
  const std::vector<double> pictures = timesOf(folder_ / "out.mkv", "v:0"), sound = timesOf(folder_ / "out.mkv", "a:0");
  ASSERT_FALSE(pictures.empty() || sound.empty());
  EXPECT_NEAR(sound.front(), pictures.front(), 0.1);
  EXPECT_NEAR(sound.back(), pictures.back(), 0.1);
}

// TrueHD's packets take 5/6 ms, and Matroska counts milliseconds. What a container cannot hold does not end the run.
TEST_F(AuthorKeeps, EachPacketOfSoundThatIsKept) {
  const std::string make =
      "ffmpeg -v error -y -i @/pictures.mkv -f lavfi -i sine=440:d=2:r=48000 -map 0 -map 1 -map 1 -map 1 -c:v copy"
      " -strict -2 -c:a:0 truehd -c:a:1 flac -c:a:2 opus @/many.mkv";
  ASSERT_EQ(std::system(inFolder(make).c_str()), 0);
  const std::string source = folder_ / "many.mkv";
  const std::vector<std::string> all{"truehd", "flac", "opus"};
  for (const auto& [name, held] :
       std::vector<std::pair<std::string, std::vector<std::string>>>{{"out.mkv", all},
                                                                     {"out.mp4", all},
                                                                     {"out.mov", {}},
                                                                     {"out.ts", {"truehd", "opus"}},
                                                                     {"out.m3u8", {"flac", "opus"}}}) {
    const std::string said = author("-o @/" + name, "@/many.mkv");
    std::string kept;
    for (std::size_t i = 0; i < held.size(); ++i) {
      kept += (i == 0 ? "kept: sound " : ", sound ") + held[i];
      const auto track = std::ranges::find(all, held[i]) - all.begin();
      EXPECT_EQ(timesOf(folder_ / name, "a:" + std::to_string(i)).size(),
                timesOf(source, "a:" + std::to_string(track)).size())
          << name << ": " << held[i];
    }
    EXPECT_THAT(said, HasSubstr(kept));
    EXPECT_EQ(said.find("kept: ") == said.npos, held.empty());
  }
}

// A cut without coding again: the file has .4 s more, from the key frame on, which its edit list leaves out.
TEST_F(AuthorKeeps, NoSoundThatAnEditListCutsOff) {
  const std::string make =
      "ffmpeg -v error -y -f lavfi -i testsrc2=s=64x48:r=25:d=3 -f lavfi -i sine=440:d=3 -c:v libx264 -g 25 -c:a aac"
      " @/long.mp4 && ffmpeg -v error -y -ss 1.4 -i @/long.mp4 -c copy @/cut.mp4";
  ASSERT_EQ(std::system(inFolder(make).c_str()), 0);
  ASSERT_LT(timesOf(folder_ / "cut.mp4", "a:0").front(), -0.3);
  for (const char* ending : {".mkv", ".ts", ".m3u8", ".mp4"}) {
    author(std::string("--depth @/pictures.mkv -o @/cut-film") + ending, "@/cut.mp4");
    const std::string film = folder_ / (std::string("cut-film") + ending);
    const auto starts = [&](const char* stream) {
      return std::strtod(say("ffprobe -v error -select_streams " + std::string(stream) +
                             " -show_entries stream=start_time -of default=nk=1:nw=1 " + film)
                             .c_str(),
                         nullptr);
    };
    EXPECT_NEAR(starts("a:0"), starts("v:0"), 0.03) << ending;
  }
}

TEST_F(AuthorKeeps, NothingThatIsNotWished) {
  const std::string said = author("--no-audio --no-subtitles -o @/out.mkv");
  EXPECT_THAT(tracksOf(folder_ / "out.mkv", "a"), IsEmpty());
  EXPECT_THAT(tracksOf(folder_ / "out.mkv", "s"), IsEmpty());
  const std::size_t note = said.find("note:");
  EXPECT_EQ(said.find("note:", note + 1), std::string::npos) << said;
  EXPECT_THAT(said.substr(std::min(note, said.size())), HasSubstr("nothing says"));
  EXPECT_THAT(said, HasSubstr("kept: title \"A walk\", 3 chapters"));
}

}  // namespace
}  // namespace relievo::test
