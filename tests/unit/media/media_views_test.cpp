// SPDX-License-Identifier: Apache-2.0
// Two views of one scene, as cameras and coders mark them: frame packing of H.264 and HEVC, two tracks, MPO and JPS
// photos, whose index and header are written here byte by byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::contentOf;
using test::kSceneCols;
using test::kSceneRows;
using test::write;
using testing::Contains;
using testing::HasSubstr;

// Left views are dark, right ones bright.
constexpr std::uint32_t kDark = 60, kBright = 180;
ClipTrack plain(std::uint32_t luma, const std::string& codec = "mjpeg") {
  ClipTrack track{.codec = codec, .pix_fmt = "yuv420p", .width = 96, .height = 64, .frames = 1};
  if (codec == "mjpeg") track.pix_fmt = "yuvj420p", track.range = ColorRange::Full;
  track.sample = [luma](int k, int, int, int) { return k == 0 ? luma : 128u; };
  return track;
}
// The first half, left or upper, dark.
ClipTrack halves(bool beside, const std::string& codec) {
  ClipTrack track = plain(0, codec);
  track.width = 192;
  track.frames = 2;
  track.sample = [beside](int k, int c, int r, int) {
    return k > 0 ? 128u : (beside ? c < 96 : r < 32) ? kDark : kBright;
  };
  return track;
}

std::string number(std::size_t value, int bytes, bool high_first = true) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return high_first ? text : std::string(text.rbegin(), text.rend());
}
std::string jpegOf(const ClipTrack& track) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.jpg", {track});
  return contentOf(folder / "a.jpg");
}

void expectViews(const test::OpenedFilm& film, Packing packing, const char* by) {
  EXPECT_EQ(film.info.packing, packing);
  EXPECT_FALSE(film.info.has_depth);
  EXPECT_TRUE(film.pair.depth.empty());
  EXPECT_THAT(film.info.reading.doubts, Contains(HasSubstr(by)));
  EXPECT_THAT(film.info.reading.doubts, Contains(HasSubstr("shown in stereo, without touch")));
  ASSERT_FALSE(film.pair.right.empty());
  EXPECT_NEAR(test::sampleAt(film.pair.color, 0, 20, 20), kDark, 4);
  EXPECT_NEAR(test::sampleAt(film.pair.right, 0, 20, 20), kBright, 4);
}

TEST(Views, FramePackingOfH264IsTold) {
  const test::TemporaryFolder folder;
  for (const bool beside : {true, false}) {
    ClipTrack film = halves(beside, "libx264");
    film.options = {{"x264-params", beside ? "frame-packing=3" : "frame-packing=4"}};
    test::makeClip(folder / "a.mp4", {film});
    const auto packing = beside ? Packing::StereoSideBySide : Packing::StereoTopBottom;
    expectViews(test::openFilm({.url = folder / "a.mp4"}), packing, "coded pictures say");
  }
}

// ITU-T H.265, D.2.16: arrangement 3 (side by side), the first view is the right one.
TEST(Views, FramePackingOfHevcIsTold) {
  const test::TemporaryFolder folder;
  ClipTrack film = halves(true, "libx265");
  const auto dark_left = film.sample;
  film.sample = [=](int k, int c, int r, int frame) { return dark_left(k, k == 0 ? 191 - c : c, r, frame); };
  film.options = {{"x265-params", "log-level=error"}};
  test::makeClip(folder / "a.hevc", {film});
  std::string stream = contentOf(folder / "a.hevc");
  const std::string message("\0\0\1\x4e\x01\x2d\x06\x81\x82\0\0\3\0\x02\x80", 15);
  std::size_t picture = std::string::npos;
  for (std::size_t at = 0; (at = stream.find(std::string("\0\0\1", 3), at)) != std::string::npos; ++at) {
    const int type = static_cast<unsigned char>(stream[at + 3]) >> 1 & 0x3f;
    if (type >= 32) continue;
    picture = at;
    break;
  }
  ASSERT_NE(picture, std::string::npos);
  write(folder / "b.hevc", stream.insert(picture, message));
  expectViews(test::openFilm({.url = folder / "b.hevc"}), Packing::StereoSideBySide, "coded pictures say");
}

TEST(Views, OfTwoTracksAreShownToEachEye) {
  ClipTrack left{.pix_fmt = "yuv444p", .width = kSceneCols, .height = kSceneRows, .frames = 6};
  left.sample = [](int k, int c, int r, int) { return test::yuvCode(k, test::photoOf(c, r)); };
  ClipTrack right = left;
  right.sample = [](int k, int c, int r, int) { return test::yuvCode(k, test::photoOf(c + 5, r)); };
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.mkv", {left, right});
  for (const Packing packing : {Packing::Auto, Packing::StereoTracks}) {
    PairReader reader({.make_source = drivers::makeMediaSource, .make_decoder = drivers::makeSoftwareDecoder});
    ASSERT_TRUE(reader.open({.url = folder / "a.mkv", .packing = packing}));
    EXPECT_EQ(reader.info().packing, Packing::StereoTracks);
    EXPECT_FALSE(reader.info().has_depth);
    for (int frame = 0; frame < 6; ++frame) {
      const auto pair = reader.next().value().value();
      ASSERT_FALSE(pair.right.empty()) << frame;
      EXPECT_EQ(pair.right.pts, pair.color.pts);
      EXPECT_EQ(test::sampleAt(pair.color, 0, 45, 30), test::sampleAt(pair.right, 0, 40, 30));
    }
    ASSERT_TRUE(reader.seek(mediaTime(0.09)));
    const auto pair = reader.next().value().value();
    EXPECT_EQ(pair.right.pts, pair.color.pts);
  }
}

// An index of pictures (CIPA DC-007, 5.2) before the first one; the others follow it.
struct Listed {
  std::string jpeg;
  std::size_t type = 0x020002;
};
std::string mpo(const std::vector<Listed>& pictures, bool high_first = true) {
  const auto n = [high_first](std::size_t value, int bytes) { return number(value, bytes, high_first); };
  const std::string& first = pictures[0].jpeg;
  const std::size_t index_bytes = 8 + 2 + 3 * 12 + 4 + 16 * pictures.size();
  const std::size_t segment_bytes = 2 + 2 + 4 + index_bytes;
  std::size_t next = first.size() + segment_bytes - (2 + 2 + 2 + 4);  // from the index
  std::string entries, behind;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const std::size_t bytes = pictures[i].jpeg.size() + (i == 0 ? segment_bytes : 0);
    entries += n(pictures[i].type, 4) + n(bytes, 4) + n(i == 0 ? 0 : next, 4) + n(0, 4);
    if (i > 0) behind += pictures[i].jpeg;
    if (i > 0) next += bytes;
  }
  const std::string index = (high_first ? std::string("MM\0\x2a", 4) : std::string("II\x2a\0", 4)) + n(8, 4) + n(3, 2) +
                            n(0xb000, 2) + n(7, 2) + n(4, 4) + "0100" +                 //
                            n(0xb001, 2) + n(4, 2) + n(1, 4) + n(pictures.size(), 4) +  //
                            n(0xb002, 2) + n(7, 2) + n(entries.size(), 4) + n(50, 4) + n(0, 4) + entries;
  const std::string segment = "\xff\xe2" + number(segment_bytes - 2, 2) + std::string("MPF\0", 4) + index;
  return first.substr(0, 2) + segment + first.substr(2) + behind;
}

TEST(Views, AnMpoHoldsTwoPictures) {
  const test::TemporaryFolder folder;
  const std::string left = jpegOf(plain(kDark)), right = jpegOf(plain(kBright));
  for (const bool high_first : {true, false}) {
    write(folder / "a.mpo", mpo({{left}, {right}}, high_first));
    const test::OpenedFilm photo = test::openFilm({.url = folder / "a.mpo"});
    expectViews(photo, Packing::StereoTracks, "tags say");
    EXPECT_EQ(photo.info.frame_period, Duration(0)) << "a photo";
    EXPECT_EQ(photo.pair.right.width, 96);
  }
  // A preview between the two.
  write(folder / "b.mpo", mpo({{left}, {jpegOf(plain(120)), 0x010001}, {right}}));
  expectViews(test::openFilm({.url = folder / "b.mpo"}), Packing::StereoTracks, "tags say");
}

// Phones list gain maps and previews of one picture like that.
TEST(Views, OtherPicturesInOneFileAreNoViews) {
  const test::TemporaryFolder folder;
  const std::string left = jpegOf(plain(kDark)), right = jpegOf(plain(kBright));
  write(folder / "gain.jpg", mpo({{left, 0x030000}, {right, 0}}));
  write(folder / "pan.jpg", mpo({{left, 0x020001}, {right, 0x020001}}));
  const std::string whole = mpo({{left}, {right}});
  write(folder / "cut.mpo", whole.substr(0, whole.size() - right.size() / 2));
  std::string damaged = whole;
  damaged.replace(damaged.find("MPF") + 4 + 4, 4, "\xff\xff\xff\xf0");
  write(folder / "damaged.mpo", damaged);
  for (const char* name : {"gain.jpg", "pan.jpg", "cut.mpo", "damaged.mpo"}) {
    const test::OpenedFilm photo = test::openFilm({.url = folder / name});
    EXPECT_EQ(photo.info.packing, Packing::Tracks) << name;
    EXPECT_TRUE(photo.pair.right.empty()) << name;
    EXPECT_NEAR(test::sampleAt(photo.pair.color, 0, 20, 20), kDark, 4) << name;
  }
}

// VRex, "JPEG stereoscopic file format": identifier, length of the descriptor, descriptor.
std::string jps(const std::string& jpeg, std::size_t layout, std::size_t flags) {
  const std::string content =
      "_JPSJPS_" + number(4, 2) + number(flags << 16 | layout << 8 | 1, 4) + number(16, 2) + std::string(16, 'c');
  return jpeg.substr(0, 2) + "\xff\xe3" + number(content.size() + 2, 2) + content + jpeg.substr(2);
}

TEST(Views, AJpsHoldsThemInOnePicture) {
  constexpr std::size_t kBeside = 2, kAbove = 3, kHalfHeight = 1, kHalfWidth = 2, kLeftFirst = 4;
  const test::TemporaryFolder folder;
  ClipTrack beside = halves(true, "mjpeg"), above = halves(false, "mjpeg");
  beside.frames = above.frames = 1;
  write(folder / "a.jps", jps(jpegOf(beside), kBeside, kLeftFirst));
  const test::OpenedFilm photo = test::openFilm({.url = folder / "a.jps"});
  expectViews(photo, Packing::StereoSideBySide, "tags say");
  EXPECT_EQ(photo.pair.color.width, 96);
  EXPECT_EQ(photo.pair.color.sample_aspect, 1);
  write(folder / "b.jpg", jps(jpegOf(above), kAbove, kLeftFirst | kHalfHeight));
  const test::OpenedFilm squeezed = test::openFilm({.url = folder / "b.jpg"});
  expectViews(squeezed, Packing::StereoTopBottom, "tags say");
  EXPECT_EQ(squeezed.pair.color.sample_aspect, 0.5);
  // Cross-eyed: the right view is on the left. Each was squeezed.
  write(folder / "c.jps", jps(jpegOf(beside), kBeside, kHalfWidth));
  const test::OpenedFilm crossed = test::openFilm({.url = folder / "c.jps"});
  EXPECT_NEAR(test::sampleAt(crossed.pair.color, 0, 20, 20), kBright, 4);
  EXPECT_NEAR(test::sampleAt(crossed.pair.right, 0, 20, 20), kDark, 4);
  EXPECT_EQ(crossed.pair.color.sample_aspect, 2);
  // Without a header, the file's ending .jps is enough.
  write(folder / "d.jps", jpegOf(beside));
  const test::OpenedFilm bare = test::openFilm({.url = folder / "d.jps"});
  EXPECT_EQ(bare.info.packing, Packing::StereoSideBySide);
  EXPECT_NEAR(test::sampleAt(bare.pair.color, 0, 20, 20), kBright, 4);
}

// Interleaved rows and anaglyphs are recognised and reported; relievo cannot show them.
TEST(Views, AJpsOfAnotherLayoutIsTold) {
  const test::TemporaryFolder folder;
  ClipTrack beside = halves(true, "mjpeg");
  beside.frames = 1;
  write(folder / "a.jpg", jps(jpegOf(beside), 1, 4));
  const test::OpenedFilm photo = test::openFilm({.url = folder / "a.jpg"});
  EXPECT_TRUE(photo.pair.right.empty());
  EXPECT_THAT(photo.info.reading.doubts, Contains(HasSubstr("not supported")));
}

// Looking Glass names the views across and down.
TEST(Views, AQuiltIsToldByItsName) {
  const test::TemporaryFolder folder;
  ClipTrack film = halves(true, "png");
  film.pix_fmt = "rgb24", film.frames = 1;
  test::makeClip(folder / "sea_qs8x6a0.75.png", {film});
  const test::OpenedFilm quilt = test::openFilm({.url = folder / "sea_qs8x6a0.75.png"});
  EXPECT_FALSE(quilt.info.has_depth);
  EXPECT_THAT(quilt.info.reading.doubts, Contains(HasSubstr("a quilt of 8 x 6 views")));
  test::makeClip(folder / "film_qs3x2.png", {film});
  EXPECT_THAT(test::openFilm({.url = folder / "film_qs3x2.png"}).info.reading.doubts,
              testing::Each(testing::Not(HasSubstr("quilt"))));
}

TEST(Views, ASmoothHalfOfAGrayPictureMayBeDepth) {
  const test::TemporaryFolder folder;
  for (const bool beside : {true, false}) {
    ClipTrack film{.codec = "png", .pix_fmt = "gray", .width = 2 * kSceneCols, .height = 2 * kSceneRows, .frames = 1};
    (beside ? film.height : film.width) /= 2;
    film.sample = [](int, int c, int r, int) {
      if (c < kSceneCols && r < kSceneRows) return static_cast<std::uint32_t>(255 * test::photoOf(c, r)[0]);
      return static_cast<std::uint32_t>(c % kSceneCols + r % kSceneRows) * 255 / (kSceneCols + kSceneRows);
    };
    test::makeClip(folder / "a.png", {film});
    const test::OpenedFilm gray = test::openFilm({.url = folder / "a.png"});
    EXPECT_THAT(gray.info.notes, Contains(testing::EndsWith(beside ? "--packing sbs" : "--packing tb")));
    EXPECT_THAT(gray.info.notes, Contains(HasSubstr("--packing depth-alone")));
  }
}

TEST(Views, AnOrdinaryGrayPictureHasNoSmoothHalf) {
  const test::TemporaryFolder folder;
  for (const int kind : {0, 1, 2}) {
    ClipTrack film{.codec = "png", .pix_fmt = "gray", .width = kSceneCols, .height = 2 * kSceneRows, .frames = 1};
    film.sample = [kind](int, int c, int r, int) -> std::uint32_t {
      const auto photo = static_cast<std::uint32_t>(255 * test::photoOf(c, r % kSceneRows)[0]);
      if (r >= kSceneRows) return kind == 2 ? 60 + photo / 64 + static_cast<std::uint32_t>(r) / 4 : photo;
      return kind == 0 ? 0 : kind == 1 ? 180 + static_cast<std::uint32_t>(r) / 20 : 60 + static_cast<std::uint32_t>(r);
    };
    test::makeClip(folder / "a.png", {film});
    const test::OpenedFilm gray = test::openFilm({.url = folder / "a.png"});
    EXPECT_THAT(gray.info.notes, testing::Each(testing::Not(HasSubstr("one half")))) << kind;
  }
}

// AVI says of raw pictures only how many bits they have.
TEST(Views, RawPicturesOfSixteenBitsInAviMayBeDepth) {
  const test::TemporaryFolder folder;
  ClipTrack film{.codec = "rawvideo", .pix_fmt = "rgb555le", .width = 32, .height = 24, .frames = 2};
  film.sample = [](int k, int c, int r, int) { return static_cast<std::uint32_t>((k + 1) * c + r) % 32; };
  test::makeClip(folder / "a.avi", {film});
  EXPECT_THAT(test::openFilm({.url = folder / "a.avi"}).info.reading.doubts, Contains(HasSubstr("gray16le")));
}

}  // namespace
}  // namespace relievo
