// SPDX-License-Identifier: Apache-2.0
// HEIC portraits, put together here box by box around pictures that FFmpeg has coded.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <vector>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/heif/heif.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"

namespace relievo {
namespace {

constexpr int kCols = 96, kRows = 64;
constexpr double kLeast = 0.4, kMost = 2.5;  // disparities, 1/m

// A picture as it is coded: `right` to the left of a phone that was held upright.
std::uint32_t disparityCode(int c, int r) {
  return static_cast<std::uint32_t>(40 + c + r / 2);
}

struct Coded {
  std::string parameters;  // hvcC
  std::string picture;
};
Coded hevc(const std::function<std::uint32_t(int, int, int, int)>& sample) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.mp4", {{.codec = "libx265",
                                     .pix_fmt = "yuv420p",
                                     .width = kCols,
                                     .height = kRows,
                                     .frames = 1,
                                     .range = ColorRange::Full,
                                     .sample = sample,
                                     .options = {{"crf", "4"}, {"x265-params", "log-level=error"}}}});
  const auto source = makeFfmpegSource();
  EXPECT_TRUE(source->open(folder / "a.mp4"));
  const StreamInfo& stream = source->streams().at(0);
  const Packet packet = source->read().value().value();
  return {{stream.extradata.begin(), stream.extradata.end()}, {packet.data, packet.data + packet.bytes}};
}

std::string number(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return text;
}
std::string box(const std::string& type, const std::string& content) {
  return number(static_cast<std::uint32_t>(content.size() + 8), 4) + type + content;
}
std::string fullBox(const std::string& type, const std::string& content, std::uint32_t version = 0) {
  return box(type, number(version << 24, 4) + content);
}

// ISO/IEC 23008-12: item 1 is the picture, item 2 its disparity, item 3 the disparity's XMP.
struct Portrait {
  int quarter_turns = 0;  // anticlockwise, as irot says
  std::string xmp;
  bool auxiliary = true;
  std::string groups;  // between the properties and the end of meta
};
std::string heic(const Coded& color, const Coded& depth, const Portrait& how) {
  const std::string size = number(kCols, 4) + number(kRows, 4);
  const std::string properties =
      box("ipco", box("hvcC", color.parameters) + box("hvcC", depth.parameters) + fullBox("ispe", size) +
                      box("irot", number(static_cast<std::uint32_t>(how.quarter_turns), 1)) +
                      fullBox("auxC", std::string("urn:mpeg:hevc:2015:auxid:2\0", 27)));
  // Essential properties have the high bit.
  const std::string of_color = number(1, 2) + "\x03" + "\x81\x03\x84";
  const std::string of_depth =
      number(2, 2) + (how.auxiliary ? "\x04" + std::string("\x82\x03\x84\x05") : "\x02" + std::string("\x82\x03"));
  const std::string associations = fullBox("ipma", number(2, 4) + of_color + of_depth);
  const auto entry = [](std::uint32_t item, const std::string& type, const std::string& more) {
    return fullBox("infe", number(item, 2) + number(0, 2) + type + std::string(1, '\0') + more, 2);
  };
  const bool with_xmp = !how.xmp.empty();
  std::string items = entry(1, "hvc1", "") + entry(2, "hvc1", "");
  if (with_xmp) items += entry(3, "mime", std::string("application/rdf+xml\0", 20));
  std::string references;
  if (how.auxiliary) references += box("auxl", number(2, 2) + number(1, 2) + number(1, 2));
  if (with_xmp) references += box("cdsc", number(3, 2) + number(1, 2) + number(2, 2));
  const auto meta = [&](std::uint32_t begin) {
    std::string places = number(0x4400, 2) + number(with_xmp ? 3 : 2, 2);
    std::uint32_t at = begin, item = 0;
    for (const std::string& data : {color.picture, depth.picture, how.xmp}) {
      if (data.empty()) break;
      places += number(++item, 2) + number(0, 2) + number(1, 2) + number(at, 4) +
                number(static_cast<std::uint32_t>(data.size()), 4);
      at += static_cast<std::uint32_t>(data.size());
    }
    return fullBox("meta", fullBox("hdlr", number(0, 4) + "pict" + std::string(13, '\0')) +
                               fullBox("pitm", number(1, 2)) + fullBox("iloc", places) +
                               fullBox("iinf", number(with_xmp ? 3 : 2, 2) + items) +
                               (references.empty() ? "" : fullBox("iref", references)) +
                               box("iprp", properties + associations) + how.groups);
  };
  const std::string type = box("ftyp", "heic" + number(0, 4) + "mif1heic");
  const auto begin = static_cast<std::uint32_t>(type.size() + meta(0).size() + 8);
  return type + meta(begin) + box("mdat", color.picture + depth.picture + how.xmp);
}

const std::string kXmp =
    "<x:xmpmeta><rdf:RDF><rdf:Description xmlns:apdi=\"http://ns.apple.com/pixeldatainfo/1.0/\">"
    "<apdi:FloatMinValue>0.4</apdi:FloatMinValue><apdi:FloatMaxValue>2.5</apdi:FloatMaxValue>"
    "</rdf:Description></rdf:RDF></x:xmpmeta>";

class HeifPhoto : public testing::Test {
 protected:
  static std::string make(const Portrait& how) {
    static const Coded color =
        hevc([](int k, int c, int, int) { return static_cast<std::uint32_t>(k == 0 ? 2 * c : 128); });
    static const Coded depth = hevc([](int k, int c, int r, int) { return k == 0 ? disparityCode(c, r) : 128u; });
    return heic(color, depth, how);
  }
  test::OpenedFilm photo(const Portrait& how) {
    const std::string path = folder_ / "a.heic";
    std::ofstream(path, std::ios::binary) << make(how);
    return test::openFilm({.url = path});
  }
  test::TemporaryFolder folder_;
};

double millimetresAt(int c, int r) {
  return 1000 / (kLeast + (kMost - kLeast) * disparityCode(c, r) / 255);
}

TEST_F(HeifPhoto, DisparityIsDepthBesideTheColour) {
  const test::OpenedFilm film = photo({.xmp = kXmp});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.frame_period, Duration(0)) << "a photo";
  EXPECT_NEAR(film.info.calibration.calibration.near_mm, 400, 0.01);
  EXPECT_NEAR(film.info.calibration.calibration.far_mm, 2500, 0.01);
  EXPECT_EQ(film.info.color_width, kCols);
  EXPECT_NEAR(test::sampleAt(film.pair.color, 1, 60, 30), 120, 8);
  for (int c = 3; c < kCols; c += 9) {
    ASSERT_NEAR(film.distanceAt(c, 30), millimetresAt(c, 30), 0.012 * millimetresAt(c, 30)) << c;
  }
}

TEST_F(HeifPhoto, BothPicturesComeUpright) {
  const test::OpenedFilm film = photo({.quarter_turns = 3, .xmp = kXmp});  // 270 degrees anticlockwise: 90 clockwise
  ASSERT_TRUE(film.info.has_depth);
  ASSERT_EQ(film.info.color_width, kRows);
  ASSERT_EQ(film.info.depth_width, kRows);
  ASSERT_EQ(film.info.depth_height, kCols);
  // Column c and row r of the file are at column rows - 1 - r and row c.
  EXPECT_NEAR(film.distanceAt(kRows - 1 - 10, 70), millimetresAt(70, 10), 0.012 * millimetresAt(70, 10));
  EXPECT_NEAR(test::sampleAt(film.pair.color, 1, 20, 60), 120, 8);
}

TEST_F(HeifPhoto, WithoutARangeItIsStillDisparity) {
  const test::OpenedFilm film = photo({});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.calibration.calibration.law, DepthLaw::Inverse);
  EXPECT_EQ(film.info.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  EXPECT_GT(film.heightAt(90, 30), film.heightAt(10, 30));
}

std::string group(const std::string& type, const std::vector<std::uint32_t>& items) {
  std::string content = number(900, 4) + number(static_cast<std::uint32_t>(items.size()), 4);
  for (const std::uint32_t item : items) content += number(item, 4);
  return fullBox(type, content);
}

TEST_F(HeifPhoto, TheTwoPicturesOfAStereoPairAreViews) {
  // Item 2 is darker in the middle; the group says which one is the left.
  for (const bool second_left : {false, true}) {
    const std::string pair = group("ster", second_left ? std::vector{2u, 1u} : std::vector{1u, 2u});
    const test::OpenedFilm film = photo({.auxiliary = false, .groups = box("grpl", group("altr", {7, 8}) + pair)});
    EXPECT_EQ(film.info.packing, Packing::StereoTracks);
    EXPECT_FALSE(film.info.has_depth);
    ASSERT_FALSE(film.pair.right.empty());
    const Frame &first = second_left ? film.pair.right : film.pair.color,
                &second = second_left ? film.pair.color : film.pair.right;
    EXPECT_NEAR(test::sampleAt(first, 1, 90, 30), 180, 8);
    EXPECT_NEAR(test::sampleAt(second, 1, 90, 30), disparityCode(90, 30), 8);
  }
}

TEST_F(HeifPhoto, DamagedGroupsAreNoViews) {
  const auto views = [&](const std::string& groups) {
    const std::string file = make({.auxiliary = false, .groups = groups});
    return kHeif.parts(std::make_shared<const std::vector<std::uint8_t>>(file.begin(), file.end())).size();
  };
  EXPECT_EQ(views(box("grpl", group("ster", {1, 2}))), 2u);
  for (const std::string& groups :
       {std::string(), box("grpl", group("ster", {1, 2, 3})), box("grpl", ""), box("grpl", box("ster", "")),
        box("grpl", group("altr", {1, 2})), box("grpl", "\xff\xff\xff\xffster" + std::string(24, '\1'))}) {
    EXPECT_EQ(views(groups), 0u);
  }
}

}  // namespace
}  // namespace relievo
