// SPDX-License-Identifier: Apache-2.0
// Which folder is a list of films, and in which order.
#include "app/media/folder/film_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

class FilmFolder : public testing::Test {
 protected:
  void files(const std::vector<std::string>& names) const {
    for (const std::string& name : names) std::ofstream(folder_ / name) << "x";
  }
  test::TemporaryFolder folder_;
};

TEST_F(FilmFolder, ListsItsFilmsInNaturalOrderWithTheirDepth) {
  files({"10.mkv", "9.mp4", "cup.mov", "cup-depth.mkv", "cover.jpg", "notes.txt", ".hidden.mkv"});
  const std::vector<PlaylistEntry> expected{{folder_ / "9.mp4", "", "9"},
                                            {folder_ / "10.mkv", "", "10"},
                                            {folder_ / "cup.mov", folder_ / "cup-depth.mkv", "cup"}};
  const auto films = filmsIn(std::filesystem::path(folder_ / "x").parent_path());
  ASSERT_TRUE(films);
  EXPECT_EQ(*films, expected);
}

TEST_F(FilmFolder, ThePatternOfASeriesLeadsToThatOfItsDepth) {
  files({"f-01.color.jpg", "f-01.depth.png", "f-02.color.jpg", "f-02.depth.png", "rgb_7.png", "depth_7.png", "a1.png"});
  EXPECT_EQ(depthBeside(folder_ / "f-%02d.color.jpg"), folder_ / "f-%02d.depth.png");
  EXPECT_EQ(depthBeside(folder_ / "f-*.color.jpg"), folder_ / "f-*.depth.png");
  EXPECT_EQ(depthBeside(folder_ / "rgb_%d.png"), folder_ / "depth_%d.png");
  EXPECT_EQ(depthBeside(folder_ / "a%d.png"), "");
  EXPECT_EQ(depthBeside(folder_ / "f-%02d.mkv"), "") << "no pictures";
}

TEST_F(FilmFolder, AFilesDepthLiesBesideItByName) {
  files({"a.mp4", "a_depth.mkv", "a-depth.png", "color_output.webm", "depth_output.webm", "photo.jpg",
         "photo.depth.png", "c_src.mp4", "c_vis.mp4", "color.mp4", "depth.npy", "b.mp4", "b_depth.txt", "cat-image.jpg",
         "cat-depth.jpg", "d.mp4", "d_disparity.mp4", "image_e.mp4", "disparity_e.mkv"});
  std::filesystem::create_directory(folder_ / "c-depth.mp4");
  files({"c.mp4"});
  EXPECT_EQ(depthBeside(folder_ / "a.mp4"), folder_ / "a_depth.mkv");
  EXPECT_EQ(depthBeside(folder_ / "color_output.webm"), folder_ / "depth_output.webm");
  EXPECT_EQ(depthBeside(folder_ / "c_src.mp4"), folder_ / "c_vis.mp4");
  EXPECT_EQ(depthBeside(folder_ / "color.mp4"), folder_ / "depth.npy");
  EXPECT_EQ(depthBeside(folder_ / "photo.jpg"), folder_ / "photo.depth.png");
  EXPECT_EQ(depthBeside(folder_ / "cat-image.jpg"), folder_ / "cat-depth.jpg");
  EXPECT_EQ(depthBeside(folder_ / "d.mp4"), folder_ / "d_disparity.mp4");
  EXPECT_EQ(depthBeside(folder_ / "image_e.mp4"), folder_ / "disparity_e.mkv");
  for (const char* none : {"a_depth.mkv", "b.mp4", "c.mp4", "absent.mp4", "depth_output.webm"}) {
    EXPECT_EQ(depthBeside(folder_ / none), "") << none;
  }
}

TEST_F(FilmFolder, ADepthsNameMayHaveMoreWordsAndCapitals) {
  files({"a.mp4",
         "a_video_depth.mp4",
         "Clip.MP4",
         "Clip_Depth.MP4",
         "RGB_001.avi",
         "DEPTH_001.avi",
         "b.mp4",
         "b_depth_vis.mp4",
         "b_depth.mp4",
         "c.png",
         "c_depth_mask.png",
         "left.mp4",
         "disp.mp4",
         "d.mp4",
         "depth_d.mp4",
         "d1.mp4",
         "depth_d12.mp4",
         "e.mp4",
         "e-2.mp4",
         "e-2_depth.mp4",
         "Ocean.mkv",
         "Ocean - In Depth.mkv"});
  EXPECT_EQ(depthBeside(folder_ / "a.mp4"), folder_ / "a_video_depth.mp4");
  EXPECT_EQ(depthBeside(folder_ / "Clip.MP4"), folder_ / "Clip_Depth.MP4");
  EXPECT_EQ(depthBeside(folder_ / "RGB_001.avi"), folder_ / "DEPTH_001.avi");
  EXPECT_EQ(depthBeside(folder_ / "b.mp4"), folder_ / "b_depth.mp4") << "not the painted one";
  EXPECT_EQ(depthBeside(folder_ / "left.mp4"), folder_ / "disp.mp4");
  EXPECT_EQ(depthBeside(folder_ / "d.mp4"), folder_ / "depth_d.mp4");
  for (const char* none : {"b_depth.mp4", "c.png", "d1.mp4", "e.mp4", "Ocean.mkv"})
    EXPECT_EQ(depthBeside(folder_ / none), "") << none;
}

TEST_F(FilmFolder, AFilmOverAFolderOfDepthPicturesIsOneRecording) {
  for (const char* name : {"depth", "confidence"}) {
    std::filesystem::create_directory(folder_ / name);
    files({std::string(name) + "/000000.png"});
  }
  files({"rgb.mp4", "odometry.csv"});
  const std::string place = std::filesystem::path(folder_ / "x").parent_path();
  const auto found = filmOverDepth(place);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->film, folder_ / "rgb.mp4");
  EXPECT_EQ(found->depth, folder_ / "depth");
  EXPECT_EQ(depthBeside(folder_ / "rgb.mp4"), folder_ / "depth");
  EXPECT_EQ(filmsIn(place), std::nullopt);
  files({"preview.mp4"});
  EXPECT_TRUE(filmOverDepth(place)) << "one of the films is called rgb";
  EXPECT_EQ(depthBeside(folder_ / "preview.mp4"), "");
  std::filesystem::create_directory(folder_ / "rgb");
  EXPECT_TRUE(filmOverDepth(place)) << "an empty folder";
  files({"rgb/000000.jpg"});
  EXPECT_FALSE(filmOverDepth(place)) << "the colour is a folder too";
}

TEST_F(FilmFolder, AFilmAndADepthOfAnyKindAreOneRecording) {
  int count = 0;
  for (const char* const depth : {"depth.npy", "color_depths.npz", "depth.tif", "color_depth.mkv", "depth-*.png"}) {
    const std::string name = std::to_string(count++), place = folder_ / name;
    std::filesystem::create_directory(place);
    files({name + "/color.mp4"});
    if (std::string(depth) == "depth-*.png") files({name + "/depth-1.png", name + "/depth-2.png", name + "/cover.png"});
    else files({name + "/" + depth});
    const auto found = filmOverDepth(place);
    ASSERT_TRUE(found) << depth;
    EXPECT_EQ(found->film, place + "/color.mp4");
    EXPECT_EQ(found->depth, place + "/" + depth);
    EXPECT_EQ(depthBeside(place + "/color.mp4"), place + "/" + depth);
    EXPECT_EQ(filmsIn(place), std::nullopt);
    files({name + "/other.mp4"});
    EXPECT_FALSE(filmOverDepth(place)) << "a list of films";
  }
}

TEST_F(FilmFolder, AnArrayIsTheDepthOfTheFilmOrThePicturesBesideIt) {
  for (const char* const name : {"a", "a/rgb", "a/depth", "b", "b/rgb", "c", "d", "d/depth"})
    std::filesystem::create_directory(folder_ / name);
  files({"a/rgb/1.png", "a/rgb/2.png", "a/depth/all.npy", "b/rgb/1.png", "b/rgb/2.png", "b/depth.npy", "c/f1.jpg",
         "c/f2.jpg", "c/depth.npy", "d/film.mp4", "d/depth/all.npy"});
  const auto expect = [&](const char* name, const char* film, const char* depth) {
    const auto found = filmOverDepth(folder_ / name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->film, folder_ / film);
    EXPECT_EQ(found->depth, folder_ / depth);
  };
  expect("a", "a/rgb", "a/depth/all.npy");
  expect("b", "b/rgb", "b/depth.npy");
  expect("c", "c/f*.jpg", "c/depth.npy");
  expect("d", "d/film.mp4", "d/depth/all.npy");
  std::filesystem::create_directory(folder_ / "e");
  files({"e/f1.jpg", "e/f2.jpg", "e/features.npz"});
  EXPECT_FALSE(filmOverDepth(folder_ / "e")) << "an archive of anything";
  files({"e/depths.npz"});
  expect("e", "e/f*.jpg", "e/depths.npz");
  files({"a/depth/more.npy", "c/f2_depth.npy", "d/depth/more.npy"});
  EXPECT_FALSE(filmOverDepth(folder_ / "a")) << "an array for each picture";
  EXPECT_FALSE(filmOverDepth(folder_ / "c"));
  expect("d", "d/film.mp4", "d/depth");
  std::filesystem::remove(folder_ / "c/depth.npy");
  EXPECT_FALSE(filmOverDepth(folder_ / "c")) << "of one picture alone";
}

TEST_F(FilmFolder, AnArrayOfCamerasIsNotTheDepthOfThePicturesBesideIt) {
  const auto place = [&](const std::string& name) {
    std::filesystem::create_directory(folder_ / name);
    for (const char* const picture : {"f1.png", "f2.png"}) files({name + "/" + picture});
    return folder_ / name;
  };
  int count = 0;
  for (const char* const array : {"poses_bounds", "intrinsics", "K", "camera_poses", "timestamps", "c2w"}) {
    const std::string name = std::to_string(count++);
    place(name);
    files({name + "/" + array + ".npy"});
    EXPECT_FALSE(filmOverDepth(folder_ / name)) << array;
    files({name + "/depths.npy"});
    const auto found = filmOverDepth(folder_ / name);
    ASSERT_TRUE(found) << array;
    EXPECT_EQ(found->depth, folder_ / (name + "/depths.npy")) << "the other is no picture";
  }
  std::filesystem::create_directories(folder_ / "llff/images");
  files({"llff/images/1.png", "llff/images/2.png", "llff/poses_bounds.npy"});
  EXPECT_FALSE(filmOverDepth(folder_ / "llff"));
  place("u");
  files({"u/depth.png", "u/more.npy"});
  EXPECT_FALSE(filmOverDepth(folder_ / "u")) << "a picture says that it is the depth";
}

TEST_F(FilmFolder, ASeriesOfPicturesAndARecordingAreNone) {
  EXPECT_EQ(filmsIn(folder_ / "none"), std::nullopt);
  EXPECT_EQ(filmsIn(folder_ / ""), std::nullopt) << "an empty folder";
  files({"preview.mp4"});
  EXPECT_TRUE(filmsIn(folder_ / ""));
  for (int k = 0; k < 11; ++k) files({std::to_string(k) + ".png"});
  EXPECT_EQ(filmsIn(folder_ / ""), std::nullopt) << "eleven pictures beside one film";
  files({"other.mp4"});
  EXPECT_TRUE(filmsIn(folder_ / ""));
  std::filesystem::create_directory(folder_ / "depth");
  EXPECT_EQ(filmsIn(folder_ / ""), std::nullopt) << "a recording";
}

}  // namespace
}  // namespace relievo
