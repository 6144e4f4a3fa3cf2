// SPDX-License-Identifier: Apache-2.0
// Folders, patterns and lists of pictures: which pictures they name, when each was taken, and which are pairs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "drivers/pictures/layouts.h"
#include "hal/media/media_names.h"
#include "tests/unit/drivers/pictures/picture_files.h"

namespace relievo {
namespace {
using namespace std::chrono_literals;
using test::Pictures;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(PictureLayouts, NyusBytesAreSwappedOnlyIfThatMakesThemSound) {
  std::vector<std::uint8_t> pgm{'P', '5', '\n', '2',  ' ',  '1',  '\n', '6', '5',
                                '5', '3', '5',  '\n', 0x2c, 0x01, 0xff, 0x07};
  auto mended = pgm;
  pictures::mendByteOrder(mended);  // 300 and 2047
  EXPECT_THAT(std::vector(mended.end() - 4, mended.end()), ElementsAre(0x01, 0x2c, 0x07, 0xff));
  const auto again = mended;
  pictures::mendByteOrder(mended);
  EXPECT_EQ(mended, again);
  EXPECT_TRUE(pictures::isNyuDepth("a/d-1.5-2.pgm"));
  EXPECT_FALSE(pictures::isNyuDepth("a/r-1.5-2.ppm"));
}

TEST_F(Pictures, APatternHasAnyFirstNumberAndGapsAreTime) {
  for (const char* name :
       {"p00100.png", "p00099.png", "p00102.png", "q00101.png", "p00101.jpg", "p0x101.png", "p7.png"}) {
    file(name);
  }
  const Film film = read(folder_ / "p%05d.png", 50);
  EXPECT_THAT(film.color, ElementsAre("0 p00099.png", "20 p00100.png", "60 p00102.png"));
  EXPECT_EQ(film.duration, 80ms);
  EXPECT_EQ(film.streams.at(0).frame_period, 20ms);
  EXPECT_THAT(film.notes, ElementsAre(HasSubstr("1 of the numbers 99 to 102 is missing: the picture before it")));
  EXPECT_EQ(read(folder_ / "p*.png", 25).color.size(), 5u);
  EXPECT_EQ(read(folder_ / "x%05d.png").error->code, ErrorCode::NotFound);
}

TEST_F(Pictures, ANumbersTimeIsExactHoweverFarItIs) {
  file("1.png"), file("100001.png");
  const Film film = read(folder_ / "%d.png", 30);
  EXPECT_THAT(film.color.back(), "3.33333e+06 100001.png");
  const auto source = makePicturesSource(describe);
  source->setPictureRate(30);
  ASSERT_TRUE(source->open(folder_ / "%d.png"));
  ASSERT_TRUE(source->read());
  EXPECT_EQ((*source->read())->pts, MediaTime(3'333'333'333'333ns)) << "100,000 / 30 s, not 100,000 rounded periods";
}

TEST_F(Pictures, LeftAndRightInOneFolderAreTwoViews) {
  for (const char* name : {"l_1.png", "r_1.png", "l_2.png", "r_2.png"}) file("v/" + std::string(name));
  const Film film = read(folder_ / "v", 10);
  EXPECT_THAT(film.color, ElementsAre("0 v/l_1.png", "100 v/l_2.png"));
  EXPECT_THAT(film.depth, ElementsAre("0 v/r_1.png", "100 v/r_2.png"));
  ASSERT_EQ(film.streams.size(), 2u);
  EXPECT_EQ(film.streams[1].tags.at(kViewTag), "right");
  file("d/l_1.jpg"), file("d/r_1.jpg"), file("d/l_1.pfm"), file("d/r_1.pfm");
  EXPECT_THAT(read(folder_ / "d").depth, ElementsAre("0 d/l_1.pfm", "5000 d/r_1.pfm")) << "depth of each, no views";
}

TEST_F(Pictures, NaturalOrderWhereNamesAreNoNumbers) {
  file("a-2.png"), file("a-10.png"), file("cover.png"), file("b.png");
  EXPECT_THAT(read(folder_ / "", 10).color, ElementsAre("0 a-2.png", "100 a-10.png", "200 b.png", "300 cover.png"));
}

TEST_F(Pictures, DepthGoesToTheNearestColourWithin20Ms) {
  // associate.py of the TUM tools pairs 0.100 with 0.095 and 0.133 with 0.130, and leaves 0.200 and 0.225 alone.
  for (const char* name : {"rgb/10.100.png", "rgb/10.133.png", "rgb/10.200.png", "depth/10.095.png", "depth/10.112.png",
                           "depth/10.130.png", "depth/10.225.png"}) {
    file("tum/" + std::string(name));
  }
  Film film = read(folder_ / "tum");
  EXPECT_THAT(film.color, ElementsAre("0 tum/rgb/10.100.png", "33 tum/rgb/10.133.png", "100 tum/rgb/10.200.png"));
  EXPECT_THAT(film.depth, ElementsAre("0 tum/depth/10.095.png", "12 tum/depth/10.112.png", "33 tum/depth/10.130.png",
                                      "125 tum/depth/10.225.png"));
  EXPECT_THAT(film.notes, ElementsAre("1 of 3 colour pictures have no depth within 20 ms"));
  ASSERT_EQ(film.streams.size(), 2u);
  EXPECT_EQ(film.streams[1].tags.at("TITLE"), "depth");
  EXPECT_EQ(film.streams[1].tags["LAYOUT"], "tum");
}

TEST_F(Pictures, AListSaysWhatBelongsTogether) {
  file("t/rgb/1.jpg"), file("t/rgb/2.jpg"), file("t/rgb/3.jpg"), file("t/depth/1.png"), file("t/depth/2.png");
  const std::string list = file("t/associations.txt",
                                "# depth first\n5.01 depth/1.png 5.0 rgb/2.jpg\n"
                                "5.2 depth/2.png 5.25 rgb/3.jpg\n");
  for (const std::string& url : {list, folder_ / "t", "file:" + list}) {
    const Film film = read(url);
    EXPECT_THAT(film.color, ElementsAre("0 t/rgb/2.jpg", "250 t/rgb/3.jpg")) << url;
    EXPECT_THAT(film.depth, ElementsAre("0 t/depth/1.png", "250 t/depth/2.png")) << url;
  }
  EXPECT_EQ(read(file("no.txt", "1 a\n")).error->code, ErrorCode::Corrupt);
}

TEST_F(Pictures, NumbersPairColourAndDepthInOneFolderAndInTwo) {
  for (const char* name :
       {"frame-000006.color.jpg", "frame-000005.color.jpg", "frame-000006.depth.png", "frame-000007.depth.png",
        "frame-000004.depth.png", "frame-000005.pose.txt", "frame-000005.mask.png"}) {
    file("seven/" + std::string(name));
  }
  const Film seven = read(folder_ / "seven", 10);
  EXPECT_THAT(seven.color, ElementsAre("0 seven/frame-000005.color.jpg", "100 seven/frame-000006.color.jpg"));
  EXPECT_THAT(seven.depth, ElementsAre("100 seven/frame-000006.depth.png", "200 seven/frame-000007.depth.png"));
  EXPECT_EQ(seven.streams.at(1).tags.count("DEPTH_UNIT"), 0u) << "mm, as its first picture shows";
  file("scan/color/9.jpg"), file("scan/color/10.jpg"), file("scan/depth/10.png"), file("scan/depth/9.png");
  const Film scan = read(folder_ / "scan");
  EXPECT_THAT(scan.color, ElementsAre("0 scan/color/9.jpg", "33.3333 scan/color/10.jpg"));
  EXPECT_THAT(scan.depth, ElementsAre("0 scan/depth/9.png", "33.3333 scan/depth/10.png"));
  EXPECT_THAT(scan.notes, ElementsAre(HasSubstr("30 pictures a second assumed")));
}

TEST_F(Pictures, OneRateIsAssumedForFoldersAndPatterns) {
  file("n/1.png"), file("n/2.png");
  for (const char* url : {"n", "n/%d.png", "n/*.png"}) {
    const Film film = read(folder_ / url);
    EXPECT_EQ(film.color.back(), "33.3333 n/2.png") << url;
    EXPECT_THAT(film.notes, ElementsAre(HasSubstr("30 pictures a second assumed")));
  }
}

// Redwood's times are no seconds, and its codes are mm.
TEST_F(Pictures, SecondsAndListsAloneSpeakForTumsLayout) {
  const auto saysLayout = [&](const std::string& name, const std::string& time) {
    file(name + "/rgb/" + time + ".jpg"), file(name + "/depth/" + time + ".png");
    return read(folder_ / name).streams.at(1).tags.contains("LAYOUT");
  };
  EXPECT_TRUE(saysLayout("t", "1305031102.160407"));
  EXPECT_TRUE(saysLayout("s", "10.225000"));
  EXPECT_FALSE(saysLayout("r", "0000001-000000033369"));
  EXPECT_FALSE(saysLayout("n", "1403636579763555584"));
  file("n/associations.txt", "1 rgb/1403636579763555584.jpg 1 depth/1403636579763555584.png\n");
  EXPECT_TRUE(saysLayout("n", "1403636579763555584")) << "a list";
}

// Kubric's layers in one folder; Sintel's and HoloLens' folders.
TEST_F(Pictures, LayersBesideColourAndDepthAreLeftOut) {
  for (const char* layer : {"rgba", "forward_flow", "backward_flow", "object_coordinates", "segmentation", "normal"}) {
    file("kubric/" + std::string(layer) + "_00000.png"), file("kubric/" + std::string(layer) + "_00001.png");
  }
  file("kubric/depth_00000.tiff"), file("kubric/depth_00001.tiff");
  const Film kubric = read(folder_ / "kubric");
  EXPECT_THAT(kubric.color, ElementsAre("0 kubric/rgba_00000.png", "33.3333 kubric/rgba_00001.png"));
  EXPECT_THAT(kubric.depth, ElementsAre("0 kubric/depth_00000.tiff", "33.3333 kubric/depth_00001.tiff"));
  file("sintel/clean_left/alley/1.png"), file("sintel/disparities/alley/1.png"), file("sintel/occlusions/alley/1.png");
  EXPECT_THAT(read(folder_ / "sintel").color, ElementsAre("0 sintel/clean_left/alley/1.png"));
  EXPECT_THAT(read(folder_ / "sintel").depth, ElementsAre("0 sintel/disparities/alley/1.png"));
  file("mvtec/rgb/000.png"), file("mvtec/xyz/000.tiff");
  EXPECT_THAT(read(folder_ / "mvtec").depth, ElementsAre("0 mvtec/xyz/000.tiff"));
  file("holo/PV/1.png"), file("holo/Depth Long Throw/1.pgm"), file("holo/Depth Long Throw/1_ab.pgm");
  EXPECT_THAT(read(folder_ / "holo").color, ElementsAre("0 holo/PV/1.png"));
  EXPECT_THAT(read(folder_ / "holo").depth, ElementsAre("0 holo/Depth Long Throw/1.pgm"));
  EXPECT_THAT(read(folder_ / "holo").notes, ElementsAre(HasSubstr("1 other pictures are left out")));
  // SceneNet, InteriorNet, Washington's RGB-D objects.
  file("net/photo/0.jpg"), file("net/depth/0.png"), file("net/instance/0.png");
  EXPECT_THAT(read(folder_ / "net").color, ElementsAre("0 net/photo/0.jpg"));
  file("in/cam0/data/7.png"), file("in/depth0/data/7.png"), file("in/label0/data/7.png");
  EXPECT_THAT(read(folder_ / "in").color, ElementsAre("0 in/cam0/data/7.png"));
  file("uw/apple_crop.png"), file("uw/apple_depthcrop.png"), file("uw/apple_maskcrop.png");
  EXPECT_THAT(read(folder_ / "uw").depth, ElementsAre("0 uw/apple_depthcrop.png"));
  // A Kinect's raw codes beside its colour.
  file("raw/0001.ppm"), file("raw/rawdepth0001.ppm");
  EXPECT_THAT(read(folder_ / "raw").color, ElementsAre("0 raw/0001.ppm"));
  EXPECT_THAT(read(folder_ / "raw").depth, ElementsAre("0 raw/rawdepth0001.ppm"));
  // Names that hold a word of colour or depth, and one of a layer.
  for (const char* name : {"color", "depth", "color_mask", "depth_confidence"})
    file("scan/" + std::string(name) + "_1.png");
  EXPECT_THAT(read(folder_ / "scan").color, ElementsAre("0 scan/color_1.png"));
  EXPECT_THAT(read(folder_ / "scan").depth, ElementsAre("0 scan/depth_1.png"));
}

// LabelFusion; a folder for each camera.
TEST_F(Pictures, AFolderNamedForColourMayHoldBoth) {
  file("l/images/1_rgb.png"), file("l/images/1_depth.png"), file("l/images/1_labels.png");
  EXPECT_THAT(read(folder_ / "l").color, ElementsAre("0 l/images/1_rgb.png"));
  EXPECT_THAT(read(folder_ / "l").depth, ElementsAre("0 l/images/1_depth.png"));
  file("c/cam_0/rgb/1.png"), file("c/cam_0/depth/1.png");
  EXPECT_THAT(read(folder_ / "c").color, ElementsAre("0 c/cam_0/rgb/1.png"));
  EXPECT_THAT(read(folder_ / "c").depth, ElementsAre("0 c/cam_0/depth/1.png"));
  file("c/cam_1/rgb/1.png"), file("c/cam_1/depth/1.png"), file("c/cam_2/rgb/1.png"), file("c/cam_2/depth/1.png");
  EXPECT_THAT(read(folder_ / "c").color, ElementsAre("0 c/cam_0/rgb/1.png"));
  EXPECT_THAT(read(folder_ / "c").depth, ElementsAre("0 c/cam_0/depth/1.png"));
  EXPECT_THAT(read(folder_ / "c").notes, Contains(HasSubstr("4 other pictures are left out")));
}

// KITTI, KITTI-360, whose second pair are fisheyes, EuRoC, other rigs of two cameras; the only scene of a folder.
TEST_F(Pictures, FoldersOfTwoCamerasAreTwoViews) {
  for (const char* name :
       {"k/image_00/data", "k/image_01/data", "k/image_02/data", "k/image_03/data", "k360/image_00/data_rect",
        "k360/image_01/data_rect", "k360/image_02/data_rgb", "k360/image_03/data_rgb", "e/cam0/data", "e/cam1/data",
        "e/body", "r/cam_0", "r/cam_1", "ring/cam_0", "ring/cam_1", "ring/cam_2", "p/scene/left", "p/scene/right"}) {
    file(std::string(name) + "/7.png");
  }
  const auto viewsOf = [&](const std::string& folder) {
    const Film film = read(folder_ / folder);
    const auto isRight = [](const StreamInfo& stream) { return stream.tags.contains(kViewTag); };
    EXPECT_EQ(std::ranges::count_if(film.streams, isRight), folder == "ring" ? 0 : 2) << folder;
    return film.color.at(0) + " " + (film.depth.empty() ? "" : film.depth.at(0));
  };
  EXPECT_EQ(viewsOf("k"), "0 k/image_02/data/7.png 0 k/image_03/data/7.png");
  EXPECT_EQ(viewsOf("k360"), "0 k360/image_00/data_rect/7.png 0 k360/image_01/data_rect/7.png");
  EXPECT_EQ(viewsOf("e"), "0 e/cam0/data/7.png 0 e/cam1/data/7.png");
  EXPECT_EQ(viewsOf("r"), "0 r/cam_0/7.png 0 r/cam_1/7.png");
  EXPECT_EQ(viewsOf("p"), "0 p/scene/left/7.png 0 p/scene/right/7.png");
  EXPECT_EQ(viewsOf("ring"), "0 ring/cam_0/7.png ");
}

TEST_F(Pictures, DepthThatIsPaintedIsTakenOnlyWhereThereIsNoOther) {
  for (const char* name : {"a/color_0", "a/depth_0", "a/depth_vis_0", "b/rgb/0", "b/depth_raw/0", "b/depth_colored/0",
                           "c/0_rgb", "c/0_depth", "c/0_depth_colormap", "d/color_0", "d/depth_vis_0"}) {
    file(std::string(name) + ".png");
  }
  EXPECT_THAT(read(folder_ / "a").depth, ElementsAre("0 a/depth_0.png"));
  EXPECT_THAT(read(folder_ / "b").depth, ElementsAre("0 b/depth_raw/0.png"));
  EXPECT_THAT(read(folder_ / "c").depth, ElementsAre("0 c/0_depth.png"));
  EXPECT_THAT(read(folder_ / "d").depth, ElementsAre("0 d/depth_vis_0.png"));
}

TEST_F(Pictures, NamesThatDoNotCorrespondArePairedInTheirOrder) {
  file("s/image/NYU0001.jpg"), file("s/depth/kv7.png");
  const Film film = read(folder_ / "s");
  EXPECT_THAT(film.color, ElementsAre("0 s/image/NYU0001.jpg"));
  EXPECT_THAT(film.depth, ElementsAre("0 s/depth/kv7.png"));
  EXPECT_THAT(film.notes, IsEmpty()) << "one picture";
  file("s/image/NYU0002.jpg"), file("s/depth/kv8.png");
  EXPECT_THAT(read(folder_ / "s").notes, Contains(HasSubstr("paired in their order")));
}

// A stereo pair's disparity among pictures of other scenes: felt under the first of them it would be wrong.
TEST_F(Pictures, AFewDepthsWhoseNamesFitNoPictureAreLeftOut) {
  for (const char* name : {"000001.png", "000002.png", "LK1.png", "LK2.png", "left.png"})
    file("s/" + std::string(name));
  file("s/disparity.png");
  const Film film = read(folder_ / "s");
  EXPECT_EQ(film.color.size(), 5u);
  EXPECT_THAT(film.depth, IsEmpty());
  EXPECT_THAT(film.notes, Contains(AllOf(HasSubstr("disparity.png"), HasSubstr("--depth"))));
}

TEST_F(Pictures, DepthInAFolderOfItsOwnMayEndEarly) {
  for (int k = 0; k < 30; ++k) file("rd/rgb/img00" + std::to_string(10 + k) + ".png");
  for (int k = 0; k < 13; ++k) file("rd/depth/d0050" + std::to_string(10 + k) + ".png");
  const Film film = read(folder_ / "rd");
  EXPECT_EQ(film.depth.size(), 13u);
  EXPECT_THAT(film.notes, Contains(HasSubstr("paired in their order")));
}

TEST_F(Pictures, ASeekBeginsWithThePicturesAtTheTarget) {
  for (int k = 0; k < 9; ++k) file("r/rgb/" + std::to_string(k) + ".png");
  file("r/depth/0.png"), file("r/depth/6.png");
  const Film film = read(folder_ / "r", 10, MediaTime(450ms));
  EXPECT_THAT(film.color, ElementsAre("400 r/rgb/4.png", "500 r/rgb/5.png", "600 r/rgb/6.png", "700 r/rgb/7.png",
                                      "800 r/rgb/8.png"));
  EXPECT_THAT(film.depth, ElementsAre("0 r/depth/0.png", "600 r/depth/6.png"));
  EXPECT_THAT(read(folder_ / "r", 10, MediaTime(1h)).color, ElementsAre("800 r/rgb/8.png"));
}

TEST_F(Pictures, OneThatHasGoneIsPassedOverNamedAndCounted) {
  file("1.png"), file("2.png"), file("3.png");
  const auto source = makePicturesSource(describe);
  ASSERT_TRUE(source->open(folder_ / "%d.png"));
  std::filesystem::remove(folder_ / "2.png");
  EXPECT_EQ(line(**source->read()), "0 1.png");
  testing::internal::CaptureStderr();
  EXPECT_EQ(line(**source->read()), "66.6667 3.png");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("2.png: cannot be opened"));
  EXPECT_EQ(source->missedPictures(), 1u);
  EXPECT_FALSE(*source->read());
  EXPECT_EQ(source->missing(), 33'333'333ns);
}

// The file is sparse: it takes no space on the disk.
TEST_F(Pictures, AFileThatIsTooLargeIsNotLookedInto) {
  for (const auto& [name, most] : {std::pair("1.png", 140'000'000), std::pair("1.pfm", 300'000'000)}) {
    const std::string path = file(name);
    std::filesystem::resize_file(path, 3'000'000'000);
    const auto alone = read(path);
    ASSERT_TRUE(alone.error) << name;
    EXPECT_EQ(alone.error->code, ErrorCode::Exhausted);
    EXPECT_THAT(alone.error->message, HasSubstr(most < 200'000'000 ? "larger than 140 MB" : "larger than 300 MB"));
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(most) + 1);
    EXPECT_TRUE(read(path).error) << name;
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(most));
    EXPECT_TRUE(makePicturesSource(describe)->open(path)) << name;
  }
  file("2.png");
  std::filesystem::resize_file(folder_ / "1.png", 3'000'000'000);
  EXPECT_THAT(read(folder_ / "%d.png").color, ElementsAre("33.3333 2.png"));
}

TEST_F(Pictures, ALargeFolderIsListedNotRead) {
  for (int k = 0; k < 10'000; ++k) std::ofstream(folder_ / (std::to_string(k) + ".png")) << k;
  int described = 0;
  const auto source = makePicturesSource([&, thread = std::this_thread::get_id()](const std::string& path) {
    described += thread == std::this_thread::get_id() ? 1 : 100;  // elsewhere, a slow one would count as a stalled disk
    return describe(path);
  });
  ASSERT_TRUE(source->open(folder_ / ""));
  EXPECT_EQ(described, 1);
  ASSERT_TRUE(source->seek(MediaTime(300s)));
  EXPECT_EQ(line(**source->read()), "300000 9000");
}

TEST_F(Pictures, SaysWhatAFolderLacks) {
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_THAT(read(folder_ / "empty").error->message, HasSubstr("no picture"));
  file("films/a.mkv"), file("films/poster.jpg");
  EXPECT_THAT(read(folder_ / "films").error->message, HasSubstr("list of films"));
  file("db3/metadata.yaml"), file("db3/db3_0.db3"), file("mcap/mcap_0.mcap");
  for (const char* const bag : {"db3", "mcap"}) {
    EXPECT_THAT(read(folder_ / bag).error->message, HasSubstr("list of films"));
  }
  file("raw/depth_0.raw"), file("h5/0.hdf5"), file("mat/0.mat");
  EXPECT_THAT(read(folder_ / "raw").error->message, HasSubstr("ffmpeg -f rawvideo"));
  EXPECT_THAT(read(folder_ / "h5").error->message, HasSubstr("h5py"));
  EXPECT_THAT(read(folder_ / "mat").error->message, HasSubstr("scipy.io.loadmat"));
  file("mat/0.mat", "MATLAB 7.3 MAT-file, Platform: GLNXA64");
  EXPECT_THAT(read(folder_ / "mat").error->message, HasSubstr("h5py.File"));
}

TEST_F(Pictures, WhatTheyAreIsToldFromNamesAlone) {
  const std::string one = file("a.png"), film = file("b.mkv"), odd = file("50%d.png"), list = file("l.txt");
  for (const std::string& url : {one, odd, list, folder_ / "", folder_ / "%d.png", folder_ / "*.jpg", "file:" + one}) {
    EXPECT_TRUE(isPictures(url)) << url;
  }
  for (const std::string& url :
       {film, folder_ / "none.png", folder_ / "*.mkv", std::string("http://a/*.png"), std::string("mock:")}) {
    EXPECT_FALSE(isPictures(url)) << url;
  }
  EXPECT_THAT(read(odd).color, ElementsAre("0 50%d.png")) << "a file is a file whatever its name looks like";
}
}  // namespace
}  // namespace relievo
