// SPDX-License-Identifier: Apache-2.0
// Which pictures of a folder are taken, and which depth belongs to which colour.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/drivers/pictures/picture_files.h"

namespace relievo {
namespace {
using test::Pictures;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Photos with a depth missing; KITTI 2015, whose second picture of a scene has none.
TEST_F(Pictures, DepthBelongsToTheColourOfItsName) {
  for (const char* name : {"alpha", "beta", "delta", "gamma"}) file("p/images/" + std::string(name) + ".jpg");
  for (const char* name : {"alpha", "delta", "gamma"}) file("p/depth/" + std::string(name) + "_depth.png");
  const Film photos = read(folder_ / "p");
  EXPECT_EQ(photos.color.size(), 4u);
  EXPECT_THAT(photos.depth, ElementsAre("0 p/depth/alpha_depth.png", "10000 p/depth/delta_depth.png",
                                        "15000 p/depth/gamma_depth.png"));
  EXPECT_THAT(photos.notes, Each(Not(HasSubstr("do not correspond"))));
  EXPECT_THAT(photos.notes, Contains("1 of 4 colour pictures have no depth"));
  for (const char* name : {"000000", "000001", "000002"}) {
    file("k/image_2/" + std::string(name) + "_10.png"), file("k/image_2/" + std::string(name) + "_11.png");
    file("k/disp_occ_0/" + std::string(name) + "_10.png");
  }
  EXPECT_EQ(read(folder_ / "k").depth.back(), "20000 k/disp_occ_0/000002_10.png") << "scenes";
  const Film kitti = read(folder_ / "k", 10);
  EXPECT_THAT(kitti.depth, ElementsAre("0 k/disp_occ_0/000000_10.png", "200 k/disp_occ_0/000001_10.png",
                                       "400 k/disp_occ_0/000002_10.png"));
}

// NYCU's and others' depth_true, Depth Anything's depth_vis. Photos, too, may share their numbers.
TEST_F(Pictures, OfSeveralKindsOfDepthForAFrameOneIsTaken) {
  for (const char* name : {"000000", "000001"}) {
    for (const char* kind : {"-color", "-depth", "-depth_true", "-label"})
      file("a/" + std::string(name) + kind + ".png");
    file("b/color/" + std::string(name) + ".png");
    for (const char* kind : {"_depth", "_depth_vis"}) file("b/depth/" + std::string(name) + kind + ".png");
    for (const char* kind : {"", "_raw"}) file("c/depth/" + std::string(name) + kind + ".png");
  }
  const Film a = read(folder_ / "a", 10);
  EXPECT_THAT(a.depth, ElementsAre("0 a/000000-depth.png", "100 a/000001-depth.png"));
  EXPECT_THAT(a.notes, Contains("4 other pictures are left out"));
  EXPECT_THAT(read(folder_ / "b", 10).depth, ElementsAre("0 b/depth/000000_depth.png", "100 b/depth/000001_depth.png"));
  EXPECT_THAT(read(folder_ / "c", 10).color, ElementsAre("0 c/depth/000000.png", "100 c/depth/000001.png"));
  for (const char* name : {"cat1", "dog1", "dog2"})
    file("p/" + std::string(name) + "-image.jpg"), file("p/" + std::string(name) + "-depth.png");
  EXPECT_EQ(read(folder_ / "p").depth.size(), 3u);
}

// The words of one name may hold those of another.
TEST_F(Pictures, PhotosWithoutNumbersAreNoKindsOfDepth) {
  for (const std::string name : {"beach", "beach_sunset", "house"}) {
    file("f/images/" + name + ".jpg"), file("f/depth/" + name + ".png");
    file("o/" + name + ".jpg"), file("o/" + name + "-depth.png");
    file("v/images/" + name + ".jpg"), file("v/depth/" + name + ".png"), file("v/depth/" + name + "_vis.png");
  }
  EXPECT_THAT(read(folder_ / "f").depth,
              ElementsAre("0 f/depth/beach.png", "5000 f/depth/beach_sunset.png", "10000 f/depth/house.png"));
  EXPECT_EQ(read(folder_ / "o").depth.size(), 3u);
  EXPECT_THAT(read(folder_ / "v").depth, Each(Not(HasSubstr("vis"))));
  for (const char* name : {"rgb", "depth", "depth_raw"}) file("s/" + std::string(name) + ".png");
  EXPECT_THAT(read(folder_ / "s").depth, ElementsAre("0 s/depth.png"));
}

// monodepth2: numbers beside a picture of them for the eye.
TEST_F(Pictures, OfTwoEndingsOfDepthTheOneWithNumbersIsTaken) {
  for (const char* name : {"0", "1"}) {
    for (const char* kind : {".png", "_disp.npy", "_disp.jpeg"}) file("m/" + std::string(name) + kind);
    for (const char* kind : {"rgb/", "depth/"})
      for (const char* ending : {".jpg", ".npy"}) file("d/" + std::string(kind) + name + ending);
  }
  EXPECT_EQ(read(folder_ / "m").depth.front(), "0 m/0_disp.npy");
  EXPECT_EQ(read(folder_ / "d").depth.front(), "0 d/depth/0.npy");
  EXPECT_EQ(read(folder_ / "d").color.front(), "0 d/rgb/0.jpg");
}

TEST_F(Pictures, AFolderBesideDepthIsColourIfItsNamesAreThose) {
  for (const char* name : {"1", "2", "3"}) {
    for (const char* folder : {"a/depth", "a/frames", "b/depth", "b/JPEGImages", "c/depth"})
      file(std::string(folder) + "/" + name + ".png");
    for (const char* folder : {"b/Annotated", "c/sketches"}) file(std::string(folder) + "/x" + name + "y.png");
    file("c/vis/" + std::string(name) + ".png");
  }
  file("c/sketches/4.png");
  const Film frames = read(folder_ / "a", 10);
  EXPECT_THAT(frames.color, ElementsAre("0 a/frames/1.png", "100 a/frames/2.png", "200 a/frames/3.png"));
  EXPECT_EQ(frames.depth.size(), 3u);
  const Film several = read(folder_ / "b", 10);
  EXPECT_EQ(several.color.front(), "0 b/JPEGImages/1.png");
  EXPECT_THAT(several.notes, Contains("Annotated is left out: JPEGImages is taken for colour"));
  const Film alone = read(folder_ / "c", 10);
  EXPECT_EQ(alone.streams.size(), 1u) << "neither other names nor painted depth";
  EXPECT_THAT(alone.notes, Contains("sketches is left out: its pictures have no names of the depth's"));
}

// DAVIS; Replica; names that say nothing but of which one holds photographs.
TEST_F(Pictures, OfFoldersWithTheDepthsNamesTheOneOfPhotographsIsColour) {
  for (const std::string name : {"00000", "00001", "00002"}) {
    for (const char* folder : {"d/JPEGImages/", "u/first/", "u/second/"})
      file(folder + name + (folder[2] == 'f' ? ".png" : ".jpg"));
    for (const char* folder : {"d/Annotations/", "d/depth/", "s/depth/", "s/semantics/", "u/depth/", "e/depth/"})
      file(folder + name + ".png");
    file("e/one/" + name + ".jpg"), file("e/two/" + name + ".jpg");
  }
  const Film davis = read(folder_ / "d", 10);
  EXPECT_THAT(davis.color, Each(HasSubstr("JPEGImages")));
  EXPECT_THAT(davis.notes, Each(Not(HasSubstr("is left out"))));
  EXPECT_EQ(read(folder_ / "s", 10).streams.size(), 1u) << "no colour";
  const Film unsaid = read(folder_ / "u", 10);
  EXPECT_THAT(unsaid.color, Each(HasSubstr("second")));
  EXPECT_THAT(unsaid.notes, Contains("first is left out: second is taken for colour"));
  EXPECT_THAT(read(folder_ / "e", 10).notes, Contains("two is left out: one is taken for colour"));
}

TEST_F(Pictures, NumbersThatAreFarApartArePhotos) {
  for (const char* name : {"pexels-106399", "pexels-276724", "pexels-1029604", "pexels-2102587"})
    file("p/images/" + std::string(name) + ".jpg"), file("p/depth/" + std::string(name) + ".png");
  std::filesystem::remove(folder_ / "p/depth/pexels-276724.png");
  const Film stock = read(folder_ / "p");
  EXPECT_THAT(stock.color, ElementsAre("0 p/images/pexels-106399.jpg", "5000 p/images/pexels-276724.jpg",
                                       "10000 p/images/pexels-1029604.jpg", "15000 p/images/pexels-2102587.jpg"));
  EXPECT_THAT(stock.depth, ElementsAre("0 p/depth/pexels-106399.png", "10000 p/depth/pexels-1029604.png",
                                       "15000 p/depth/pexels-2102587.png"));
  EXPECT_THAT(stock.notes, Contains(HasSubstr("photos")));
  // Depth of some pictures of a film.
  for (int k = 0; k <= 400; ++k) file("s/rgb/frame" + std::to_string(k) + ".jpg");
  for (const char* name : {"0", "200", "400"}) file("s/depth/depth" + std::string(name) + ".png");
  EXPECT_THAT(read(folder_ / "s", 10).depth,
              ElementsAre("0 s/depth/depth0.png", "20000 s/depth/depth200.png", "40000 s/depth/depth400.png"));
}

// A recording over midnight, whose ms are told; a counter that is no date.
TEST_F(Pictures, DatesThatDifferByFramesAreNoPhotos) {
  for (const char* name : {"cam_20230101_235959_966", "cam_20230101_235959_999", "cam_20230102_000000_033"})
    file("m/images/" + std::string(name) + ".jpg"), file("m/depth/" + std::string(name) + ".png");
  EXPECT_EQ(read(folder_ / "m").color.back(), "67 m/images/cam_20230102_000000_033.jpg");
  for (const char* name : {"f_0001_19966667", "f_0002_20000000"})
    file("c/images/" + std::string(name) + ".jpg"), file("c/depth/" + std::string(name) + ".png");
  EXPECT_EQ(read(folder_ / "c").color.back(), "33.3333 c/images/f_0002_20000000.jpg");
  for (const char* name : {"IMG-20230101-WA0001", "IMG-20230101-WA0002", "IMG-20230103-WA0000"})
    file("w/images/" + std::string(name) + ".jpg"), file("w/depth/" + std::string(name) + ".png");
  EXPECT_EQ(read(folder_ / "w").color.back(), "10000 w/images/IMG-20230103-WA0000.jpg");
}

TEST_F(Pictures, DatesThatDifferArePhotos) {
  for (const char* name : {"IMG_20230101_101010", "IMG_20230102_111213", "IMG_20230305_151617"})
    file("p/images/" + std::string(name) + ".jpg"), file("p/depth/" + std::string(name) + ".png");
  EXPECT_EQ(read(folder_ / "p").color.back(), "10000 p/images/IMG_20230305_151617.jpg");
  for (const char* name : {"f_0001_162342", "f_0002_162375", "f_0003_162408"})
    file("f/images/" + std::string(name) + ".jpg"), file("f/depth/" + std::string(name) + ".png");
  EXPECT_EQ(read(folder_ / "f").color.back(), "66.6667 f/images/f_0003_162408.jpg");
}

TEST_F(Pictures, IdsOfPhotosAreNoTimes) {
  for (const char* name : {"10815824997", "23456789012", "31415926535", "48151623421", "48151623999"})
    file("p/images/" + std::string(name) + ".jpg"), file("p/depth/" + std::string(name) + ".png");
  const Film ids = read(folder_ / "p");
  EXPECT_EQ(ids.color.back(), "20000 p/images/48151623999.jpg");
  EXPECT_EQ(ids.depth.back(), "20000 p/depth/48151623999.png");
}

TEST_F(Pictures, DatesInOneNumberArePhotos) {
  for (const char* name : {"20240131123456", "20240131123512", "20240131124000"})
    file("p/images/" + std::string(name) + ".jpg"), file("p/depth/" + std::string(name) + ".png");
  EXPECT_EQ(read(folder_ / "p").color.back(), "10000 p/images/20240131124000.jpg") << "on one day";
}

TEST_F(Pictures, ArraysHaveTheirPicturesNames) {
  const std::string gray16 = std::string("\x89PNG\r\n\x1a\n") + std::string(16, '\0') + std::string("\x10\0\0\0\0", 5);
  const std::string array =
      std::string("\x93NUMPY\x01\0\x43\0", 10) + "{'descr': '<f4', 'fortran_order': False, 'shape': (480, 640), }   \n";
  file("j/1.jpg"), file("j/1.npy", array), file("p/1.png"), file("p/1.npy", array);
  file("g/1.png", gray16), file("g/1.pfm");
  EXPECT_THAT(read(folder_ / "j").depth, ElementsAre("0 " + array));
  EXPECT_THAT(read(folder_ / "p").color, ElementsAre("0 p/1.png"));
  EXPECT_THAT(read(folder_ / "p").depth, ElementsAre("0 " + array));
  EXPECT_TRUE(read(folder_ / "g").depth.empty()) << "depth twice";
}

TEST_F(Pictures, SintelsDepthHasItsPicturesNames) {
  for (const char* name : {"frame_0001", "frame_0002"})
    file("s/" + std::string(name) + ".png"), file("s/" + std::string(name) + ".dpt");
  const Film film = read(folder_ / "s", 10);
  EXPECT_THAT(film.color, ElementsAre("0 s/frame_0001.png", "100 s/frame_0002.png"));
  EXPECT_THAT(film.depth, ElementsAre("0 s/frame_0001.dpt", "100 s/frame_0002.dpt"));
}

// KITTI, whose depth lies under its camera's name; Virtual KITTI; Hypersim's numbers.
TEST_F(Pictures, NestedLayoutsAreFoundFromAbove) {
  for (const char* name : {"5", "6"}) {
    for (const char* camera : {"image_00", "image_02", "image_03"}) {
      file("k/drive/" + std::string(camera) + "/data/000000000" + name + ".png");
      for (const char* kind : {"groundtruth", "velodyne_raw"})
        file("k/drive/proj_depth/" + std::string(kind) + "/" + camera + "/000000000" + name + ".png");
    }
    std::filesystem::remove_all(folder_ / "k/drive/proj_depth/groundtruth/image_00");
  }
  EXPECT_THAT(read(folder_ / "k").color,
              ElementsAre("0 k/drive/image_02/data/0000000005.png", "100 k/drive/image_02/data/0000000006.png"));
  EXPECT_THAT(read(folder_ / "k/drive").depth,
              ElementsAre("0 k/drive/proj_depth/groundtruth/image_02/0000000005.png",
                          "100 k/drive/proj_depth/groundtruth/image_02/0000000006.png"));
  file("v/clone/frames/rgb/Camera_0/rgb_00000.jpg"), file("v/clone/frames/depth/Camera_0/depth_00000.png");
  EXPECT_EQ(read(folder_ / "v").color.size(), 1U);
  file("v/fog/frames/rgb/Camera_0/rgb_00000.jpg"), file("v/fog/frames/depth/Camera_0/depth_00000.png");
  const Film scenes = read(folder_ / "v");
  ASSERT_TRUE(scenes.error);
  EXPECT_THAT(scenes.error->message, HasSubstr("holds several recordings"));
  file("h/images/scene_cam_00_geometry_hdf5/frame.0000.depth_meters.hdf5");
  const Film numbers = read(folder_ / "h");
  ASSERT_TRUE(numbers.error);
  EXPECT_THAT(numbers.error->message, HasSubstr("Hypersim"));
  file("h/images/scene_cam_00_final_preview/frame.0000.color.jpg");
  EXPECT_THAT(read(folder_ / "h").notes, Contains(HasSubstr("Hypersim")));
}

TEST_F(Pictures, KnownLayoutsHaveARate) {
  for (const char* name : {"a/scan/00019_00183_indoors_040_010", "a/scan/00019_00183_indoors_100_000"})
    file(std::string(name) + ".png"), file(std::string(name) + "_depth.npy");
  EXPECT_EQ(read(folder_ / "a").color.back(), "5000 a/scan/00019_00183_indoors_100_000.png") << "DIODE";
  for (const char* name : {"000000", "000001"})
    file("b/image_2/" + std::string(name) + ".png"), file("b/image_3/" + std::string(name) + ".png");
  EXPECT_EQ(read(folder_ / "b").color.back(), "100 b/image_2/000001.png") << "KITTI";
  EXPECT_EQ(read(folder_ / "b", 30).color.back(), "33.3333 b/image_2/000001.png") << "the user's word wins";
  for (const char* name : {"1", "2"})
    file("c/clean/frame_000" + std::string(name) + ".png"), file("c/depth/frame_000" + std::string(name) + ".dpt");
  EXPECT_EQ(read(folder_ / "c").color.back(), "41.6667 c/clean/frame_0002.png") << "Sintel";
  for (const char* name : {"00000", "00001"}) {
    file("v/frames/rgb/Camera_0/rgb_" + std::string(name) + ".jpg");
    file("v/frames/depth/Camera_0/depth_" + std::string(name) + ".png");
  }
  EXPECT_EQ(read(folder_ / "v/frames").color.back(), "100 v/frames/rgb/Camera_0/rgb_00001.jpg") << "Virtual KITTI";
}

// Monkaa, whose scenes lie in a folder of pictures and one of disparities, and FlyingThings.
TEST_F(Pictures, DepthInADeeperFolderBelongsToTheColourInTheSameOne) {
  for (const char* view : {"left", "right"}) {
    for (const char* scene : {"a_rain/", "b_rain/"})
      file("m/frames/" + std::string(scene) + view + "/0006.png"),
          file("m/disparity/" + std::string(scene) + view + "/0006.pfm");
    for (const char* kind : {"frames_cleanpass", "frames_finalpass", "optical_flow"})
      file("f/" + std::string(kind) + "/TRAIN/A/0000/" + view + "/0006.png");
    file("f/disparity/TRAIN/A/0000/" + std::string(view) + "/0006.pfm");
  }
  EXPECT_THAT(read(folder_ / "m").color, ElementsAre("0 m/frames/a_rain/left/0006.png"));
  EXPECT_THAT(read(folder_ / "m").depth, ElementsAre("0 m/disparity/a_rain/left/0006.pfm"));
  EXPECT_THAT(read(folder_ / "f").color, ElementsAre("0 f/frames_cleanpass/TRAIN/A/0000/left/0006.png"));
  EXPECT_THAT(read(folder_ / "f").depth, ElementsAre("0 f/disparity/TRAIN/A/0000/left/0006.pfm"));
}

TEST_F(Pictures, KittisSelectionIsPhotosWithTheirUnit) {
  for (const char* drive : {"2011_09_26_drive_0002_sync", "2011_09_28_drive_0037_sync"}) {
    file("k/image/" + std::string(drive) + "_image_0000000005_image_02.png");
    file("k/groundtruth_depth/" + std::string(drive) + "_groundtruth_depth_0000000005_image_02.png");
  }
  const Film film = read(folder_ / "k");
  EXPECT_EQ(film.depth.back(),
            "5000 k/groundtruth_depth/2011_09_28_drive_0037_sync_groundtruth_depth_0000000005_image_02.png");
  EXPECT_EQ(film.streams.back().tags.at("DEPTH_UNIT"), "3.90625");
}

TEST_F(Pictures, WordsThatAllNamesBeginWithTellNothing) {
  file("p/depth_guess_rgb.jpg"), file("p/depth_guess_depth.jpg");
  EXPECT_THAT(read(folder_ / "p").color, ElementsAre("0 p/depth_guess_rgb.jpg"));
  EXPECT_THAT(read(folder_ / "p").depth, ElementsAre("0 p/depth_guess_depth.jpg"));
  file("d/depth_1.png"), file("d/depth_color_1.png");
  EXPECT_THAT(read(folder_ / "d").color, ElementsAre("0 d/depth_1.png")) << "the other is painted";
}

TEST_F(Pictures, DepthOfTwoViewsIsThatOfTheLeftOne) {
  file("a/aloe-L.png"), file("a/aloe-R.png"), file("a/aloe-disp.png");
  EXPECT_THAT(read(folder_ / "a").color, ElementsAre("0 a/aloe-L.png"));
  EXPECT_THAT(read(folder_ / "a").depth, ElementsAre("0 a/aloe-disp.png"));
  file("b/1_l.png"), file("b/1_r.png"), file("b/1_l_depth.png"), file("b/1_r_depth.png");
  EXPECT_EQ(read(folder_ / "b").color.size(), 2U) << "each view has its own";
}

TEST_F(Pictures, DepthThatIsNoPictureIsToldBesideColour) {
  file("r/rgbd/0.jpg"), file("r/rgbd/0.depth"), file("n/0.jpg"), file("n/0.h5");
  EXPECT_THAT(read(folder_ / "r/rgbd").notes, Contains(HasSubstr("LZFSE")));
  EXPECT_THAT(read(folder_ / "n").notes, Contains(HasSubstr("HDF5")));
}

TEST_F(Pictures, FoldersOfTwoViewsAreBoth) {
  for (const char* view : {"left", "right"})
    file("s/frame_" + std::string(view) + "/0001.png"), file("t/image_" + std::string(view) + "/0001.png");
  EXPECT_EQ(read(folder_ / "s").depth.back(), "0 s/frame_right/0001.png") << "Spring";
  EXPECT_EQ(read(folder_ / "t").depth.back(), "0 t/image_right/0001.png") << "TartanAir";
}

}  // namespace
}  // namespace relievo
