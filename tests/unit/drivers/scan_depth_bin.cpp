// SPDX-License-Identifier: Apache-2.0
// ScanNet++'s depth.bin in its three codings, which the test writes by the toolkit's reader, and DEFLATE as zlib packs
// it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/media/pair_reader.h"
#include "drivers/registry.h"
#include "drivers/scan/inflate.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using test::sampleAt;
using testing::Contains;
using testing::HasSubstr;

constexpr int kCols = 256, kRows = 192, kFrames = 5;
const PairReader::Backends kReal{.make_source = drivers::makeMediaSource, .make_decoder = drivers::makeSoftwareDecoder};

template <class T>
std::string number(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

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

// A PNG's rows, each with a byte for its filter (0, none), are packed by zlib.
TEST(Inflater, UnpacksWhatZlibPacks) {
  test::TemporaryFolder folder;
  test::ClipTrack track{.codec = "png", .pix_fmt = "gray16be", .width = 640, .height = 480, .frames = 1};
  const auto code = [](int c, int r) { return static_cast<std::uint32_t>(3 * c * c / 7 + r * r + (c * r) % 11); };
  track.sample = [&](int, int c, int r, int) { return code(c, r); };
  test::makeClip(folder / "a.png", {track});
  std::ifstream file(folder / "a.png", std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(file), {}};
  std::string packed;
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const auto byte = [&](std::size_t i) { return std::size_t{static_cast<std::uint8_t>(png[at + i])}; };
    const std::size_t length = byte(0) << 24 | byte(1) << 16 | byte(2) << 8 | byte(3);
    if (png.substr(at + 4, 4) == "IDAT") packed += png.substr(at + 8, length);
    at += 12 + length;
  }
  std::ofstream(folder / "packed", std::ios::binary) << packed;
  scan::Inflater inflater(AnsweredFile::open(folder / "packed").value(), 2, packed.size());
  for (int r = 0; r < 480; ++r) {
    std::vector<std::uint8_t> row(1281);
    ASSERT_EQ(inflater.read(row), row.size()) << r;
    ASSERT_EQ(row[0], 0);
    for (int c = 0; c < 640; ++c) {
      const auto at = static_cast<std::size_t>(2 * c + 1);
      ASSERT_EQ(std::uint32_t{row[at]} << 8 | row[at + 1], code(c, r) & 0xffff) << c << ", " << r;
    }
  }
  std::vector<std::uint8_t> more(1);
  EXPECT_EQ(inflater.read(more), 0u);
  EXPECT_FALSE(inflater.damaged());
}

}  // namespace
}  // namespace relievo
