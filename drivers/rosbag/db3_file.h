// SPDX-License-Identifier: Apache-2.0
// ROS 2's bags in databases of SQLite (rosbag2_storage_sqlite3): tables `topics` and `messages`.
#pragma once

#include <string_view>
#include <vector>

#include "drivers/rosbag/bag_file.h"
#include "drivers/rosbag/sqlite_view.h"

namespace relievo::rosbag {

inline constexpr std::string_view kSqliteMagic = "SQLite format 3";

// Each message is a chunk of its own; of topics without pictures only the first ones are.
class Db3File final : public BagFile {
 public:
  [[nodiscard]] std::optional<Record> messageFrom(const Range& content, std::uint64_t at) const override;

 private:
  struct Row {
    std::int64_t id = 0, time_ns = 0;
    std::uint32_t topic = 0;
  };
  [[nodiscard]] Result<void> readContents(const std::atomic<bool>& cancelled) override;
  [[nodiscard]] Range unpack(std::uint32_t chunk) override;
  [[nodiscard]] bool hasChunks() const noexcept override { return any_; }

  SqliteView view_;
  std::vector<Row> rows_;
  bool any_ = false;  // there are messages
  Row unpacked_row_;  // of the content that was unpacked last
};

}  // namespace relievo::rosbag
