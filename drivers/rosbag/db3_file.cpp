// SPDX-License-Identifier: Apache-2.0
// Reads the rows of a bag's tables; a message's data is read when it is played.
#include "drivers/rosbag/db3_file.h"

#include <algorithm>
#include <string>
#include <utility>

namespace relievo::rosbag {
namespace {

constexpr std::uint64_t kMostOthers = 4096;  // messages of a topic without pictures, such as /tf

std::string textOf(const Statement& row, int column) {
  const auto* const text = sqlite3_column_text(row.get(), column);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

}  // namespace

Result<void> Db3File::readContents(const std::atomic<bool>& cancelled) {
  if (auto opened = view_.open(file_.file, cancelled); !opened) return opened;
  const Statement topics = prepare(view_, "SELECT id, name, type, serialization_format FROM topics");
  const Statement messages = prepare(view_, "SELECT id, topic_id, timestamp FROM messages ORDER BY id");
  if (!topics || !messages)
    return fail(ErrorCode::Unsupported, "the database is no ROS 2 bag: it lacks the tables topics and messages");
  while (sqlite3_step(topics.get()) == SQLITE_ROW) {
    if (textOf(topics, 3) == "cdr")
      addConnection(static_cast<std::uint32_t>(sqlite3_column_int64(topics.get(), 0)), textOf(topics, 1),
                    textOf(topics, 2), true);
  }
  while (rows_.size() < kMostChunks && sqlite3_step(messages.get()) == SQLITE_ROW) {
    any_ = true;
    const Row row{.id = sqlite3_column_int64(messages.get(), 0),
                  .time_ns = std::clamp<std::int64_t>(sqlite3_column_int64(messages.get(), 2), 0, kLatestTime.count()),
                  .topic = static_cast<std::uint32_t>(sqlite3_column_int64(messages.get(), 1))};
    const auto topic = connections_.find(row.topic);
    if (topic == connections_.end()) continue;
    if (topic->second.messages >= kMostOthers && !topic->second.type.ends_with("Image")) continue;
    addToChunk(row.topic, static_cast<std::uint32_t>(rows_.size()), 1);
    rows_.push_back(row);
  }
  return {};
}

Range Db3File::unpack(std::uint32_t chunk) {
  unpacked_row_ = rows_[chunk];
  sqlite3_blob* blob = nullptr;
  std::vector<std::uint8_t> data;
  if (sqlite3_blob_open(view_.get(), "main", "messages", "data", unpacked_row_.id, 0, &blob) == SQLITE_OK) {
    const auto bytes = static_cast<std::size_t>(sqlite3_blob_bytes(blob));
    if (bytes <= std::min<std::uint64_t>(kMostMessage, mostUnpacked())) data.resize(bytes);
    if (sqlite3_blob_read(blob, data.data(), static_cast<int>(data.size()), 0) != SQLITE_OK) data.clear();
  }
  sqlite3_blob_close(blob);
  return inMemory(std::move(data));
}

std::optional<Record> Db3File::messageFrom(const Range& content, std::uint64_t at) const {
  if (at > 0 || content.bytes == 0) return std::nullopt;
  Record record{.op = Op::Message, .connection = unpacked_row_.topic};
  record.time = Duration(unpacked_row_.time_ns);
  record.data_bytes = static_cast<std::uint32_t>(content.bytes);
  return record;
}

}  // namespace relievo::rosbag
