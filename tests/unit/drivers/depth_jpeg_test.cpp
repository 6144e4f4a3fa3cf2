// SPDX-License-Identifier: Apache-2.0
// JPEG photos with a depth map in their metadata or behind the picture, put together here byte by byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <vector>

#include "app/media/photo_list.h"
#include "app/media/reading/known_kind.h"
#include "drivers/photo/photo.h"
#include "drivers/registry.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"

namespace relievo {
namespace {

using test::contentOf;

constexpr int kCols = 48, kRows = 32;
constexpr double kNear = 0.5, kFar = 4.0;  // metres

double metresAt(int, int r) {
  return 0.6 + 0.1 * r;
}

std::string picture(const std::string& name, const std::string& codec, const std::string& format,
                    std::function<std::uint32_t(int, int, int, int)> sample) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / name, {{.codec = codec,
                                  .pix_fmt = format,
                                  .width = kCols,
                                  .height = kRows,
                                  .frames = 1,
                                  .range = ColorRange::Full,
                                  .sample = std::move(sample)}});
  return contentOf(folder / name);
}
const std::string& colorJpeg() {
  static const std::string jpeg = picture("c.jpg", "mjpeg", "yuvj420p", [](int k, int c, int, int) {
    return static_cast<std::uint32_t>(k == 0 ? 100 + 2 * c : 128 + 15 * k);
  });
  return jpeg;
}
// By the definition of Google's depthmap metadata.
std::uint32_t inverseCode(int c, int r) {
  const double z = metresAt(c, r);
  return static_cast<std::uint32_t>(std::lround(255 * kFar * (z - kNear) / (z * (kFar - kNear))));
}
std::uint32_t linearCode(int c, int r) {
  return static_cast<std::uint32_t>(std::lround(255 * (metresAt(c, r) - kNear) / (kFar - kNear)));
}
std::string inversePng() {
  return picture("d.png", "png", "gray", [](int, int c, int r, int) { return inverseCode(c, r); });
}
std::string linearPng() {
  return picture("d.png", "png", "gray", [](int, int c, int r, int) { return linearCode(c, r); });
}
std::string inverseJpeg() {
  return picture("d.jpg", "mjpeg", "yuvj420p",
                 [](int k, int c, int r, int) { return k == 0 ? inverseCode(c, r) : 128u; });
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string number(std::size_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return text;
}
std::string app1(const std::string& content) {
  return "\xff\xe1" + number(content.size() + 2, 2) + content;
}
std::string standardXmp(const std::string& inside) {
  return app1(std::string("http://ns.adobe.com/xap/1.0/\0", 29) + "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF>" +
              inside + "</rdf:RDF></x:xmpmeta>");
}
// Segments of at most `most` bytes of the packet, shuffled.
std::string extendedXmp(const std::string& packet, std::size_t most) {
  std::string segments;
  const std::size_t count = (packet.size() + most - 1) / most;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t offset = (count - 1 - k) * most;
    segments += app1(std::string("http://ns.adobe.com/xmp/extension/\0", 35) + std::string(32, 'A') +
                     number(packet.size(), 4) + number(offset, 4) + packet.substr(offset, most));
  }
  return segments;
}
std::string meaning(const std::string& format, const std::string& near, const std::string& far,
                    const std::string& units) {
  return "GDepth:Format=\"" + format + "\" GDepth:Near=\"" + near + "\" GDepth:Far=\"" + far + "\" GDepth:Units=\"" +
         units + "\" GDepth:Mime=\"image/png\" ";
}
void write(const std::string& path, const std::string& segments, const std::string& behind = "") {
  std::ofstream(path, std::ios::binary) << colorJpeg().substr(0, 2) << segments << colorJpeg().substr(2) << behind;
}

void expectPhoto(const std::string& path, double tolerance = 0.02) {
  const test::OpenedFilm photo = test::openFilm({.url = path});
  ASSERT_TRUE(photo.info.has_depth);
  EXPECT_EQ(photo.info.frame_period, Duration(0)) << "a photo";
  EXPECT_EQ(photo.info.packing, Packing::Tracks);
  EXPECT_EQ(photo.info.color_width, kCols);
  EXPECT_EQ(photo.info.depth_width, kCols);
  EXPECT_NEAR(test::sampleAt(photo.pair.color, 0, 40, 16), 180, 6);
  EXPECT_NEAR(photo.info.calibration.calibration.near_mm, 1000 * kNear, 1e-6);
  EXPECT_NEAR(photo.info.calibration.calibration.far_mm, 1000 * kFar, 1e-6);
  for (int r = 0; r < kRows; r += 5) {
    ASSERT_NEAR(photo.distanceAt(17, r), 1000 * metresAt(17, r), 1000 * tolerance * metresAt(17, r)) << r;
  }
}

TEST(DepthJpeg, StandardXmpWithInverseAndLinearRanges) {
  const test::TemporaryFolder folder;
  write(folder / "a.jpg", standardXmp("<rdf:Description " + meaning("RangeInverse", "0.5", "4.0", "m") +
                                      "GDepth:Data=\"" + base64(inversePng()) + "\"/>"));
  expectPhoto(folder / "a.jpg");
  write(folder / "b.jpg", standardXmp("<rdf:Description " + meaning("RangeLinear", "500", "4000", "mm") +
                                      "GDepth:Data=\"" + base64(linearPng()) + "\"/>"));
  expectPhoto(folder / "b.jpg");
  write(folder / "c.jpg", standardXmp("<rdf:Description><GDepth:Format>RangeInverse</GDepth:Format><GDepth:Near>0.5"
                                      "</GDepth:Near><GDepth:Far>4</GDepth:Far><GDepth:Data>" +
                                      base64(inverseJpeg()) + "</GDepth:Data></rdf:Description>"));
  expectPhoto(folder / "c.jpg", 0.06);
}

TEST(DepthJpeg, ExtendedXmpOverSeveralSegments) {
  const test::TemporaryFolder folder;
  const std::string packet = "<rdf:Description GDepth:Data=\"" + base64(inversePng()) + "\"/>";
  ASSERT_GT(packet.size(), 200u);
  write(folder / "a.jpg", standardXmp("<rdf:Description " + meaning("RangeInverse", "0.5", "4.0", "m") +
                                      "xmpNote:HasExtendedXMP=\"" + std::string(32, 'A') + "\"/>") +
                              extendedXmp(packet, 97));
  expectPhoto(folder / "a.jpg");
}

TEST(DepthJpeg, FindsDynamicDepthBehindThePicture) {
  const test::TemporaryFolder folder;
  const std::string map = inversePng();
  const auto item = [](const std::string& mime, std::size_t bytes, const std::string& uri) {
    return "<rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Mime=\"" + mime + "\" Item:Length=\"" +
           std::to_string(bytes) + "\" Item:DataURI=\"" + uri + "\"/></rdf:li>";
  };
  write(folder / "a.jpg",
        standardXmp("<rdf:Description><Device:Container><Container:Directory><rdf:Seq>" +
                    item("image/jpeg", 0, "primary_image") + item("image/png", map.size(), "android/depthmap") +
                    item("image/png", 9, "android/confidencemap") +
                    "</rdf:Seq></Container:Directory></Device:Container><Camera:DepthMap "
                    "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"0.5\" DepthMap:Far=\"4\" "
                    "DepthMap:Units=\"Meters\"/></rdf:Description>"),
        map + "something");
  expectPhoto(folder / "a.jpg");
}

TEST(DepthJpeg, BothPicturesAreTurnedUpright) {
  const test::TemporaryFolder folder;
  const std::string exif = app1(std::string("Exif\0\0MM\0\x2a", 10) + number(8, 4) + number(1, 2) + number(0x112, 2) +
                                number(3, 2) + number(1, 4) + number(6, 2) + number(0, 2) + number(0, 4));
  write(folder / "a.jpg", exif + standardXmp("<rdf:Description " + meaning("RangeInverse", "0.5", "4.0", "m") +
                                             "GDepth:Data=\"" + base64(inversePng()) + "\"/>"));
  const test::OpenedFilm photo = test::openFilm({.url = folder / "a.jpg"});
  ASSERT_EQ(photo.info.color_width, kRows);
  ASSERT_EQ(photo.info.depth_width, kRows);
  // A quarter turn clockwise: row r becomes column rows - 1 - r.
  EXPECT_NEAR(photo.distanceAt(kRows - 1 - 5, 20), 1000 * metresAt(20, 5), 25);
  EXPECT_NEAR(test::sampleAt(photo.pair.color, 0, 16, 40), 180, 6);
}

TEST(DepthJpeg, OtherPhotosAreColourAlone) {
  const test::TemporaryFolder folder;
  const std::string map = base64(inversePng());
  for (const std::string& segments :
       {std::string(), standardXmp("<rdf:Description GDepth:Near=\"1\"/>"),
        standardXmp("<rdf:Description GDepth:Data=\"???\"/>"), standardXmp("<rdf:Description GDepth:Data=\"AAAA\"/>"),
        standardXmp("<rdf:Description GDepth:Data=\"" + map),
        extendedXmp("<rdf:Description GDepth:Data=\"" + map + "\"/>", 97).substr(0, 300)}) {
    write(folder / "a.jpg", segments);
    const test::OpenedFilm photo = test::openFilm({.url = folder / "a.jpg"});
    EXPECT_FALSE(photo.info.has_depth) << segments.substr(0, 200);
    EXPECT_EQ(photo.info.color_width, kCols);
  }
}

// Each look for the value of a name may go to the end of a long text.
TEST(DepthJpeg, ANameWithoutAValueIsLookedAtABoundedNumberOfTimes) {
  const test::TemporaryFolder folder;
  for (const int names : {4, 100}) {
    std::string xmp = "<rdf:Description " + meaning("RangeInverse", "0.5", "4.0", "m");
    for (int i = 0; i < names; ++i) xmp += "GDepth:Data=none ";
    write(folder / "a.jpg", standardXmp(xmp + "GDepth:Data=\"" + base64(inversePng()) + "\"/>"));
    EXPECT_EQ(test::openFilm({.url = folder / "a.jpg"}).info.has_depth, names == 4) << names;
  }
}

// The file is sparse: it takes no space on the disk.
TEST(DepthJpeg, AFileThatIsTooLargeIsNotRead) {
  const test::TemporaryFolder folder;
  write(folder / "a.jpg", standardXmp("<rdf:Description " + meaning("RangeInverse", "0.5", "4.0", "m") +
                                      "GDepth:Data=\"" + base64(inversePng()) + "\"/>"));
  const PhotoKind kinds[] = {kDepthJpeg, kStereoJpeg};
  EXPECT_TRUE(isPhoto(folder / "a.jpg", kinds));
  std::filesystem::resize_file(folder / "a.jpg", 140'000'001);
  EXPECT_FALSE(isPhoto(folder / "a.jpg", kinds));
}

TEST(DepthJpeg, ASizeThatLiesMakesNoMemory) {
  const test::TemporaryFolder folder;
  std::string segment = extendedXmp("<rdf:Description/>", 97);
  const std::size_t whole = segment.find(std::string(32, 'A')) + 32;
  segment.replace(whole, 8, "\xf0\xff\xff\xff\xef\xff\xff\xff");
  write(folder / "a.jpg", standardXmp("<rdf:Description/>") + segment);
  EXPECT_FALSE(test::openFilm({.url = folder / "a.jpg"}).info.has_depth);
}

using MakeSource = std::function<std::unique_ptr<MediaSource>(const std::string&)>;
std::vector<std::string> listed(const SourceOptions& options, const MakeSource& make = drivers::makeMediaSource) {
  std::vector<std::string> titles;
  for (const PlaylistEntry& photo : photosIn(options, make).value_or(std::vector<PlaylistEntry>{})) {
    titles.push_back(photo.title);
  }
  return titles;
}
std::string portrait() {
  return standardXmp("<rdf:Description " + meaning("RangeInverse", "0.5", "4.0", "m") + "GDepth:Data=\"" +
                     base64(inversePng()) + "\"/>");
}

TEST(DepthJpeg, AFolderOfPortraitsIsAListOfPhotos) {
  const test::TemporaryFolder folder;
  const std::string here = std::filesystem::path(folder / "x").parent_path();
  write(folder / "IMG_2.jpg", "");
  write(folder / "IMG_10.jpg", "");
  EXPECT_TRUE(listed({.url = here}).empty()) << "a series of pictures";
  write(folder / "IMG_9.jpg", portrait());
  EXPECT_EQ(listed({.url = here}), (std::vector<std::string>{"IMG_2", "IMG_9", "IMG_10"}));
  EXPECT_EQ(listed({.url = folder / "IMG_*.jpg"}).size(), 3U) << "as a shell has listed them";
  EXPECT_TRUE(listed({.url = folder / "IMG_1*.jpg"}).empty()) << "none of these holds depth";
  EXPECT_TRUE(listed({.url = here, .packing = Packing::DepthAlone}).empty()) << "the user says how they are read";
  EXPECT_TRUE(listed({.url = here, .as = findKind("tum")}).empty());
  EXPECT_TRUE(listed({.url = here, .frames_per_s = 10}).empty());
  std::ofstream(folder / "IMG_9.mov") << "moving photo";
  std::ofstream(folder / "IMG_11.mov") << "film";
  EXPECT_EQ(listed({.url = here}), (std::vector<std::string>{"IMG_2", "IMG_9", "IMG_10", "IMG_11"}));
  for (const char* const film : {"IMG_9.mov", "IMG_11.mov"}) std::filesystem::remove(folder / film);
  for (const int k : {2, 9, 10}) std::ofstream(folder / ("IMG_" + std::to_string(k) + "_depth.png")) << inversePng();
  EXPECT_TRUE(listed({.url = here}).empty()) << "their depth lies beside them";
}

// Covers have their film's name.
TEST(DepthJpeg, APortraitAmongCoversHidesNoFilm) {
  const test::TemporaryFolder folder;
  for (const char* const name : {"MOV1", "MOV2", "MOV3"}) {
    std::ofstream(folder / (name + std::string(".mp4"))) << "film";
    write(folder / (name + std::string(".jpg")), "");
  }
  write(folder / "portrait.jpg", portrait());
  EXPECT_TRUE(listed({.url = std::filesystem::path(folder / "x").parent_path()}).empty()) << "a list of films";
  EXPECT_EQ(listed({.url = folder / "*"}).size(), 7U);
  std::ofstream(folder / "VID_1.mp4") << "film";
  EXPECT_EQ(listed({.url = std::filesystem::path(folder / "x").parent_path()}).size(), 8U) << "not all are covers";
}

// As FFmpeg describes the tiles of a large photo.
TEST(DepthJpeg, PicturesWithoutAWordAreNoDepthOfAPhoto) {
  class Tiles : public MediaSource {
    Result<Description> openSource(const std::string& url) override {
      Description description;
      if (url.ends_with(".heic")) description.streams.resize(2);
      return description;
    }
    Result<std::optional<Packet>> readPacket() override { return std::nullopt; }
    Result<void> seekTo(MediaTime) override { return {}; }
    void closeSource() noexcept override {}
    void interrupted() noexcept override {}
  };
  const test::TemporaryFolder folder;
  for (const char* const name : {"1.heic", "2.heic"}) std::ofstream(folder / name) << name;
  const std::string here = std::filesystem::path(folder / "x").parent_path();
  EXPECT_TRUE(listed({.url = here}, [](const std::string&) { return std::make_unique<Tiles>(); }).empty());
}

}  // namespace
}  // namespace relievo
