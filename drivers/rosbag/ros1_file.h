// SPDX-License-Identifier: Apache-2.0
// The format 2.0 of ROS 1's bags.
#pragma once

#include <string_view>
#include <vector>

#include "drivers/rosbag/bag_file.h"

namespace relievo::rosbag {

inline constexpr std::string_view kAnyRos1Magic = "#ROSBAG V";

// A bag with an index is opened from it; one without (the recording was cut off) is scanned from record to record.
class Ros1File final : public BagFile {
 public:
  [[nodiscard]] std::optional<Record> messageFrom(const Range& content, std::uint64_t at) const override;

 private:
  [[nodiscard]] Result<void> readContents(const std::atomic<bool>& cancelled) override;
  [[nodiscard]] Range unpack(std::uint32_t chunk) override;
  [[nodiscard]] bool hasChunks() const noexcept override { return !chunks_.empty(); }
  [[nodiscard]] bool readIndex(const Record& header, const std::atomic<bool>& cancelled);
  void scan(const std::atomic<bool>& cancelled);
  void addIndexed(const std::vector<Record>& index);
  void scanChunk(std::uint32_t chunk);
  void readConnection(const Range& range, const Record& record);
  void addChunkInfo(const Record& record, std::uint32_t chunk);

  std::vector<std::uint64_t> chunks_;  // where their records begin
};

}  // namespace relievo::rosbag
