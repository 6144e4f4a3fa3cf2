// SPDX-License-Identifier: Apache-2.0
// Subtitles of a film and beside it: files written by hand, and tracks that the ffmpeg program has muxed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

PairReader::Backends backends() {
  return {.make_source = [](const std::string&) { return makeFfmpegSource(); },
          .make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); },
          .make_subtitle_decoder = makeFfmpegSubtitleDecoder};
}

// "0.5-1.5 text", as far as it has been read; the text without the fields before it.
std::vector<std::string> takeWords(PairReader& reader) {
  std::vector<std::string> words;
  while (const auto subtitle = reader.nextSubtitle()) {
    for (const std::string& line : subtitle->lines) {
      std::size_t at = 0;
      for (int field = 0; field < 8; ++field) at = line.find(',', at) + 1;
      char times[64];
      std::snprintf(times, sizeof times, "%.3g-%.3g ", toSeconds(subtitle->begin),
                    subtitle->end ? toSeconds(*subtitle->end) : -1);
      words.push_back(times + line.substr(at));
    }
  }
  return words;
}

class FilmWords : public testing::Test {
 protected:
  void SetUp() override {
    test::makeClip(folder_ / "film.mkv", {{.pix_fmt = "yuv420p", .fps_num = 25, .frames = 100}});
    source_ = {.url = folder_ / "film.mkv"};
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::vector<std::string> wordsBeside() {
    PairReader reader(backends());
    EXPECT_TRUE(reader.open(source_));
    return takeWords(reader);
  }
  // Reads to the end.
  static std::vector<std::string> readAll(PairReader& reader) {
    std::vector<std::string> words = takeWords(reader);
    while (reader.next().value()) {
      for (std::string& more : takeWords(reader)) words.push_back(std::move(more));
    }
    return words;
  }
  std::vector<std::string> wordsAfterASeek(double target_s, const std::string& pictures, double earlier_s = 0);

  TemporaryFolder folder_;
  SourceOptions source_;
};

TEST_F(FilmWords, SrtBesideTheFilmKeepsItsTimes) {
  write(
      "film.srt",
      "1\r\n00:00:01,500 --> 00:00:02,500\r\nHello <i>there</i>\r\n\r\n2\r\n00:00:03,000 --> 00:00:03,250\r\nBye\r\n");
  EXPECT_THAT(wordsBeside(), ElementsAre("1.5-2.5 Hello {\\i1}there{\\i0}", "3-3.25 Bye"));
}

TEST_F(FilmWords, WebVttAndAssAreRead) {
  write("film.vtt", "WEBVTT\n\n00:01.000 --> 00:02.000\nこんにちは\n");
  EXPECT_THAT(wordsBeside(), ElementsAre("1-2 こんにちは"));
  std::filesystem::remove(folder_ / "film.vtt");
  write("film.ass",
        "[Script Info]\nScriptType: v4.00+\n[V4+ Styles]\nFormat: Name, Fontname\nStyle: Big,Sans\n[Events]\n"
        "Format: Layer, Start, End, Style, Name, MarginL, MarginR, MarginV, Effect, Text\n"
        "Dialogue: 0,0:00:00.50,0:00:01.00,Big,,0,0,0,,{\\b1}Bold, with a comma\n");
  EXPECT_THAT(wordsBeside(), ElementsAre("0.5-1 {\\b1}Bold, with a comma"));
}

TEST_F(FilmWords, OldFilesInLatin1AreRead) {
  write("film.srt", "1\n00:00:01,000 --> 00:00:02,000\nGr\xfc\xdf\n");
  EXPECT_THAT(wordsBeside(), ElementsAre("1-2 Grüß"));
}

TEST_F(FilmWords, AFileThatIsNoneIsLeftOut) {
  write("film.srt", "nothing of the kind");
  EXPECT_THAT(wordsBeside(), IsEmpty());
}

TEST_F(FilmWords, ASubtitleFileIsNoFilmAndSaysWhatIs) {
  write("alone.srt", "1\n00:00:00,400 --> 00:00:00,800\nOne\n");
  PairReader reader(backends());
  const auto opened = reader.open({.url = folder_ / "alone.srt"});
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("subtitles; give the film"));
}

TEST_F(FilmWords, TracksChaptersAndLanguagesInTheFilm) {
  write("a.srt", "1\n00:00:00,400 --> 00:00:00,800\nOne\n\n2\n00:00:03,000 --> 00:00:03,500\nTwo\n");
  write("b.srt", "1\n00:00:00,600 --> 00:00:01,000\nUn\n\n2\n00:00:03,200 --> 00:00:03,600\nDeux\n");
  write("meta",
        ";FFMETADATA1\ntitle=One\x1b film\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=2000\ntitle=First\n"
        "[CHAPTER]\nTIMEBASE=1/1000\nSTART=2000\nEND=4000\ntitle=Second\n");
  const std::string folder = folder_ / "";
  const std::string command = "cd " + folder +
                              " && ffmpeg -v error -i film.mkv -i a.srt -i b.srt -i meta -map 0 -map 1 -map 2 "
                              "-map_chapters 3 -map_metadata 3 -c copy -disposition:s 0 -metadata:s:s:0 language=eng "
                              "-metadata:s:s:1 language=fre all.mkv";
  if (std::system(command.c_str()) != 0)
    GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  PairReader reader(backends());
  ASSERT_TRUE(reader.open({.url = folder_ / "all.mkv", .subtitle_languages = "fr"}));
  const FilmInfo& info = reader.info();
  ASSERT_EQ(info.subtitles.size(), 2u);
  EXPECT_EQ(info.subtitles[0].language, "eng");
  EXPECT_EQ(info.words, 1u);
  ASSERT_EQ(info.chapters.size(), 2u);
  EXPECT_EQ(info.chapters[1].title, "Second");
  EXPECT_EQ(info.title, "One  film");
  EXPECT_EQ(info.chapters[1].begin, fromSeconds(2));
  EXPECT_THAT(readAll(reader), ElementsAre("0.6-1 Un", "3.2-3.6 Deux"));

  // The viewer chooses the other track in the middle of the film.
  reader.chooseTracks(info.sound, 0);
  ASSERT_TRUE(reader.seek(mediaTime(1)));
  EXPECT_THAT(readAll(reader), testing::Contains("3-3.5 Two"));

  // Switched on while a line runs: what was read before the switch comes at once, of that track alone.
  reader.chooseTracks(info.sound, 1);
  EXPECT_THAT(takeWords(reader), testing::IsSupersetOf({"0.6-1 Un", "3.2-3.6 Deux"}));
  reader.chooseTracks(info.sound, std::nullopt);
  ASSERT_TRUE(reader.seek(mediaTime(0)));
  EXPECT_THAT(readAll(reader), IsEmpty());
}

// The subtitle lines after a seek to `target_s`, and one to `earlier_s` before it, in a film that the ffmpeg program
// makes of film.mkv, with the options `pictures`, and a.srt. Every picture is a key frame, so that no line is read
// along with the pictures of the seek.
std::vector<std::string> FilmWords::wordsAfterASeek(double target_s, const std::string& pictures, double earlier_s) {
  const std::string folder = folder_ / "";
  const std::string command =
      "cd " + folder + " && ffmpeg -v error -i film.mkv -i a.srt -map 0 -map 1 -c:s srt " + pictures + " all.mkv";
  if (std::system(command.c_str()) != 0) return {"no ffmpeg program here"};  // NOLINT(bugprone-command-processor)
  PairReader reader(backends());
  EXPECT_TRUE(reader.open({.url = folder_ / "all.mkv", .subtitle_languages = "und"}));
  reader.chooseTracks(std::nullopt, 0);
  EXPECT_TRUE(reader.seek(mediaTime(earlier_s)));
  takeWords(reader);
  EXPECT_TRUE(reader.seek(mediaTime(target_s)));
  auto words = takeWords(reader);
  const auto pair = reader.next();
  EXPECT_TRUE(pair && *pair);
  if (pair && *pair) {
    EXPECT_NEAR(toSeconds((*pair)->color.pts), target_s + 0.02, 0.021);
  }
  return words;
}

TEST_F(FilmWords, ALineThatRunsWhereASeekLandsIsRead) {
  write("a.srt", "1\n00:00:01,000 --> 00:00:03,900\nLong\n\n2\n00:00:03,950 --> 00:00:04,000\nLast\n");
  EXPECT_THAT(wordsAfterASeek(2.5, "-c:v mpeg4 -g 1"), ElementsAre("1-3.9 Long"));
}

// 8 MiB of these pictures last .7 s.
TEST_F(FilmWords, OfAFilmOfManyBytesASeekReadsTheLastLinesOnly) {
  write("a.srt", "1\n00:00:01,000 --> 00:00:03,900\nLong\n\n2\n00:00:02,400 --> 00:00:03,000\nNear\n");
  EXPECT_THAT(wordsAfterASeek(2.5, "-c:v rawvideo -s 640x480"), ElementsAre("2.4-3 Near"));
}

// Before 2 s lie two seconds without a key frame, of which 8 MiB are .7 s.
TEST_F(FilmWords, ALongWayFromAKeyFrameDoesNotEndTheReadingOfLinesBeforeSeeks) {
  write("a.srt", "1\n00:00:02,300 --> 00:00:03,000\nNear\n");
  const std::string pictures =
      "-vf scale=640x480,noise=alls=100:allf=t -c:v libx264 -preset ultrafast -qp 1 -g 999 -t 3 "
      "-sc_threshold 0 -force_key_frames 2.2,2.4";
  EXPECT_THAT(wordsAfterASeek(2.5, pictures, 2), ElementsAre("2.3-3 Near"));
}

TEST(SubtitleDecoder, ClosedCaptionsAreNotTakenForLatin1) {
  StreamInfo stream;
  stream.kind = StreamKind::Subtitle;
  stream.codec = "eia_608";
  const auto decoder = makeFfmpegSubtitleDecoder();
  ASSERT_TRUE(decoder->open(stream));
  std::string words;
  double time_s = 0;
  // CTA-608, with odd parity: pop-on captions, the last row, "HI", show; clear.
  for (const std::string codes : {"\xfc\x94\x20\xfc\x94\x70\xfc\xc8\x49\xfc\x94\x2f", "\xfc\x94\x2c"}) {
    Packet packet;
    packet.data = reinterpret_cast<const std::uint8_t*>(codes.data());
    packet.bytes = codes.size();
    packet.pts = mediaTime(time_s++);
    const auto subtitle = decoder->decode(packet);
    if (subtitle && !subtitle->lines.empty()) words += subtitle->lines[0];
  }
  EXPECT_THAT(words, HasSubstr("HI"));
}

}  // namespace
}  // namespace relievo
