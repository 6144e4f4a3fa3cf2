// SPDX-License-Identifier: Apache-2.0
// The table of contents of a bag, and its messages by position.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/rosbag/record.h"
#include "platform/error.h"

namespace relievo::rosbag {

inline constexpr std::size_t kMostMessage = std::size_t{64} << 20;      // bytes
inline constexpr std::size_t kMostChunk = std::size_t{128} << 20;       // bytes, unpacked
inline constexpr std::uint64_t kMostSearched = std::uint64_t{1} << 30;  // bytes unpacked to find out what is in the bag

// A topic of one publisher.
struct Connection {
  std::string topic, type;            // type: "sensor_msgs/Image", ..
  std::vector<std::uint32_t> chunks;  // those with its messages, in the file's order
  std::uint64_t messages = 0;
};

class BagFile {
 public:
  // Corrupt if the bag has no readable chunk; Unsupported if it is of another version or encrypted. Cancelled soon
  // after the flag is set.
  [[nodiscard]] Result<void> open(const std::string& path, const std::atomic<bool>& cancelled);
  void close() noexcept { *this = BagFile(); }
  [[nodiscard]] std::optional<Error> failure() const { return file_.file.failure(); }

  [[nodiscard]] const std::map<std::uint32_t, Connection>& connections() const noexcept { return connections_; }
  // The content of a chunk; the last one unpacked is kept. A chunk that cannot be unpacked is empty; so are all, once
  // kMostSearched bytes have been unpacked, until `endSearch`.
  [[nodiscard]] const Range& content(std::uint32_t chunk);
  // Call when the film's streams have been found.
  void endSearch() noexcept {
    budget_ = ~std::uint64_t{0};
    unpacked_chunk_.reset();
  }

 private:
  [[nodiscard]] bool readIndex(const Record& header, const std::atomic<bool>& cancelled);
  void scan(const std::atomic<bool>& cancelled);
  void addIndexed(const std::vector<Record>& index);
  void scanChunk(std::uint32_t chunk);
  void addConnection(const Range& range, const Record& record);
  void addToChunk(std::uint32_t connection, std::uint32_t chunk, std::uint64_t messages);
  void addChunkInfo(const Record& record, std::uint32_t chunk);

  Range file_;
  std::vector<std::uint64_t> chunks_;  // where their records begin
  std::map<std::uint32_t, Connection> connections_;
  std::size_t entries_ = 0;               // of all connections' lists of chunks
  std::uint64_t budget_ = kMostSearched;  // bytes to unpack
  std::optional<std::uint32_t> unpacked_chunk_;
  Range unpacked_;
};

// Goes through the messages of a chunk's content, which must outlive it.
class MessageWalk {
 public:
  explicit MessageWalk(const Range& content, std::uint64_t at = 0) noexcept : content_(&content), at_(at) {}
  // Where the next message is searched from.
  [[nodiscard]] std::uint64_t at() const noexcept { return at_; }
  // Nullopt at the end, and where the content is damaged.
  [[nodiscard]] std::optional<Record> next();

 private:
  const Range* content_;
  std::uint64_t at_;
};

// The places of a connection's messages in the file's order, at most `most`, until `take` returns false.
template <class Take>
void eachMessage(BagFile& bag, std::uint32_t connection, std::size_t most, Take take) {
  for (const std::uint32_t chunk : bag.connections().at(connection).chunks) {
    const Range& content = bag.content(chunk);
    MessageWalk walk(content);
    while (const auto record = walk.next()) {
      if (record->connection != connection) continue;
      if (most-- == 0 || !take(content, *record)) return;
    }
  }
}

// The content of a connection's first message.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> firstMessage(BagFile& bag, std::uint32_t connection);

}  // namespace relievo::rosbag
