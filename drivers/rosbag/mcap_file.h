// SPDX-License-Identifier: Apache-2.0
// The MCAP format, version 0, in which ROS 2 records (mcap.dev, "MCAP Format Specification").
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "drivers/rosbag/bag_file.h"

namespace relievo::rosbag {

inline constexpr std::string_view kAnyMcapMagic = "\x89MCAP";

// Messages of ROS 2 (CDR) and of ROS 1. A file with a summary is opened from it; one without (the recording was cut
// off) is scanned from record to record. Messages outside of chunks count as chunks of a few records.
class McapFile final : public BagFile {
 public:
  [[nodiscard]] std::optional<Record> messageFrom(const Range& content, std::uint64_t at) const override;

 private:
  struct Chunk {
    std::uint64_t begin = 0, end = 0;  // its record, or its messages
    bool packed = true;                // a record
    std::size_t messages = 0;          // outside of chunk records
  };
  struct Head {
    std::uint8_t op = 0;
    std::uint64_t begin = 0, data_begin = 0, data_bytes = 0;
    [[nodiscard]] std::uint64_t end() const noexcept { return data_begin + data_bytes; }
  };
  using Schemas = std::map<std::uint16_t, std::string>;

  [[nodiscard]] Result<void> readContents(const std::atomic<bool>& cancelled) override;
  [[nodiscard]] Range unpack(std::uint32_t chunk) override;
  [[nodiscard]] bool hasChunks() const noexcept override { return !chunks_.empty(); }
  [[nodiscard]] static std::optional<Head> headAt(const Range& range, std::uint64_t at);
  [[nodiscard]] static std::vector<std::uint8_t> dataOf(const Range& range, const Head& head);
  [[nodiscard]] bool readSummary(const std::atomic<bool>& cancelled);
  [[nodiscard]] bool addIndexedChunk(Bytes index);
  void scan(const std::atomic<bool>& cancelled);
  void addLoose(const Head& message);
  void endChunk(const std::vector<Head>& index);
  void scanChunk(std::uint32_t chunk);
  void describe(const Range& range, const Head& head);
  [[nodiscard]] static std::uint64_t indexed(const Head& index) noexcept;

  std::vector<Chunk> chunks_;
  Schemas schemas_;
};

}  // namespace relievo::rosbag
