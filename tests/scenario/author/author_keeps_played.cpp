// SPDX-License-Identifier: Apache-2.0
// What is kept of a film is the same in each container, written by relievo-author or remuxed from its Matroska, as
// ffprobe and the player's reader find it.
#include <algorithm>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/scenario/author/author_keeps.h"

namespace relievo::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// What the player finds and plays.
struct Played {
  std::vector<std::string> sounds, subtitles;   // languages
  std::vector<std::string> chapters;            // "0.700 Middle"
  std::vector<std::vector<std::string>> words;  // of each subtitle track: "0.2-0.9 Hello there"
  std::vector<double> sound_s;                  // where each sound track ends
  std::string title;
};

std::vector<std::string> languagesOf(const std::vector<FilmTrack>& tracks) {
  std::vector<std::string> languages;
  for (const FilmTrack& track : tracks) languages.push_back(track.language);
  return languages;
}

// The text, without the fields before it.
std::string textOf(const Subtitle& subtitle) {
  std::array<char, 64> times{};
  std::snprintf(times.data(), times.size(), "%.2f-%.2f", toSeconds(subtitle.begin),
                subtitle.end ? toSeconds(*subtitle.end) : -1);
  std::string text = times.data();
  for (const std::string& line : subtitle.lines) {
    std::size_t at = 0;
    for (int field = 0; field < 8; ++field) at = line.find(',', at) + 1;
    text += " " + line.substr(at);
  }
  // Both end what is slanting.
  if (const std::size_t end = text.find("{\\r}"); end != std::string::npos) text.replace(end, 4, "{\\i0}");
  return text;
}

// Plays the film to its end with these tracks.
void hear(const std::string& film, std::optional<std::size_t> sound, std::optional<std::size_t> words, Played& played) {
  PairReader reader({.make_source = [](const std::string&) { return makeFfmpegSource(); },
                     .make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); },
                     .make_audio_decoder = makeFfmpegAudioDecoder,
                     .make_subtitle_decoder = makeFfmpegSubtitleDecoder});
  const AudioFormat format{.rate_hz = 48000, .channels = 1};
  const auto opened = reader.open({.url = film, .sound = format});
  ASSERT_TRUE(opened) << film << ": " << opened.error().message;
  reader.chooseTracks(sound, words);
  ASSERT_TRUE(reader.seek(MediaTime{}));
  double end_s = 0;
  const auto take = [&] {
    while (const auto chunk = reader.nextSound()) {
      end_s = toSeconds(chunk->pts) + static_cast<double>(chunk->samples.size()) / format.rate_hz;
    }
    while (const auto subtitle = reader.nextSubtitle()) {
      if (words) played.words[*words].push_back(textOf(*subtitle));
    }
  };
  while (reader.next().value()) take();
  do take();
  while (reader.readAhead());
  if (sound) played.sound_s.push_back(end_s);
}

Played playedOf(const std::string& film) {
  Played played;
  {
    PairReader reader({.make_source = [](const std::string&) { return makeFfmpegSource(); },
                       .make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); },
                       .make_audio_decoder = makeFfmpegAudioDecoder,
                       .make_subtitle_decoder = makeFfmpegSubtitleDecoder});
    const auto opened = reader.open({.url = film});
    EXPECT_TRUE(opened) << film;
    played.sounds = languagesOf(reader.info().sounds);
    played.subtitles = languagesOf(reader.info().subtitles);
    played.title = reader.info().title;
    for (const Chapter& chapter : reader.info().chapters) {
      std::array<char, 64> time{};
      std::snprintf(time.data(), time.size(), "%.2f ", toSeconds(chapter.begin));
      played.chapters.push_back(time.data() + chapter.title);
    }
  }
  played.words.resize(played.subtitles.size());
  for (std::size_t track = 0; track < played.sounds.size(); ++track) hear(film, track, std::nullopt, played);
  for (std::size_t track = 0; track < played.subtitles.size(); ++track) hear(film, std::nullopt, track, played);
  return played;
}

class AuthorKeepsPlayed : public AuthorKeeps {
 protected:
  void expectAsTheSource(const std::string& name, bool has_chapters) {
    SCOPED_TRACE(name);
    const Played source = playedOf(film_), played = playedOf(folder_ / name);
    EXPECT_THAT(played.sounds, ElementsAre("eng", "jpn"));
    EXPECT_EQ(played.subtitles, source.subtitles);
    EXPECT_EQ(played.words, source.words);
    if (has_chapters) {
      EXPECT_EQ(played.chapters, source.chapters);
      EXPECT_EQ(played.title, "A walk");
    }
    ASSERT_EQ(played.sound_s.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(played.sound_s[i], source.sound_s[i], 0.03) << i;
    for (const int track : {0, 1}) expectSameSound(folder_ / name, track);
  }
  void run(const std::string& command) const { ASSERT_EQ(std::system(inFolder(command).c_str()), 0) << command; }
  // The commands that a note of relievo-author names for text, carried out for the film `name`.
  void keepTextBeside(std::string said, const std::string& name) {
    int commands = 0;
    for (std::size_t at = said.find("ffmpeg -i"); at != std::string::npos; at = said.find("ffmpeg -i", at + 1)) {
      std::string command = said.substr(at, said.find('\n', at) - at);
      command.insert(6, " -v error -y");
      const std::size_t film = command.find(" FILM");
      ASSERT_NE(film, std::string::npos) << command;
      run(command.replace(film, 5, " @/" + name));
      ++commands;
    }
    EXPECT_EQ(commands, 2);
  }
};

TEST_F(AuthorKeepsPlayed, TheSourceIsWhatItWasMadeOf) {
  // The ffmpeg program has moved all but the chapters by 23 ms, since the sound begins so much before 0.
  const Played source = playedOf(film_);
  EXPECT_THAT(source.words, ElementsAre(ElementsAre("0.22-0.92 Hello there", "1.12-1.72 {\\i1}Second{\\i0} line"),
                                        ElementsAre("0.42-1.32 こんにちは")));
  EXPECT_THAT(source.chapters, ElementsAre("0.00 Start", "0.70 Middle", "1.40 End"));
  EXPECT_NEAR(source.sound_s.at(0), 2, 0.05);
  EXPECT_NEAR(source.sound_s.at(1), 3, 0.05);
}

TEST_F(AuthorKeepsPlayed, InMatroskaAndMp4) {
  author("-o @/a.mkv");
  expectAsTheSource("a.mkv", true);
  author("-o @/a.mp4");
  expectAsTheSource("a.mp4", true);
}

TEST_F(AuthorKeepsPlayed, InATransportStreamAndHlsWithTheirTextBesideThem) {
  for (const char* ending : {"ts", "m3u8"}) {
    const std::string base = std::string("film-") + ending;
    const std::string said = author("-o @/" + base + "." + ending);
    keepTextBeside(said, base);
    expectAsTheSource(base + "." + ending, false);
  }
}

TEST_F(AuthorKeepsPlayed, Remuxed) {
  author("-o @/made.mkv");
  run("ffmpeg -v error -i @/made.mkv -map 0 -c copy -c:s mov_text @/re.mp4");
  expectAsTheSource("re.mp4", true);
  run("ffmpeg -v error -i @/re.mp4 -map 0:v -map 0:a -map 0:s -c copy -c:s srt @/back.mkv");
  expectAsTheSource("back.mkv", true);
  for (const char* name : {"re.ts", "re.m3u8"}) {
    run("ffmpeg -v error -i @/made.mkv -map 0:v -map 0:a -c copy -hls_segment_type fmp4 @/" + std::string(name));
    for (const char* language : {"eng", "jpn"}) {
      run("ffmpeg -v error -y -i @/made.mkv -map 0:s:m:language:" + std::string(language) + " @/re." + language +
          ".srt");
    }
    expectAsTheSource(name, false);
  }
}

}  // namespace
}  // namespace relievo::test
