// SPDX-License-Identifier: Apache-2.0
// JPEG photos of phones that put the depth behind the picture, put together here byte by byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"

namespace relievo {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int kCols = 48, kRows = 32;
constexpr double kLeast = 0.25, kMost = 2;  // disparities, 1/m

double metresAt(int r) {
  return 0.6 + 0.1 * r;
}

std::string jpeg(const char* format, std::function<std::uint32_t(int, int, int, int)> sample) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "p.jpg", {{.codec = "mjpeg",
                                     .pix_fmt = format,
                                     .width = kCols,
                                     .height = kRows,
                                     .frames = 1,
                                     .range = ColorRange::Full,
                                     .sample = std::move(sample)}});
  return test::contentOf(folder / "p.jpg");
}
std::string colorJpeg() {
  return jpeg("yuvj420p", [](int k, int c, int, int) { return k == 0 ? 100u + 2 * c : 128u + 15 * k; });
}
std::string mapJpeg(bool distances = false) {
  return jpeg("yuvj444p", [distances](int k, int, int r, int) {
    const double value = distances ? metresAt(r) : 1 / metresAt(r);
    const double low = distances ? 0.5 : kLeast, high = distances ? 4 : kMost;
    return k == 0 ? static_cast<std::uint32_t>(std::lround(255 * (value - low) / (high - low))) : 128u;
  });
}

std::string number(std::size_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return text;
}
std::string withSegment(const std::string& jpeg, char marker, const std::string& content) {
  return jpeg.substr(0, 2) + "\xff" + marker + number(content.size() + 2, 2) + content + jpeg.substr(2);
}
std::string withXmp(const std::string& jpeg, const std::string& properties) {
  return withSegment(jpeg, '\xe1',
                     std::string("http://ns.adobe.com/xap/1.0/\0", 29) + "<x:xmpmeta><rdf:RDF><rdf:Description>" +
                         properties + "</rdf:Description></rdf:RDF></x:xmpmeta>");
}
std::string element(const std::string& name, const std::string& value) {
  return "<apdi:" + name + ">" + value + "</apdi:" + name + ">";
}
std::string range(double low, double high) {
  return element("FloatMinValue", std::to_string(low)) + element("FloatMaxValue", std::to_string(high));
}

// A file of pictures with their index (CIPA DC-007-2009): all but the first of no type.
std::string photoOf(const std::vector<std::string>& behind) {
  const std::string color = colorJpeg();
  const std::size_t count = behind.size() + 1, bytes = 4 + 8 + 2 + 12 + 4 + 16 * count;
  const std::size_t first_bytes = color.size() + 4 + bytes;
  constexpr std::size_t kIndex = 2 + 4 + 4;  // where offsets count from
  std::string entries = number(0x030000, 4) + number(first_bytes, 4) + number(0, 4) + number(0, 4), rest;
  for (const std::string& picture : behind) {
    entries += number(0, 4) + number(picture.size(), 4) + number(first_bytes + rest.size() - kIndex, 4) + number(0, 4);
    rest += picture;
  }
  const std::string index = std::string("MPF\0MM\0\x2a", 8) + number(8, 4) + number(1, 2) + number(0xb002, 2) +
                            number(7, 2) + number(16 * count, 4) + number(26, 4) + number(0, 4) + entries;
  return withSegment(color, '\xe2', index) + rest;
}

class PhoneJpeg : public testing::Test {
 protected:
  [[nodiscard]] test::OpenedFilm open(const std::string& bytes) const {
    std::ofstream(folder_ / "a.jpg", std::ios::binary) << bytes;
    return test::openFilm({.url = folder_ / "a.jpg"});
  }
  static void expectDepth(const test::OpenedFilm& photo) {
    ASSERT_TRUE(photo.info.has_depth);
    EXPECT_EQ(photo.info.packing, Packing::Tracks);
    EXPECT_NEAR(test::sampleAt(photo.pair.color, 0, 40, 16), 180, 6);
    for (int r = 0; r < kRows; r += 5) ASSERT_NEAR(photo.distanceAt(17, r), 1000 * metresAt(r), 60 * metresAt(r)) << r;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(PhoneJpeg, AnIPhonesDisparityIsFoundBesideItsMatte) {
  const std::string matte = withXmp(
      mapJpeg(), element("AuxiliaryImageSubType", "portraiteffectsmatte") + element("AuxiliaryImageType", "depth"));
  const std::string map = withXmp(mapJpeg(), range(kLeast, kMost) + element("AuxiliaryImageType", "disparity"));
  const test::OpenedFilm photo = open(photoOf({matte, map}));
  expectDepth(photo);
  EXPECT_NEAR(photo.info.calibration.calibration.near_mm, 1000 / kMost, 1);
  EXPECT_NEAR(photo.info.calibration.calibration.far_mm, 1000 / kLeast, 1);
  expectDepth(open(photoOf({withXmp(mapJpeg(true), range(0.5, 4) + element("AuxiliaryImageType", "depth"))})));
}

TEST_F(PhoneJpeg, OtherPicturesBehindAPhotoAreNoDepth) {
  const std::string gain_map =
      withXmp(mapJpeg(), range(0, 1) + element("AuxiliaryImageType", "urn:com:apple:photo:2020:aux:hdrgainmap"));
  EXPECT_FALSE(open(photoOf({gain_map, mapJpeg()})).info.has_depth);
  std::string cut = photoOf({withXmp(mapJpeg(), range(kLeast, kMost) + element("AuxiliaryImageType", "disparity"))});
  cut.resize(cut.size() - 100);
  EXPECT_FALSE(open(cut).info.has_depth);
}

TEST_F(PhoneJpeg, DepthOfOtherPhonesIsNamed) {
  const std::string data = std::string("\0\0\xb1\x0a", 4) + std::string("\x13\0\0\0", 4) + "DualShot_DepthMap_1map";
  const std::string directory =
      "SEFH" + std::string("\x6b\0\0\0\1\0\0\0\0\0\xb1\x0a", 12) + std::string("\x1e\0\0\0\x1e\0\0\0", 8);
  const std::string samsung = data + directory + std::string("\x18\0\0\0", 4) + "SEFT";
  EXPECT_THAT(open(colorJpeg() + samsung).info.notes, Contains(HasSubstr("exiftool -b -DepthMapTiff")));
  EXPECT_THAT(open(colorJpeg() + std::string("\0edof\0map", 9)).info.notes, Contains(HasSubstr("Huawei")));
  EXPECT_THAT(open(colorJpeg() + "\x1eLIF").info.notes, Contains(HasSubstr("Leia")));
  EXPECT_THAT(open(colorJpeg()).info.notes, testing::Each(testing::Not(HasSubstr("phone"))));
}

}  // namespace
}  // namespace relievo
