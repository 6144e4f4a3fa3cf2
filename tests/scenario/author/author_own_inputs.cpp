// SPDX-License-Identifier: Apache-2.0
// Whatever its name and however it is asked to, relievo-author writes onto nothing that it reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/scenario/author/author_film.h"
#include "tests/support/files.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// `read`: the file, of which the output is another name or the same.
struct Own {
  const char *what, *read, *inputs, *output;
};
constexpr Own kOwn[] = {
    {"the colour", "color.mkv", "--color @/color.mkv --depth @/depth.mkv", "-o @/color.mkv"},
    {"the depth", "depth.mkv", "--color @/color.mkv --depth file:@/depth.mkv", "-o @/depth.mkv"},
    {"the depth beside the colour", "film_depth.mkv", "--color @/film.mkv", "-o @/film_depth.mkv"},
    {"a link", "color.mkv", "--color @/color.mkv --depth @/depth.mkv", "-o @/soft.mkv"},
    {"another name", "color.mkv", "--color @/color.mkv --depth @/depth.mkv", "-o @/hard.mkv"},
    {"a list", "list.m3u8", "--color @/list.m3u8 --depth @/depth.mkv", "-o @/list.m3u8"},
    {"a part of a list", "part.ts", "--color @/list.m3u8 --depth @/depth.mkv", "-o @/part.ts"},
    {"a picture of a series", "p-02.png", "--color @/p-%02d.png --depth @/depth.mkv",
     "-o @/o.mkv --preview @/p-02.png"},
    {"a painting", "p-01.png", "--color @/color.mkv --depth @/depth.mkv --material @/p-01.png",
     "-o @/o.mkv --preview @/p-01.png"},
    {"a calibration", "camera.txt", "--color @/color.mkv --depth @/depth.mkv --calibration @/camera.txt",
     "-o @/camera.mkv"},
    {"a network", "net.onnx", "--color @/color.mkv --depth-from @/net.onnx", "-o @/o.mkv --preview @/net.png"},
    {"the film, by its preview", "out.mkv", "--color @/color.mkv --depth @/depth.mkv",
     "-o @/out.mkv --preview @/out.png"},
};

TEST_F(AuthorFilm, ProgramNeverReplacesWhatItReadsEvenIfForced) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int) { return 9u; })});
  makeClip(folder_ / "part.ts", {{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 30}});
  makeClip(folder_ / "p-%02d.png", {{.codec = "png", .pix_fmt = "rgb24", .frames = 3}});
  for (const auto& [from, to] :
       std::vector<std::pair<const char*, const char*>>{{"color.mkv", "film.mkv"}, {"depth.mkv", "film_depth.mkv"}}) {
    fs::copy_file(folder_ / from, folder_ / to);
  }
  std::ofstream(folder_ / "list.m3u8") << "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\npart.ts\n#EXT-X-ENDLIST\n";
  std::ofstream(folder_ / "camera.txt") << "law=linear\n";
  for (const char* name : {"net.onnx", "out.mkv"}) std::ofstream(folder_ / name) << name;
  fs::create_symlink("color.mkv", folder_ / "soft.mkv");
  for (const auto& [from, to] : std::vector<std::pair<const char*, const char*>>{
           {"color.mkv", "hard.mkv"}, {"camera.txt", "camera.mkv"}, {"net.onnx", "net.png"}, {"out.mkv", "out.png"}}) {
    fs::create_hard_link(folder_ / from, folder_ / to);
  }
  for (const Own& own : kOwn) {
    const std::string before = test::contentOf(folder_ / own.read);
    const auto said = run(std::string(own.inputs) + " " + own.output + " --force");
    EXPECT_EQ(said.exit_code, 2) << own.what << ": " << said.err;
    EXPECT_THAT(said.err, testing::AnyOf(HasSubstr("is also an input and would be overwritten"),
                                         HasSubstr("is given for two outputs")))
        << own.what;
    EXPECT_EQ(test::contentOf(folder_ / own.read), before) << own.what;
  }
  EXPECT_FALSE(fs::exists(folder_ / "o.mkv"));
}

// Of which the last word may have a * or a ? in it.
TEST_F(AuthorFilm, ProgramTakesNoCommandForAPatternOfFiles) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  std::ofstream(folder_ / "out.mkv") << "the film of the run before";
  const auto said = run("--color @/color.mkv --depth-from '@/guess --names *.png' -o @/out.mkv --force");
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_THAT(said.err, testing::Not(HasSubstr("is also an input")));
}

}  // namespace
}  // namespace relievo
