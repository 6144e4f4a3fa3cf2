// SPDX-License-Identifier: Apache-2.0
// What relievo-author lets FFmpeg allocate: for an input no more than a picture needs, for its own packets what they
// take.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/scenario/author/author_film.h"
#include "tests/support/files.h"
#include "tests/support/network/http_server.h"

namespace relievo {
namespace {

using testing::HasSubstr;

// Its packets are allocated for the worst case, 307 MB each.
TEST_F(AuthorFilm, ProgramWritesLosslessDepthOfLargePictures) {
  ClipTrack depth =
      depthTrack("gray16le", [](int c, int r, int) { return static_cast<std::uint32_t>(30 * c + r); }, 1920, 1088);
  depth.frames = 2;
  makeClip(folder_ / "color.mkv", {colorTrack(1920, 1088, 30, 2)});
  makeClip(folder_ / "depth.mkv", {depth});
  const auto said = run("--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --depth-codec ffv1 --depth-bits 16");
  EXPECT_EQ(said.exit_code, 0) << said.err;
}

// Files are looked at before FFmpeg reads them; what comes from a server is not. The list of 50 million pictures took
// 1.2 GB, and its first picture was read.
TEST_F(AuthorFilm, ProgramTakesNoListThatNoFilmHasFromAServer) {
  const std::string path = folder_ / "film.mov";
  makeClip(path, {{.codec = "rawvideo", .pix_fmt = "rgb24", .frames = 2}});
  std::string film = test::contentOf(path);
  const std::string many{'\x02', '\xFA', '\xF0', '\x80'};
  film.replace(film.find("stsz") + 12, 4, many);
  film.replace(film.find("stsc") + 16, 4, many);
  std::ofstream(path, std::ios::binary) << film;
  const test::HttpServer server(folder_ / "");
  const auto said = run("--color " + server.url("film.mov") + " -o @/out.mkv");
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_THAT(said.err, HasSubstr("not one picture of its video could be decoded"));
}

}  // namespace
}  // namespace relievo
