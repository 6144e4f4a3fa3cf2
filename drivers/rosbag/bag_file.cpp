// SPDX-License-Identifier: Apache-2.0
// Reads a bag's index, or makes one by going from record to record.
#include "drivers/rosbag/bag_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include "drivers/rosbag/unpack.h"

namespace relievo::rosbag {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kMostChunks = std::size_t{1} << 20;
constexpr std::size_t kMostConnections = std::size_t{1} << 16;
constexpr std::size_t kMostEntries = std::size_t{1} << 24;      // of chunks by connection
constexpr std::size_t kMostDescription = std::size_t{4} << 20;  // bytes of a connection's or a chunk's description

Error openError(const Error& error) noexcept {
  if (error.code == ErrorCode::NotFound) return {error.code, error.os_error, "there is no such file"};
  if (error.code != ErrorCode::PermissionDenied) return error;
  return {error.code, error.os_error, "the file may not be read; check its permissions"};
}

}  // namespace

Result<void> BagFile::open(const std::string& path, const std::atomic<bool>& cancelled) {
  auto file = AnsweredFile::open(path);
  if (!file) return std::unexpected(openError(file.error()));
  const auto bytes = file->bytes();
  if (!bytes) return std::unexpected(bytes.error());
  file_ = {.file = std::move(*file), .begin = 0, .bytes = *bytes, .memory = nullptr};
  std::array<std::uint8_t, kMagic.size()> magic{};
  if (file_.read(0, magic) < magic.size() || !std::equal(kMagic.begin(), kMagic.end(), magic.begin())) {
    if (const auto failed = failure()) return std::unexpected(*failed);
    return fail(ErrorCode::Unsupported, "only bags of the format 2.0 are supported; convert it (rosbag fix)");
  }
  const auto header = readRecord(file_, kMagic.size());
  const bool indexed = header && header->op == Op::BagHeader && readIndex(*header, cancelled);
  if (!indexed) scan(cancelled);
  if (cancelled) return fail(ErrorCode::Cancelled, "interrupted while the bag was opened");
  if (const auto failed = failure()) return std::unexpected(*failed);
  if (chunks_.empty()) return fail(ErrorCode::Corrupt, "the bag holds no data; it was cut off before the first chunk");
  return {};
}

// False if there is no index, or it is damaged or not whole.
bool BagFile::readIndex(const Record& header, const std::atomic<bool>& cancelled) {
  std::vector<Record> infos;
  for (std::uint64_t at = header.index_pos; at > 0 && at < file_.bytes && !cancelled;) {
    auto record = readRecord(file_, at);
    if (!record || record->end() > file_.bytes || infos.size() >= kMostChunks) break;
    at = record->end();
    if (record->op == Op::Connection) addConnection(file_, *record);
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
  connections_.clear();
  entries_ = 0;
  return false;
}

void BagFile::addChunkInfo(const Record& record, std::uint32_t chunk) {
  const auto data = readData(file_, record, kMostDescription);
  if (!data) return;
  ByteReader counts(*data);
  while (counts.left() >= 2 * sizeof(std::uint32_t)) {
    const auto connection = counts.value<std::uint32_t>();
    addToChunk(connection, chunk, counts.value<std::uint32_t>());
  }
}

void BagFile::addConnection(const Range& range, const Record& record) {
  if (connections_.size() >= kMostConnections || connections_.contains(record.connection)) return;
  const auto data = readData(range, record, kMostDescription);
  if (!data) return;
  Connection connection{.topic = record.topic, .type = {}, .chunks = {}};
  ByteReader fields(*data);
  while (fields.left() > 0) {
    const std::string_view field = fields.text();
    if (!fields.ok()) break;
    if (field.starts_with("type=")) connection.type = field.substr(5);
  }
  connections_.emplace(record.connection, std::move(connection));
}

void BagFile::addToChunk(std::uint32_t connection, std::uint32_t chunk, std::uint64_t messages) {
  const auto found = connections_.find(connection);
  if (found == connections_.end() || messages == 0) return;
  found->second.messages += messages;
  std::vector<std::uint32_t>& chunks = found->second.chunks;
  if ((!chunks.empty() && chunks.back() == chunk) || ++entries_ > kMostEntries) return;
  chunks.push_back(chunk);
}

// A chunk is followed by an index of its messages, one record for each connection. Chunks with connections not met
// before are searched for them, and the last chunk always: its index may have been cut off.
void BagFile::scan(const std::atomic<bool>& cancelled) {
  std::vector<Record> index;  // of the last chunk
  for (std::uint64_t at = kMagic.size(); at < file_.bytes && chunks_.size() < kMostChunks && !cancelled;) {
    const std::uint64_t begin = at;
    auto record = readRecord(file_, at);
    if (!record) break;
    at = record->end();
    if (record->op == Op::Connection) addConnection(file_, *record);
    if (record->op == Op::Index && index.size() < kMostConnections) index.push_back(std::move(*record));
    if (record->op != Op::Chunk) continue;
    if (!chunks_.empty()) addIndexed(index);
    index.clear();
    chunks_.push_back(begin);
  }
  if (!chunks_.empty()) scanChunk(static_cast<std::uint32_t>(chunks_.size() - 1));
}

void BagFile::addIndexed(const std::vector<Record>& index) {
  const auto chunk = static_cast<std::uint32_t>(chunks_.size() - 1);
  const auto known = [&](const Record& record) { return connections_.contains(record.connection); };
  if (index.empty() || !std::ranges::all_of(index, known)) return scanChunk(chunk);
  constexpr std::uint32_t kEntryBytes = 12;  // time and offset of a message
  for (const Record& record : index) addToChunk(record.connection, chunk, record.data_bytes / kEntryBytes);
}

void BagFile::scanChunk(std::uint32_t chunk) {
  const Range& range = content(chunk);
  for (std::uint64_t at = 0; at < range.bytes;) {
    const auto record = readRecord(range, at);
    if (!record || record->end() > range.bytes) return;
    at = record->end();
    if (record->op == Op::Connection) addConnection(range, *record);
    if (record->op == Op::Message) addToChunk(record->connection, chunk, 1);
  }
}

const Range& BagFile::content(std::uint32_t chunk) {
  if (unpacked_chunk_ == chunk) return unpacked_;
  unpacked_chunk_ = chunk;
  unpacked_ = {};
  const auto record = readRecord(file_, chunks_[chunk]);
  if (!record || record->data_begin > file_.bytes) return unpacked_;
  const Range packed{.file = file_.file,
                     .begin = record->data_begin,
                     .bytes = std::min<std::uint64_t>(record->data_bytes, file_.bytes - record->data_begin),
                     .memory = nullptr};
  if (record->compression == "none") return unpacked_ = packed;
  if (record->size > std::min<std::uint64_t>(kMostChunk, budget_)) return unpacked_;
  std::vector<std::uint8_t> plain;
  if (record->compression == "lz4") plain = unpackLz4(packed, record->size);
  if (record->compression == "bz2") plain = unpackBz2(packed, record->size);
  budget_ -= plain.size();
  unpacked_.bytes = plain.size();
  unpacked_.memory = std::make_shared<const std::vector<std::uint8_t>>(std::move(plain));
  return unpacked_;
}

std::optional<std::vector<std::uint8_t>> firstMessage(BagFile& bag, std::uint32_t connection) {
  std::optional<std::vector<std::uint8_t>> first;
  eachMessage(bag, connection, 1, [&](const Range& content, const Record& record) {
    first = readData(content, record, kMostMessage);
    return false;
  });
  return first;
}

std::optional<Record> MessageWalk::next() {
  while (at_ < content_->bytes) {
    auto record = readRecord(*content_, at_);
    if (!record || record->end() > content_->bytes) return std::nullopt;
    at_ = record->end();
    if (record->op == Op::Message) return record;
  }
  return std::nullopt;
}

}  // namespace relievo::rosbag
