// SPDX-License-Identifier: Apache-2.0
// What all formats of bags have in common.
#include "drivers/rosbag/bag_file.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "drivers/rosbag/db3_file.h"
#include "drivers/rosbag/mcap_file.h"
#include "drivers/rosbag/ros1_file.h"

namespace relievo::rosbag {
namespace {

constexpr std::size_t kMostEntries = std::size_t{1} << 24;  // of chunks by connection

Error openError(const Error& error) noexcept {
  if (error.code == ErrorCode::NotFound) return {error.code, error.os_error, "there is no such file"};
  if (error.code != ErrorCode::PermissionDenied) return error;
  return {error.code, error.os_error, "the file may not be read; check its permissions"};
}

std::string firstBytes(const AnsweredFile& file) {
  std::array<std::uint8_t, 16> first{};
  const std::size_t got = file.read(0, first).value_or(0);
  return {first.begin(), first.begin() + static_cast<std::ptrdiff_t>(got)};
}

// ROS 2 has "sensor_msgs/msg/Image" where ROS 1 has "sensor_msgs/Image".
std::string plainType(std::string type) {
  constexpr std::string_view kMiddle = "/msg/";
  if (const std::size_t at = type.find(kMiddle); at != type.npos) type.replace(at, kMiddle.size(), "/");
  return type;
}

}  // namespace

bool isBag(const AnsweredFile& file) {
  const std::string first = firstBytes(file);
  return first.starts_with(kAnyRos1Magic) || first.starts_with(kAnyMcapMagic) || first.starts_with(kSqliteMagic);
}

Result<std::unique_ptr<BagFile>> openBag(const std::string& path, const std::atomic<bool>& cancelled) {
  auto file = AnsweredFile::open(path);
  if (!file) return std::unexpected(openError(file.error()));
  const auto bytes = file->bytes();
  if (!bytes) return std::unexpected(bytes.error());
  const std::string first = firstBytes(*file);
  std::unique_ptr<BagFile> bag;
  if (first.starts_with(kAnyMcapMagic)) bag = std::make_unique<McapFile>();
  else if (first.starts_with(kSqliteMagic)) bag = std::make_unique<Db3File>();
  else bag = std::make_unique<Ros1File>();
  const Range range{.file = std::move(*file), .begin = 0, .bytes = *bytes, .memory = nullptr};
  if (auto opened = bag->open(range, cancelled); !opened) return std::unexpected(opened.error());
  return bag;
}

Result<void> BagFile::open(Range file, const std::atomic<bool>& cancelled) {
  file_ = std::move(file);
  auto read = readContents(cancelled);
  if (cancelled) return fail(ErrorCode::Cancelled, "interrupted while the bag was opened");
  if (const auto failed = failure()) return std::unexpected(*failed);
  if (!read) return read;
  if (!hasChunks()) return fail(ErrorCode::Corrupt, "the bag holds no data; it was cut off before the first chunk");
  return {};
}

const Range& BagFile::content(std::uint32_t chunk) {
  if (unpacked_chunk_ == chunk) return unpacked_;
  unpacked_chunk_ = chunk;
  unpacked_ = {};
  return unpacked_ = unpack(chunk);
}

Range BagFile::inMemory(std::vector<std::uint8_t> plain) {
  budget_ -= plain.size();
  Range range;
  range.bytes = plain.size();
  range.memory = std::make_shared<const std::vector<std::uint8_t>>(std::move(plain));
  return range;
}

void BagFile::addConnection(std::uint32_t id, std::string topic, std::string type, bool cdr) {
  if (connections_.size() >= kMostConnections || std::max(topic.size(), type.size()) > kMostName) return;
  connections_.try_emplace(
      id, Connection{.topic = std::move(topic), .type = plainType(std::move(type)), .chunks = {}, .cdr = cdr});
}

void BagFile::addToChunk(std::uint32_t connection, std::uint32_t chunk, std::uint64_t messages) {
  const auto found = connections_.find(connection);
  if (found == connections_.end() || messages == 0) return;
  found->second.messages += messages;
  std::vector<std::uint32_t>& chunks = found->second.chunks;
  if ((!chunks.empty() && chunks.back() == chunk) || ++entries_ > kMostEntries) return;
  chunks.push_back(chunk);
}

void BagFile::startOver() noexcept {
  connections_.clear();
  entries_ = 0;
  unpacked_chunk_.reset();
}

std::optional<Message> readMessage(const BagFile& bag, const Range& content, const Record& record) {
  auto data = readData(content, record, kMostMessage);
  const auto connection = bag.connections().find(record.connection);
  if (!data || connection == bag.connections().end()) return std::nullopt;
  return Message{std::move(*data), connection->second.cdr};
}

std::optional<Message> firstMessage(BagFile& bag, std::uint32_t connection) {
  std::optional<Message> first;
  eachMessage(bag, connection, 1, [&](const Range& content, const Record& record) {
    first = readMessage(bag, content, record);
    return false;
  });
  return first;
}

}  // namespace relievo::rosbag
