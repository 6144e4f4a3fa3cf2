// SPDX-License-Identifier: Apache-2.0
// ScanNet++'s depth.bin in its three codings, which the test writes by the toolkit's reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "app/media/pair_reader.h"
#include "drivers/registry.h"
#include "tests/support/byte_writer.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/failing_disk.h"
#include "tests/support/film/real_backends.h"

namespace relievo {
namespace {

using test::number;
using test::sampleAt;
using testing::Contains;
using testing::HasSubstr;

constexpr int kCols = 256, kRows = 192, kFrames = 5;

int codeAt(int c, int r, int frame) {
  return c < 3 ? 0 : 1000 + 5 * c + 3 * r + frame;
}
std::string samples(int frame, bool metres) {
  std::string bytes;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      const int mm = codeAt(c, r, frame);
      bytes += metres ? number(static_cast<float>(mm) / 1000) : number(static_cast<std::uint16_t>(mm));
    }
  }
  return bytes;
}

// DEFLATE's stored blocks (RFC 1951, 3.2.4).
std::string stored(const std::string& bytes) {
  constexpr std::size_t kMost = 65535;
  std::string packed;
  for (std::size_t at = 0; at < bytes.size(); at += kMost) {
    const auto length = static_cast<std::uint16_t>(std::min(kMost, bytes.size() - at));
    packed += std::string(1, at + kMost >= bytes.size() ? '\1' : '\0') + number(length) +
              number(static_cast<std::uint16_t>(~length)) + bytes.substr(at, length);
  }
  return packed;
}

// A block of LZ4 with a repetition in it.
std::string lz4(const std::string& bytes) {
  const auto lengthOf = [](std::size_t length) {
    std::string more;
    for (length -= 15; length >= 255; length -= 255) more += '\xff';
    return more + static_cast<char>(length);
  };
  // The first three samples are holes: one literal zero, then five zeros repeated at distance 1.
  const std::string head = std::string("\x11", 1) + std::string(1, '\0') + number(std::uint16_t{1});
  const std::string rest = bytes.substr(6);
  return head + "\xf0" + lengthOf(rest.size()) + rest;
}

class DepthBins : public testing::Test {
 protected:
  std::string save(const std::string& bytes) {
    const std::string path = folder_ / "depth.bin";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  // The pictures from `from` on, each by its time in ms; every sample is checked.
  std::vector<long> timesOf(const std::string& path, std::optional<MediaTime> from = std::nullopt) {
    PairReader reader(kReal);
    const auto opened = reader.open({.url = path});
    EXPECT_TRUE(opened) << opened.error().message;
    notes_ = reader.info().notes;
    EXPECT_TRUE(!opened || !from || reader.seek(*from));
    std::vector<long> times;
    for (auto pair = reader.next(); opened && pair && *pair; pair = reader.next()) {
      const Frame& depth = (*pair)->depth;
      times.push_back(std::lround(1e3 * toSeconds((*pair)->color.pts)));
      const int frame = static_cast<int>(std::lround(60 * toSeconds((*pair)->color.pts)));
      for (int r = 0; r < kRows; ++r) {
        for (int c = 0; c < kCols; ++c) {
          const auto code = static_cast<int>(sampleAt(depth, 0, c, r));
          EXPECT_EQ(code, codeAt(c, r, frame)) << c << ", " << r << " of " << frame;
          if (code != codeAt(c, r, frame)) return times;
        }
      }
    }
    EXPECT_EQ(reader.info().calibration.calibration.unit_mm, 1);
    return times;
  }
  test::TemporaryFolder folder_;
  std::vector<std::string> notes_;
};

TEST_F(DepthBins, AreReadInEachCodingAndFromEachPicture) {
  std::string packed_by_lz4, deflated, all;
  for (int i = 0; i < kFrames; ++i) {
    const std::string by_lz4 = lz4(samples(i, false)), by_deflate = stored(samples(i, true));
    packed_by_lz4 += number(static_cast<std::uint32_t>(by_lz4.size())) + by_lz4;
    deflated += number(static_cast<std::uint32_t>(by_deflate.size())) + by_deflate;
    all += samples(i, true);
  }
  for (const std::string& bytes : {packed_by_lz4, deflated, stored(all)}) {
    const std::string path = save(bytes);
    EXPECT_EQ(timesOf(path), (std::vector<long>{0, 17, 33, 50, 67}));
    EXPECT_EQ(timesOf(path, MediaTime(std::chrono::milliseconds(50))), (std::vector<long>{50, 67}));
    EXPECT_EQ(timesOf(path, MediaTime{}), (std::vector<long>{0, 17, 33, 50, 67})) << "back";
  }
}

TEST_F(DepthBins, AreLostWhenTheDiskFails) {
  std::string all, packed;
  for (int i = 0; i < kFrames; ++i) {
    const std::string by_lz4 = lz4(samples(i, false));
    packed += number(static_cast<std::uint32_t>(by_lz4.size())) + by_lz4;
    all += samples(i, true);
  }
  for (const std::string& bytes : {packed, stored(all)}) {
    const std::string path = save(bytes);
    const auto source = drivers::makeMediaSource(path);
    ASSERT_TRUE(source->open(path));
    EXPECT_EQ(test::endOnFailingDisk(*source), ErrorCode::Lost);
  }
}

TEST_F(DepthBins, TheFilmBesideIsTheirColour) {
  const std::string by_lz4 = lz4(samples(0, false));
  save(number(static_cast<std::uint32_t>(by_lz4.size())) + by_lz4);
  test::makeClip(folder_ / "rgb.mkv", {{.pix_fmt = "yuv420p", .width = 64, .height = 48, .frames = 2}});
  for (const std::string& url : {std::string(folder_ / "."), std::string(folder_ / "rgb.mkv")}) {
    PairReader reader(kReal);
    ASSERT_TRUE(reader.open({.url = url}));
    EXPECT_EQ(reader.info().color_width, 64);
    EXPECT_EQ(reader.info().depth_width, kCols);
  }
}

TEST_F(DepthBins, CutOffOnesEndWithTheirLastPictureAndOthersAreNone) {
  const std::string by_lz4 = lz4(samples(0, false)), whole = number(static_cast<std::uint32_t>(by_lz4.size())) + by_lz4;
  EXPECT_EQ(timesOf(save(whole + whole.substr(0, 5000))), (std::vector<long>{0}));
  EXPECT_THAT(notes_, Contains(HasSubstr("cut off")));
  for (const std::string& bytes : {std::string(), std::string("abcd"), std::string(300000, '\0'),
                                   std::string(300000, '\xff'), stored(std::string(100, 'x'))}) {
    const std::string path = save(bytes);
    const auto opened = drivers::makeMediaSource(path)->open(path);
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().message, HasSubstr("no depth.bin"));
  }
}

// Without zlib's head and checksum. Level 1 looks back over the whole window, as a mark that is returned to must.
std::string deflatedByZlib(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 1, Z_DEFLATED, -MAX_WBITS, MAX_MEM_LEVEL, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

// A stream of more pictures than lie between two marks, read to its end and then from places before, at and behind one.
TEST_F(DepthBins, OneStreamGoesOnFromEachPlaceInIt) {
  constexpr int kMany = 150;
  std::string all;
  for (int i = 0; i < kMany; ++i) all += samples(i, true);
  const std::string path = save(deflatedByZlib(all));
  const auto source = drivers::makeMediaSource(path);
  ASSERT_TRUE(source->open(path));
  const auto pictureOf = [&](int frame) -> std::string {
    const auto packet = source->read();
    if (!packet || !*packet) return "end";
    EXPECT_EQ(std::lround(60 * toSeconds(*(*packet)->pts)), frame);
    return {reinterpret_cast<const char*>((*packet)->data), (*packet)->bytes};
  };
  for (int i = 0; i < kMany; ++i) ASSERT_TRUE(pictureOf(i) == samples(i, false)) << i;
  EXPECT_EQ(pictureOf(kMany), "end");
  for (const int frame : {10, 64, 65, 130, 3, 127, 149, 128, 0}) {
    ASSERT_TRUE(source->seek(mediaTime((frame + .5) / 60)));
    EXPECT_TRUE(pictureOf(frame) == samples(frame, false)) << frame;
  }
}

}  // namespace
}  // namespace relievo
