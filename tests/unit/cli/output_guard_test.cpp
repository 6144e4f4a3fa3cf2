// SPDX-License-Identifier: Apache-2.0
// An output is never a file that is also read, under whatever name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/cli/output_guard.h"
#include "app/cli/read_files.h"
#include "platform/whole_file.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

class OutputGuard : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text = "x") {
    const fs::path path(folder_ / name);
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  static bool refused(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
    return !keepApart(outputs, inputs).has_value();
  }

  test::TemporaryFolder folder_;
};

TEST_F(OutputGuard, KnowsAnInputByEveryNameThatItHas) {
  const std::string film = file("film.mkv");
  fs::create_hard_link(film, folder_ / "hard.mkv");
  fs::create_symlink(film, folder_ / "soft.mkv");
  fs::create_directory_symlink(folder_ / ".", folder_ / "here");
  for (const char* name : {"film.mkv", "hard.mkv", "soft.mkv", "./film.mkv", "here/film.mkv"}) {
    EXPECT_TRUE(refused({folder_ / name}, {film})) << name;
    EXPECT_TRUE(refused({film}, {folder_ / name})) << name;
    EXPECT_TRUE(refused({folder_ / name}, {"file:" + film})) << name;
  }
  EXPECT_FALSE(refused({file("other.mkv")}, {film}));
  EXPECT_FALSE(refused({folder_ / "new.mkv"}, {film}));
  EXPECT_TRUE(refused({folder_ / "new.mkv"}, {folder_ / "./new.mkv"})) << "none of them is there";
  EXPECT_FALSE(refused({"", "udp://127.0.0.1:5000", "/dev/null", "/dev/null"}, {"", "http://a/b", "/dev/null"}));
}

TEST_F(OutputGuard, KnowsThePicturesOfASequence) {
  file("depth-0001.png"), file("depth-0002.png"), file("depth-x.png");
  EXPECT_TRUE(refused({folder_ / "depth-0002.png"}, {folder_ / "depth-%04d.png"}));
  EXPECT_FALSE(refused({folder_ / "depth-x.png"}, {folder_ / "depth-%04d.png"}));
  EXPECT_FALSE(refused({folder_ / "depth-0003.jpg"}, {folder_ / "depth-%04d.png"}));
}

TEST_F(OutputGuard, KnowsThePicturesOfAFolder) {
  const std::string color = file("tum/rgb/1.5.png"), depth = file("tum/depth/1.5.png"),
                    list = file("tum/associations.txt");
  for (const std::string& read : {color, depth, list}) EXPECT_TRUE(refused({read}, {folder_ / "tum"})) << read;
  EXPECT_TRUE(refused({color}, {folder_ / "tum/rgb/*.png"}));
  EXPECT_FALSE(refused({folder_ / "tum/new.mkv"}, {folder_ / "tum"}));
  EXPECT_FALSE(refused({file("tum/run.json")}, {folder_ / "tum"})) << "a report of the run before";
  EXPECT_FALSE(refused({file("tum/hand.csv")}, {folder_ / "tum"}));
  const std::string camera = file("bop/scene_camera.json", R"({"0": {"depth_scale": 0.1}})");
  file("bop/rgb/000000.png"), file("bop/depth/000000.png");
  EXPECT_TRUE(refused({camera}, {folder_ / "bop"}));
}

TEST_F(OutputGuard, KnowsWhatAListNamesAndListsInLists) {
  const std::string segment = file("hls/film.segments/00001.m4s"), start = file("hls/film.segments/init.mp4");
  const std::string film = file("a film.mkv"), depth = file("depth.mkv");
  file("hls/media.m3u8", "#EXTM3U\n#EXT-X-MAP:URI=\"film.segments/init.mp4\"\n#EXTINF:4,\nfilm.segments/00001.m4s\r\n");
  const std::string master = file("hls/master.m3u8", "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=1\nmedia.m3u8\n");
  const std::string list = file("list.m3u", "#RELIEVO-DEPTH:depth.mkv\na film.mkv\nhls/master.m3u8\n");
  for (const std::string& read : {segment, start, film, depth, master, folder_ / "hls/media.m3u8", list}) {
    EXPECT_TRUE(refused({read}, {list})) << read;
  }
  EXPECT_FALSE(refused({film}, {master}));
  file("self.m3u8", "#EXTM3U\nself.m3u8\nself.m3u8\n");
  EXPECT_LE(filesReadBy(folder_ / "self.m3u8").size(), 31u) << "1 + 2 + 4 + 8 + 16: four deep";
}

TEST_F(OutputGuard, KnowsTheRenditionsOfHlsBehindOtherQuotedWords) {
  const std::string sound = file("hls/sound.m3u8", "#EXTM3U\nsound.ts\n"), part = file("hls/sound.ts"),
                    key = file("hls/key.bin");
  const std::string master = file("hls/master",
                                  "#EXTM3U\n#EXT-X-MEDIA:TYPE=AUDIO,GROUP-ID=\"a\",NAME=\"one\",URI=\"sound.m3u8\"\n"
                                  "#EXT-X-KEY:METHOD=AES-128,URI=\"key.bin\",IV=0x1\n");
  for (const std::string& read : {sound, part, key}) EXPECT_TRUE(refused({read}, {master})) << read;
  EXPECT_FALSE(refused({file("hls/one")}, {file("list.m3u8", "#EXTM3U\nother.ts\n")}));
}

TEST_F(OutputGuard, KnowsTheFilesOfAConcatUnderAnyName) {
  std::vector<std::string> read;
  for (const char* name : {"a.mkv", "b.mkv", "c.mkv", "deep/d.mkv"}) read.push_back(file(name));
  read.push_back(file("inner.txt", "ffconcat version 1.0\nfile deep/d.mkv\n"));
  const std::string list = file("list.txt",
                                "ffconcat version 1.0\n# file free.mkv\nfile a.mkv\r\n  file 'b.mkv'\nduration 3\n"
                                "file c\\.mkv\nfile inner.txt\n");
  for (const std::string& name : read) {
    EXPECT_TRUE(refused({name}, {list})) << name;
    fs::create_hard_link(name, folder_ / "link");
    EXPECT_TRUE(refused({folder_ / "link"}, {list})) << "a link to " << name;
    fs::remove(folder_ / "link");
  }
  EXPECT_FALSE(refused({file("free.mkv")}, {list}));
}

TEST_F(OutputGuard, KnowsTheFilesOfADashFilm) {
  const std::string start = file("dash/init-0.mp4"), part = file("dash/part-00001.m4s"), far = file("far/film.mp4");
  const std::string film = file("dash/film.mpd",
                                "<?xml version=\"1.0\"?>\n<MPD><BaseURL>../far/film.mp4</BaseURL>"
                                "<SegmentTemplate media=\"part-$Number%05d$.m4s\"/></MPD>\n");
  for (const std::string& read : {start, part, far}) EXPECT_TRUE(refused({read}, {film})) << read;
  EXPECT_FALSE(refused({file("far/other.mp4")}, {film}));
}

TEST_F(OutputGuard, KnowsWhatIsReadBecauseOfAFilmsName) {
  const std::string words = file("film.en.srt");
  const std::string camera = file("film.json", R"({"nearClip": 0.5, "farClip": 3.0})");
  const std::string report = file("film.report.json", "{}");
  const std::string film = file("film.mp4");
  for (const std::string& read : {words, camera}) EXPECT_TRUE(refused({read}, {film})) << read;
  EXPECT_FALSE(refused({report}, {film}));
  file("film.json", R"({"force": {"max_n": 1}})");
  EXPECT_FALSE(refused({camera}, {film})) << "a report of an earlier run";
}

TEST_F(OutputGuard, OneFileIsNoTwoOutputs) {
  EXPECT_TRUE(refused({folder_ / "a.json", folder_ / "./a.json"}, {}));
  const std::string there = file("b.json");
  fs::create_hard_link(there, folder_ / "c.json");
  EXPECT_TRUE(refused({there, folder_ / "c.json"}, {}));
  EXPECT_FALSE(refused({there, folder_ / "d.json"}, {}));
}

TEST_F(OutputGuard, ALinkToNoFileYetIsTheFileThatItNames) {
  fs::create_symlink("a.json", folder_ / "link.json");
  EXPECT_TRUE(refused({folder_ / "a.json", folder_ / "link.json"}, {}));
  EXPECT_TRUE(refused({folder_ / "link.json", folder_ / "a.json"}, {}));
  EXPECT_FALSE(refused({folder_ / "link.json", folder_ / "b.json"}, {}));
}

TEST_F(OutputGuard, OnlyFilesOfABoundedSizeAreReadWhole) {
  const auto code = [](const std::string& path) { return readWholeFile(path, FileSize::Settings, "no").error().code; };
  EXPECT_EQ(readWholeFile(file("a.toml", "text"), FileSize::Settings, "no").value(), "text");
  EXPECT_EQ(code(folder_ / "missing"), ErrorCode::NotFound);
  EXPECT_EQ(code("/dev/zero"), ErrorCode::Unsupported);
  EXPECT_EQ(code(folder_ / "."), ErrorCode::Unsupported);
  ASSERT_EQ(::system(("mkfifo " + (folder_ / "fifo")).c_str()), 0);
  EXPECT_EQ(code(folder_ / "fifo"), ErrorCode::Unsupported) << "a pipe without a writer is refused without waiting";
  const std::string large = file("large");
  fs::resize_file(large, (1u << 20) + 1);
  EXPECT_EQ(code(large), ErrorCode::Exhausted);
  fs::resize_file(large, 1u << 20);
  EXPECT_TRUE(readWholeFile(large, FileSize::Settings, "no"));
  fs::resize_file(large, (256u << 20) + 1);
  EXPECT_EQ(readWholeFile(large, FileSize::Recording, "no").error().code, ErrorCode::Exhausted);
}

}  // namespace
}  // namespace relievo
