// SPDX-License-Identifier: Apache-2.0
// Reads the summary of an MCAP file, or makes one by going from record to record.
#include "drivers/rosbag/mcap_file.h"

#include <algorithm>
#include <string>
#include <utility>

#include "drivers/rosbag/unpack.h"
#include "platform/files/byte_reader.h"

namespace relievo::rosbag {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::uint8_t kFooter = 2, kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6, kMessageIndex = 7,
                       kChunkIndex = 8, kDataEnd = 0xf;
constexpr std::size_t kHead = 9;            // the kind of a record, and its length
constexpr std::size_t kMessageHead = 22;    // channel, number, two times
constexpr std::size_t kLooseMessages = 64;  // outside of chunks, that are taken together

template <std::size_t N>
Bytes readAt(const Range& range, std::uint64_t at, std::array<std::uint8_t, N>& room) {
  return Bytes(room).first(range.read(at, room));
}

}  // namespace

std::optional<McapFile::Head> McapFile::headAt(const Range& range, std::uint64_t at) {
  std::array<std::uint8_t, kHead> room;
  ByteReader reader(readAt(range, at, room));
  Head head{.op = reader.value<std::uint8_t>(), .begin = at, .data_begin = at + kHead};
  head.data_bytes = reader.value<std::uint64_t>();
  if (!reader.ok() || head.op == 0 || head.data_bytes > range.bytes - head.data_begin) return std::nullopt;
  return head;
}

std::vector<std::uint8_t> McapFile::dataOf(const Range& range, const Head& head) {
  std::vector<std::uint8_t> data(std::min<std::uint64_t>(head.data_bytes, kMostDescription));
  data.resize(range.read(head.data_begin, data));
  return data;
}

Result<void> McapFile::readContents(const std::atomic<bool>& cancelled) {
  std::array<std::uint8_t, kMagic.size()> magic;
  if (!std::ranges::equal(readAt(file_, 0, magic), kMagic, {}, {}, [](char c) { return static_cast<std::uint8_t>(c); }))
    return fail(ErrorCode::Unsupported, "only MCAP files of version 0 are supported; convert it (mcap recover)");
  if (readSummary(cancelled)) return {};
  chunks_.clear();
  schemas_.clear();
  startOver();
  scan(cancelled);
  return {};
}

// A schema names the type of a channel's messages; a channel is a topic.
void McapFile::describe(const Range& range, const Head& head) {
  if (head.op != kSchema && head.op != kChannel) return;
  const std::vector<std::uint8_t> data = dataOf(range, head);
  ByteReader reader(data);
  const auto id = reader.value<std::uint16_t>();
  if (head.op == kSchema) {
    if (const std::string_view name = reader.text(); reader.ok()) schemas_.emplace(id, name);
    return;
  }
  const auto schema = schemas_.find(reader.value<std::uint16_t>());
  std::string topic(reader.text());
  const std::string_view coding = reader.text();
  const bool cdr = coding == "cdr";
  if (!reader.ok() || schema == schemas_.end() || (!cdr && coding != "ros1")) return;
  addConnection(id, std::move(topic), schema->second, cdr);
}

// False if there is none, or it is damaged, or it names no chunks.
bool McapFile::readSummary(const std::atomic<bool>& cancelled) {
  constexpr std::uint64_t kFooterData = 20;
  constexpr std::uint64_t kEnd = kHead + kFooterData + kMagic.size();
  if (file_.bytes < kMagic.size() + kEnd) return false;
  const auto footer = headAt(file_, file_.bytes - kEnd);
  if (!footer || footer->op != kFooter || footer->data_bytes != kFooterData) return false;
  const std::vector<std::uint8_t> footer_data = dataOf(file_, *footer);
  const auto summary = ByteReader(footer_data).value<std::uint64_t>();
  struct Index {
    std::uint64_t chunk = 0;  // where it begins
    Head head;
  };
  std::vector<Index> indices;
  const auto chunkOf = [&](const Head& index) {
    constexpr std::uint64_t kTimes = 2 * sizeof(std::uint64_t);  // the first and the last one
    std::array<std::uint8_t, sizeof(std::uint64_t)> room;
    return ByteReader(readAt(file_, index.data_begin + kTimes, room)).value<std::uint64_t>();
  };
  for (std::uint64_t at = summary; at > 0 && at < footer->begin && !cancelled;) {
    const auto head = headAt(file_, at);
    if (!head || indices.size() >= kMostChunks) return false;
    at = head->end();
    describe(file_, *head);
    if (head->op == kChunkIndex) indices.push_back({chunkOf(*head), *head});
  }
  std::ranges::sort(indices, {}, &Index::chunk);
  for (const Index& index : indices) {
    if (cancelled || !addIndexedChunk(dataOf(file_, index.head))) return false;
  }
  return !chunks_.empty() && !connections_.empty();
}

// The number of messages of which a record of this kind says where they are.
std::uint64_t McapFile::indexed(const Head& index) noexcept {
  constexpr std::uint64_t kBefore = 6, kEntry = 16;
  return index.data_bytes < kBefore ? 0 : (index.data_bytes - kBefore) / kEntry;
}

bool McapFile::addIndexedChunk(Bytes index) {
  ByteReader reader(index);
  static_cast<void>(reader.take(2 * sizeof(std::uint64_t)));  // its first and last time
  const auto begin = reader.value<std::uint64_t>();
  static_cast<void>(reader.value<std::uint64_t>());  // its length
  const Bytes offsets = reader.block();
  const auto head = reader.ok() && begin < file_.bytes ? headAt(file_, begin) : std::nullopt;
  if (!head || head->op != kChunk) return false;
  const auto chunk = static_cast<std::uint32_t>(chunks_.size());
  chunks_.push_back({.begin = begin, .end = head->end()});
  if (offsets.empty()) {
    scanChunk(chunk);
    return true;
  }
  ByteReader entries(offsets);
  while (entries.left() > 0) {
    const auto channel = entries.value<std::uint16_t>();
    const auto at = entries.value<std::uint64_t>();
    const auto record = entries.ok() && at < file_.bytes ? headAt(file_, at) : std::nullopt;
    if (!record || record->op != kMessageIndex) return false;
    addToChunk(channel, chunk, indexed(*record));
  }
  return true;
}

// A chunk is followed by an index of its messages, one record for each channel. Chunks with channels not met before are
// searched for them, and the last chunk always: its index may have been cut off.
void McapFile::scan(const std::atomic<bool>& cancelled) {
  std::vector<Head> index;  // of the last chunk
  bool open = false;        // the last chunk's index may go on
  for (std::uint64_t at = kMagic.size(); at < file_.bytes && chunks_.size() < kMostChunks && !cancelled;) {
    const auto head = headAt(file_, at);
    if (!head || head->op == kDataEnd || head->op == kFooter) break;
    at = head->end();
    describe(file_, *head);
    if (head->op == kMessageIndex && index.size() < kMostConnections) index.push_back(*head);
    if (head->op != kChunk && head->op != kMessage) continue;
    if (std::exchange(open, head->op == kChunk)) endChunk(index);
    index.clear();
    if (head->op == kMessage) addLoose(*head);
    else chunks_.push_back({.begin = head->begin, .end = head->end()});
  }
  if (open) scanChunk(static_cast<std::uint32_t>(chunks_.size() - 1));
}

void McapFile::addLoose(const Head& message) {
  std::array<std::uint8_t, sizeof(std::uint16_t)> room;
  const auto channel = ByteReader(readAt(file_, message.data_begin, room)).value<std::uint16_t>();
  const bool fits = !chunks_.empty() && !chunks_.back().packed && chunks_.back().messages < kLooseMessages;
  if (!fits) chunks_.push_back({.begin = message.begin, .packed = false});
  chunks_.back().end = message.end();
  ++chunks_.back().messages;
  addToChunk(channel, static_cast<std::uint32_t>(chunks_.size() - 1), 1);
}

void McapFile::endChunk(const std::vector<Head>& index) {
  const auto chunk = static_cast<std::uint32_t>(chunks_.size() - 1);
  const auto channelOf = [&](const Head& head) {
    std::array<std::uint8_t, sizeof(std::uint16_t)> room;
    return ByteReader(readAt(file_, head.data_begin, room)).value<std::uint16_t>();
  };
  const auto known = [&](const Head& head) { return connections_.contains(channelOf(head)); };
  if (index.empty() || !std::ranges::all_of(index, known)) return scanChunk(chunk);
  for (const Head& head : index) addToChunk(channelOf(head), chunk, indexed(head));
}

void McapFile::scanChunk(std::uint32_t chunk) {
  const Range& range = content(chunk);
  for (std::uint64_t at = 0; at < range.bytes;) {
    const auto head = headAt(range, at);
    if (!head) return;
    describe(range, *head);
    if (head->op == kMessage) {
      const auto message = messageFrom(range, at);
      if (message) addToChunk(message->connection, chunk, 1);
    }
    at = head->end();
  }
}

Range McapFile::unpack(std::uint32_t chunk) {
  const Chunk& place = chunks_[chunk];
  const auto part = [&](std::uint64_t begin, std::uint64_t end) {
    return Range{.file = file_.file, .begin = begin, .bytes = end - begin, .memory = nullptr};
  };
  if (!place.packed) return part(place.begin, place.end);
  std::array<std::uint8_t, 64> room;
  ByteReader reader(readAt(part(place.begin + kHead, place.end), 0, room));
  static_cast<void>(reader.take(2 * sizeof(std::uint64_t)));  // its first and last time
  const auto plain_bytes = reader.value<std::uint64_t>();
  static_cast<void>(reader.value<std::uint32_t>());  // a checksum
  const std::string compression(reader.text());
  const auto packed_bytes = reader.value<std::uint64_t>();
  const std::uint64_t begin = place.begin + kHead + reader.position();
  if (!reader.ok() || begin > place.end) return {};
  Range packed = part(begin, begin + std::min(packed_bytes, place.end - begin));
  if (compression.empty()) return packed;
  if (plain_bytes > mostUnpacked()) return {};
  if (compression == "lz4") return inMemory(unpackLz4(packed, plain_bytes));
  if (compression == "zstd") return inMemory(unpackZstd(packed, plain_bytes));
  return {};
}

std::optional<Record> McapFile::messageFrom(const Range& content, std::uint64_t at) const {
  while (at < content.bytes) {
    const auto head = headAt(content, at);
    if (!head) return std::nullopt;
    at = head->end();
    if (head->op != kMessage || head->data_bytes < kMessageHead || head->data_bytes > kMostChunk) continue;
    std::array<std::uint8_t, kMessageHead> room;
    ByteReader reader(readAt(content, head->data_begin, room));
    Record record{.op = Op::Message, .connection = reader.value<std::uint16_t>()};
    static_cast<void>(reader.value<std::uint32_t>());  // a counter
    record.time = Duration(std::min<std::uint64_t>(reader.value<std::uint64_t>(), kLatestTime.count()));
    record.data_begin = head->data_begin + kMessageHead;
    record.data_bytes = static_cast<std::uint32_t>(head->data_bytes - kMessageHead);
    if (!reader.ok()) return std::nullopt;
    return record;
  }
  return std::nullopt;
}

}  // namespace relievo::rosbag
