// SPDX-License-Identifier: Apache-2.0
// The entries of a playlist, and which of them are refused.
#include "app/media/playlist.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

std::vector<PlaylistEntry> entries(std::string_view text, const std::string& from = "/films/list.m3u") {
  const auto parsed = parsePlaylist(text, from);
  EXPECT_TRUE(parsed) << parsed.error().error.message;
  return parsed.value_or(std::vector<PlaylistEntry>{});
}
std::string url(std::string_view line, const std::string& from) {
  const auto all = entries(line, from);
  return all.size() == 1 ? all[0].url : "";
}
// Which of the entries are refused.
std::vector<bool> refused(std::string_view text, const std::string& from) {
  std::vector<bool> all;
  for (const PlaylistEntry& entry : entries(text, from)) all.push_back(entry.refused);
  return all;
}
using Refused = std::vector<bool>;
std::string wrong(std::string_view text) {
  const auto parsed = parsePlaylist(text, "list.m3u");
  return parsed ? "" : parsed.error().thing;
}

TEST(Playlist, NamesFilmsWithTheirTitles) {
  const auto all = entries(
      "\xef\xbb\xbf#EXTM3U\r\n#EXTINF:12.5,A face, in relief\r\nface.mkv\r\n\r\n# by hand\r\n"
      "#EXTINF:-1\r\n#RELIEVO-DEPTH:cup-depth.webm\r\n  /other/cup.webm  \r\nhttp://host/film.mkv\r\nlast one.mkv");
  const std::vector<PlaylistEntry> expected{{"/films/face.mkv", "", "A face, in relief"},
                                            {"/other/cup.webm", "/films/cup-depth.webm", ""},
                                            {"http://host/film.mkv", "", ""},
                                            {"/films/last one.mkv", "", ""}};
  EXPECT_EQ(all, expected);
}

TEST(Playlist, WhatIsRelativeLiesBesideIt) {
  EXPECT_EQ(url("a.mkv", "list.m3u"), "./a.mkv");
  EXPECT_EQ(url("../a.mkv", "films/list.m3u"), "films/../a.mkv");
  EXPECT_EQ(url("C:a.mkv", "/films/list.m3u"), "/films/C:a.mkv") << "a single letter is not a scheme";
  EXPECT_EQ(url("a.mkv", "http://host/films/list.m3u?who=me/you#top"), "http://host/films/a.mkv");
  EXPECT_EQ(url("/a.mkv", "http://host/films/list.m3u"), "http://host/a.mkv");
  EXPECT_EQ(url("//other/a.mkv", "https://host/list.m3u"), "https://other/a.mkv");
  EXPECT_EQ(url("a.mkv", "http://host"), "http://host/a.mkv");
}

TEST(Playlist, OneOnTheNetworkOpensTheNetworkAlone) {
  const std::string from = "HTTP://host/list.m3u";
  for (const char* line : {"file:///etc/shadow", "FILE:/etc/shadow", "concat:/etc/a|/etc/b", "data:text/plain,x",
                           "crypto:file:/a", "pipe:0", "ftp://host/a"}) {
    EXPECT_EQ(refused(std::string("ok.mkv\n") + line + "\nok.mkv", from), (Refused{false, true, false})) << line;
    EXPECT_EQ(refused(std::string("#RELIEVO-DEPTH:") + line + "\na.mkv\nb.mkv", from), (Refused{true, false})) << line;
  }
  EXPECT_EQ(url("/etc/shadow", from), "HTTP://host/etc/shadow") << "on that host";
  EXPECT_EQ(url("subfile,,start,0,end,9,,:/etc/shadow", from), "HTTP://host/subfile,,start,0,end,9,,:/etc/shadow")
      << "a scheme does not end at a comma";
  for (const char* line :
       {"http://a/b", "https://a/b", "rtsp://a/b", "rtsps://a/b", "rtp://a:2", "udp://@:1234", "tcp://a:3"}) {
    EXPECT_EQ(entries(line, from), (std::vector<PlaylistEntry>{{.url = line}}));
  }
}

TEST(Playlist, OneInAFileOpensFilesButNoTricks) {
  EXPECT_EQ(url("file:///films/a.mkv", "/films/list.m3u"), "/films/a.mkv");
  EXPECT_EQ(url("file://localhost/%C3%A4%20100%.mkv%", "/films/list.m3u"), "/\xC3\xA4 100%.mkv%");
  for (const char* line : {"concat:a|b", "data:x", "pipe:0", "crypto:a"}) {
    EXPECT_EQ(refused(line, "list.m3u"), Refused{true}) << line;
  }
}

TEST(Playlist, APersonMayNameAFileByItsAddress) {
  EXPECT_EQ(sourceNamed("file:///films/two%20words.mkv"), "/films/two words.mkv");
  EXPECT_EQ(sourceNamed("file:films/100%.mkv"), "films/100%.mkv");
  EXPECT_EQ(sourceNamed("file:/films/color-%04d.png"), "/films/color-%04d.png") << "numbered pictures";
  const test::TemporaryFolder folder;
  std::ofstream(folder / "two words.mkv") << "a film";
  EXPECT_EQ(sourceNamed("file:" + (folder / "two%20words.mkv")), folder / "two words.mkv") << "as Java writes it";
  std::ofstream(folder / "two%20words.mkv") << "a film";
  EXPECT_EQ(sourceNamed("file:" + (folder / "two%20words.mkv")), folder / "two%20words.mkv") << "its own name";
  for (const char* words : {"films/a.mkv", "file", "v4l2:/dev/video0", "http://host/file:a"}) {
    EXPECT_EQ(sourceNamed(words), words);
  }
}

// "Alien" could be a protocol.
TEST(Playlist, AFileBesideItMayHaveAColonInItsName) {
  const test::TemporaryFolder folder;
  const std::string from = folder / "list.m3u", film = folder / "Alien: Covenant.mkv";
  std::ofstream(film) << "film";
  for (const std::string& line : {std::string("Alien: Covenant.mkv"), film}) {
    EXPECT_EQ(url(line, from), film);
    EXPECT_EQ(refused(line, from), Refused{false});
  }
  EXPECT_EQ(refused("Aliens: 1986.mkv", from), Refused{true}) << "not there";
}

TEST(Playlist, ANetworkAddressAloneHasAQuery) {
  EXPECT_EQ(withoutQuery("http://host/a.mkv?b#c"), "http://host/a.mkv");
  EXPECT_EQ(withoutQuery("/films/What? A film/#1.mkv"), "/films/What? A film/#1.mkv");
}

TEST(Playlist, WithoutAnEntryOrWithTooManyItIsNone) {
  for (const char* text : {"", "#EXTM3U\n", "\n\n# nothing\n"}) EXPECT_EQ(wrong(text), "list.m3u");
  std::string text;
  for (std::size_t i = 0; i < kMostEntries; ++i) text += "a.mkv\n";
  EXPECT_EQ(entries(text).size(), kMostEntries);
  EXPECT_EQ(wrong(text + "b.mkv"), "list.m3u");
}

TEST(Playlist, IsToldFromOneFilmInManyParts) {
  EXPECT_TRUE(isPlaylist("x", "#EXTM3U\na.mkv"));
  EXPECT_TRUE(isPlaylist("list.M3U", "a.mkv"));
  EXPECT_TRUE(isPlaylist("http://host/list.m3u?x=1", "a.mkv"));
  EXPECT_FALSE(isPlaylist("http://host/film.m3u8", "#EXTM3U\n#EXT-X-TARGETDURATION:4\nsegment0.ts"));
  EXPECT_FALSE(isPlaylist("film.mkv", "\x1a\x45\xdf\xa3"));
}

}  // namespace
}  // namespace relievo
