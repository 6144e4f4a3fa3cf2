// SPDX-License-Identifier: Apache-2.0
// The table of contents of a bag of any format, and its messages by position.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/rosbag/messages.h"
#include "drivers/rosbag/record.h"
#include "platform/error.h"

namespace relievo::rosbag {

inline constexpr std::size_t kMostMessage = std::size_t{64} << 20;      // bytes
inline constexpr std::size_t kMostChunk = std::size_t{128} << 20;       // bytes, unpacked
inline constexpr std::uint64_t kMostSearched = std::uint64_t{1} << 30;  // bytes unpacked to find out what is in the bag
inline constexpr std::size_t kMostChunks = std::size_t{1} << 20;
inline constexpr std::size_t kMostConnections = std::size_t{1} << 16;
inline constexpr std::size_t kMostName = 4096;  // bytes of a topic's name, or its type's
inline constexpr std::size_t kMostDescription = std::size_t{4}
                                                << 20;  // bytes of a connection's or a chunk's description

// A topic of one publisher.
struct Connection {
  std::string topic, type;            // type: "sensor_msgs/Image", ..; ROS 2's names without "msg/"
  std::vector<std::uint32_t> chunks;  // those with its messages, in the file's order
  std::uint64_t messages = 0;
  bool cdr = false;  // serialised as ROS 2 does it
};

// A format of bags. Its messages lie in chunks.
class BagFile {
 public:
  virtual ~BagFile() = default;
  // Corrupt if the bag has no readable chunk; Unsupported if it is of another version or encrypted. Cancelled soon
  // after the flag is set.
  [[nodiscard]] Result<void> open(Range file, const std::atomic<bool>& cancelled);
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
  // The first message at `at` or behind it in a chunk's content; nullopt at the end, and where the content is damaged.
  [[nodiscard]] virtual std::optional<Record> messageFrom(const Range& content, std::uint64_t at) const = 0;

 protected:
  // Fills chunks and connections, by an index or by going from record to record.
  [[nodiscard]] virtual Result<void> readContents(const std::atomic<bool>& cancelled) = 0;
  // The content of the chunk; no more than kMostChunk bytes and the budget are unpacked.
  [[nodiscard]] virtual Range unpack(std::uint32_t chunk) = 0;
  [[nodiscard]] virtual bool hasChunks() const noexcept = 0;

  // Those with longer names than kMostName are passed over.
  void addConnection(std::uint32_t id, std::string topic, std::string type, bool cdr);
  void addToChunk(std::uint32_t connection, std::uint32_t chunk, std::uint64_t messages);
  // Forgets the connections, and the content of chunks: they will be numbered anew.
  void startOver() noexcept;
  [[nodiscard]] std::uint64_t mostUnpacked() const noexcept { return std::min<std::uint64_t>(kMostChunk, budget_); }
  [[nodiscard]] Range inMemory(std::vector<std::uint8_t> plain);

  Range file_;
  std::map<std::uint32_t, Connection> connections_;

 private:
  std::size_t entries_ = 0;               // of all connections' lists of chunks
  std::uint64_t budget_ = kMostSearched;  // bytes to unpack
  std::optional<std::uint32_t> unpacked_chunk_;
  Range unpacked_;
};

// Opens a bag of a known format, as its first bytes say.
[[nodiscard]] Result<std::unique_ptr<BagFile>> openBag(const std::string& path, const std::atomic<bool>& cancelled);
// Whether it begins like a bag, of any version.
[[nodiscard]] bool isBag(const AnsweredFile& file);

// Goes through the messages of a chunk's content, which must outlive it.
class MessageWalk {
 public:
  MessageWalk(const BagFile& bag, const Range& content, std::uint64_t at = 0) noexcept
      : bag_(&bag), content_(&content), at_(at) {}
  // Where the next message is searched from.
  [[nodiscard]] std::uint64_t at() const noexcept { return at_; }
  // Nullopt at the end, and where the content is damaged.
  [[nodiscard]] std::optional<Record> next() {
    auto record = bag_->messageFrom(*content_, at_);
    if (record) at_ = record->end();
    return record;
  }

 private:
  const BagFile* bag_;
  const Range* content_;
  std::uint64_t at_;
};

// The places of a connection's messages in the file's order, at most `most`, until `take` returns false.
template <class Take>
void eachMessage(BagFile& bag, std::uint32_t connection, std::size_t most, Take take) {
  for (const std::uint32_t chunk : bag.connections().at(connection).chunks) {
    const Range& content = bag.content(chunk);
    MessageWalk walk(bag, content);
    while (const auto record = walk.next()) {
      if (record->connection != connection) continue;
      if (most-- == 0 || !take(content, *record)) return;
    }
  }
}

// The content of a message. Nullopt unless it is whole and at most kMostMessage long.
[[nodiscard]] std::optional<Message> readMessage(const BagFile& bag, const Range& content, const Record& record);
// The content of a connection's first message.
[[nodiscard]] std::optional<Message> firstMessage(BagFile& bag, std::uint32_t connection);

}  // namespace relievo::rosbag
