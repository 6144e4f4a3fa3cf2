// SPDX-License-Identifier: Apache-2.0
// Reads a bag's index, or makes one by going from record to record.
#include "drivers/rosbag/ros1_file.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "drivers/rosbag/unpack.h"

namespace relievo::rosbag {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

}  // namespace

Result<void> Ros1File::readContents(const std::atomic<bool>& cancelled) {
  std::array<std::uint8_t, kMagic.size()> magic{};
  if (file_.read(0, magic) < magic.size() || !std::equal(kMagic.begin(), kMagic.end(), magic.begin()))
    return fail(ErrorCode::Unsupported, "only bags of the format 2.0 are supported; convert it (rosbag fix)");
  const auto header = readRecord(file_, kMagic.size());
  const bool indexed = header && header->op == Op::BagHeader && readIndex(*header, cancelled);
  if (!indexed) scan(cancelled);
  return {};
}

// False if there is no index, or it is damaged or not whole.
bool Ros1File::readIndex(const Record& header, const std::atomic<bool>& cancelled) {
  std::vector<Record> infos;
  for (std::uint64_t at = header.index_pos; at > 0 && at < file_.bytes && !cancelled;) {
    auto record = readRecord(file_, at);
    if (!record || record->end() > file_.bytes || infos.size() >= kMostChunks) break;
    at = record->end();
    if (record->op == Op::Connection) readConnection(file_, *record);
    if (record->op == Op::ChunkInfo) infos.push_back(std::move(*record));
  }
  std::ranges::sort(infos, {}, &Record::chunk_pos);
  for (const Record& info : infos) {
    const auto chunk = readRecord(file_, info.chunk_pos);
    if (!chunk || chunk->op != Op::Chunk || chunk->end() > file_.bytes) break;
    chunks_.push_back(info.chunk_pos);
    addChunkInfo(info, static_cast<std::uint32_t>(chunks_.size() - 1));
  }
  if (!chunks_.empty() && chunks_.size() == header.chunk_count && !connections_.empty()) return true;
  chunks_.clear();
  startOver();
  return false;
}

void Ros1File::addChunkInfo(const Record& record, std::uint32_t chunk) {
  const auto data = readData(file_, record, kMostDescription);
  if (!data) return;
  ByteReader counts(*data);
  while (counts.left() >= 2 * sizeof(std::uint32_t)) {
    const auto connection = counts.value<std::uint32_t>();
    addToChunk(connection, chunk, counts.value<std::uint32_t>());
  }
}

void Ros1File::readConnection(const Range& range, const Record& record) {
  if (connections_.contains(record.connection)) return;
  const auto data = readData(range, record, kMostDescription);
  if (!data) return;
  std::string type;
  ByteReader fields(*data);
  while (fields.left() > 0) {
    const std::string_view field = fields.text();
    if (!fields.ok()) break;
    if (field.starts_with("type=")) type = field.substr(5);
  }
  addConnection(record.connection, record.topic, std::move(type), false);
}

// A chunk is followed by an index of its messages, one record for each connection. Chunks with connections not met
// before are searched for them, and the last chunk always: its index may have been cut off.
void Ros1File::scan(const std::atomic<bool>& cancelled) {
  std::vector<Record> index;  // of the last chunk
  for (std::uint64_t at = kMagic.size(); at < file_.bytes && chunks_.size() < kMostChunks && !cancelled;) {
    const std::uint64_t begin = at;
    auto record = readRecord(file_, at);
    if (!record) break;
    at = record->end();
    if (record->op == Op::Connection) readConnection(file_, *record);
    if (record->op == Op::Index && index.size() < kMostConnections) index.push_back(std::move(*record));
    if (record->op != Op::Chunk) continue;
    if (!chunks_.empty()) addIndexed(index);
    index.clear();
    chunks_.push_back(begin);
  }
  if (!chunks_.empty()) scanChunk(static_cast<std::uint32_t>(chunks_.size() - 1));
}

void Ros1File::addIndexed(const std::vector<Record>& index) {
  const auto chunk = static_cast<std::uint32_t>(chunks_.size() - 1);
  const auto known = [&](const Record& record) { return connections_.contains(record.connection); };
  if (index.empty() || !std::ranges::all_of(index, known)) return scanChunk(chunk);
  constexpr std::uint32_t kEntryBytes = 12;  // time and offset of a message
  for (const Record& record : index) addToChunk(record.connection, chunk, record.data_bytes / kEntryBytes);
}

void Ros1File::scanChunk(std::uint32_t chunk) {
  const Range& range = content(chunk);
  for (std::uint64_t at = 0; at < range.bytes;) {
    const auto record = readRecord(range, at);
    if (!record || record->end() > range.bytes) return;
    at = record->end();
    if (record->op == Op::Connection) readConnection(range, *record);
    if (record->op == Op::Message) addToChunk(record->connection, chunk, 1);
  }
}

Range Ros1File::unpack(std::uint32_t chunk) {
  const auto record = readRecord(file_, chunks_[chunk]);
  if (!record || record->data_begin > file_.bytes) return {};
  Range packed{.file = file_.file,
               .begin = record->data_begin,
               .bytes = std::min<std::uint64_t>(record->data_bytes, file_.bytes - record->data_begin),
               .memory = nullptr};
  if (record->compression == "none") return packed;
  if (record->size > mostUnpacked()) return {};
  if (record->compression == "lz4") return inMemory(unpackLz4(packed, record->size));
  if (record->compression == "bz2") return inMemory(unpackBz2(packed, record->size));
  return {};
}

std::optional<Record> Ros1File::messageFrom(const Range& content, std::uint64_t at) const {
  while (at < content.bytes) {
    auto record = readRecord(content, at);
    if (!record || record->end() > content.bytes) return std::nullopt;
    at = record->end();
    if (record->op == Op::Message) return record;
  }
  return std::nullopt;
}

}  // namespace relievo::rosbag
