// SPDX-License-Identifier: Apache-2.0
// Bags of colour and depth whose samples and times are known, written by the tests themselves.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/rosbag/rosbag.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/recording/bag_writer.h"
#include "tests/support/film/recording/ros_messages.h"

namespace relievo::test {

inline constexpr std::uint32_t kCols = 24, kRows = 16;
inline constexpr int kPictures = 12;
inline constexpr std::int64_t kMs = 1'000'000;
inline constexpr std::int64_t kFirstStamp = 1'600'000'000'123'456'789;
inline constexpr std::int64_t kPeriod = 33'366'700;  // no whole number of ms

// Falls to the right and downwards; a hole at the top left, another code of a hole beside it.
inline std::uint16_t codeAtSample(std::uint32_t c, std::uint32_t r, int picture) {
  if (c == 0 && r == 0) return 0;
  if (c == 1 && r == 0) return 65535;
  return static_cast<std::uint16_t>(1000 + 20 * r + c + 3 * static_cast<std::uint32_t>(picture));
}

struct Layout {
  bool big_endian = false;
  std::uint32_t padding = 0;  // behind each row
};
inline std::string depthData(int picture, const Layout& layout = {}) {
  std::string data;
  for (std::uint32_t r = 0; r < kRows; ++r) {
    for (std::uint32_t c = 0; c < kCols; ++c) {
      const std::uint16_t code = codeAtSample(c, r, picture);
      const std::uint16_t stored = layout.big_endian ? std::byteswap(code) : code;
      data.append(reinterpret_cast<const char*>(&stored), sizeof stored);
    }
    data.append(layout.padding, '\x55');
  }
  return data;
}
inline BagImage depthImage(int picture, const Layout& layout = {}) {
  return {.stamp_ns = kFirstStamp + picture * kPeriod,
          .cols = kCols,
          .rows = kRows,
          .step = 2 * kCols + layout.padding,
          .encoding = "16UC1",
          .big_endian = layout.big_endian,
          .data = depthData(picture, layout)};
}
// Red at the top left, blue elsewhere.
inline BagImage colorImage(int picture, const std::string& encoding = "rgb8") {
  std::string data;
  for (std::uint32_t i = 0; i < kCols * kRows; ++i) {
    const bool red = i < 4;
    data += encoding == "rgb8" ? (red ? "\xff" : std::string(1, '\0')) : (red ? std::string(1, '\0') : "\xff");
    data += std::string(1, '\0');
    data += encoding == "rgb8" ? (red ? std::string(1, '\0') : "\xff") : (red ? "\xff" : std::string(1, '\0'));
  }
  return {.stamp_ns = kFirstStamp + picture * kPeriod + 5 * kMs,
          .cols = kCols,
          .rows = kRows,
          .step = 3 * kCols,
          .encoding = encoding,
          .data = data};
}

class RosbagSource : public testing::Test {
 protected:
  std::string save(const std::string& bytes) {
    const std::string path = folder_ / ("film" + std::to_string(saved_++) + ".bag");
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::unique_ptr<MediaSource> open(const std::string& bytes) {
    auto source = makeRosbagSource();
    const auto opened = source->open(save(bytes));
    EXPECT_TRUE(opened) << opened.error().message;
    return source;
  }
  Result<void> openingOf(const std::string& bytes) { return makeRosbagSource()->open(save(bytes)); }
  TemporaryFolder folder_;
  int saved_ = 0;
};

// Ways to write the same recording: kPictures of /camera/depth/image_raw and of /camera/color/image_raw.
struct Variant {
  const char* name;
  std::function<std::string()> bag;
};
inline std::string nameOf(const testing::TestParamInfo<Variant>& info) {
  return info.param.name;
}
class RosbagVariants : public RosbagSource, public testing::WithParamInterface<Variant> {};
// Those that can be played though their end is missing.
class RosbagCutOff : public RosbagVariants {};

inline const StreamInfo* streamOf(const MediaSource& source, const std::string& title) {
  for (const StreamInfo& stream : source.streams()) {
    if (stream.tags.at("TITLE") == title) return &stream;
  }
  return nullptr;
}

inline std::uint32_t sample(const Frame& frame, std::uint32_t c, std::uint32_t r, int component = 0) {
  return sampleAt(frame, component, static_cast<int>(c), static_cast<int>(r));
}

inline void expectDepth(const std::vector<Frame>& frames, int first = 0, int count = kPictures) {
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.pts, MediaTime(Duration((first + i) * kPeriod))) << "exact";
    ASSERT_EQ(frame.width, static_cast<int>(kCols));
    ASSERT_EQ(frame.height, static_cast<int>(kRows));
    for (std::uint32_t r = 0; r < kRows; ++r) {
      for (std::uint32_t c = 0; c < kCols; ++c) ASSERT_EQ(sample(frame, c, r), codeAtSample(c, r, first + i));
    }
  }
}

}  // namespace relievo::test
