// SPDX-License-Identifier: Apache-2.0
// The table of points by bound: shapes of the lab's own and a film that is named.
#include "app/lab/detail/mesh_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

struct Row {
  double bound, points, rms, most;
};

std::map<std::string, std::vector<Row>> rowsOf(const std::string& path) {
  std::map<std::string, std::vector<Row>> rows;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const std::size_t end = line.find(',');
    Row row{};
    char comma = 0;
    std::istringstream(line.substr(end + 1)) >> row.bound >> comma >> row.points >> comma >> row.rms >> comma >>
        row.most;
    rows[line.substr(0, end)].push_back(row);
  }
  return rows;
}

MeasureOptions optionsFor(const std::string& folder, std::vector<std::string> films) {
  return {.out = folder,
          .depth_films = std::move(films),
          .backends = {[](const std::string&) { return makeFfmpegSource(); },
                       [](const StreamInfo&) { return makeFfmpegDecoder(); }}};
}

TEST(MeshPoints, APlaneTakesFourAndTheRestWhatTheirBoundAsksFor) {
  const test::TemporaryFolder folder;
  // A roof: two planes that meet at a column, so six points and no more.
  const test::ClipTrack roof{
      .codec = "png",
      .pix_fmt = "gray16be",
      .width = 65,
      .height = 33,
      .frames = 2,
      .sample = [](int, int c, int, int) { return static_cast<std::uint32_t>(20000 + 500 * std::min(c, 64 - c)); }};
  test::makeClip(folder / "%02d.png", {roof});
  const auto words = measureMeshPoints(optionsFor(folder / ".", {folder / "%02d.png"}));
  ASSERT_TRUE(words) << words.error().thing << words.error().error.message;
  auto rows = rowsOf(folder / "enhance-points.csv");
  ASSERT_EQ(rows.size(), 5u);
  for (const Row& row : rows["plane"]) EXPECT_EQ(row.points, 4);
  for (auto& [scene, of_scene] : rows) {
    ASSERT_EQ(of_scene.size(), 8u) << scene;
    for (std::size_t i = 0; i < of_scene.size(); ++i) {
      EXPECT_LE(of_scene[i].most, of_scene[i].bound) << scene;
      EXPECT_LE(of_scene[i].rms, of_scene[i].most) << scene;
      EXPECT_LE(of_scene[i].points, of_scene[i > 0 ? i - 1 : 0].points) << scene;
    }
  }
  EXPECT_GT(rows["sphere"].front().points, 50 * rows["sphere"].back().points);
  const std::string folder_name = std::filesystem::path(folder / "x").parent_path().filename();
  ASSERT_TRUE(rows.contains(folder_name)) << folder_name;
  EXPECT_EQ(rows[folder_name].front().points, 6);
}

TEST(MeshPoints, AFilmThatIsNotThereIsNamed) {
  const test::TemporaryFolder folder;
  const auto words = measureMeshPoints(optionsFor(folder / ".", {folder / "none.mkv"}));
  ASSERT_FALSE(words);
  EXPECT_EQ(words.error().thing, folder / "none.mkv");
}

}  // namespace
}  // namespace relievo
