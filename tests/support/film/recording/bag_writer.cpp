// SPDX-License-Identifier: Apache-2.0
// Writes bags by the published description of the format.
#include "tests/support/film/recording/bag_writer.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <concepts>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace relievo::test {
namespace {

constexpr std::size_t kBagHeader = 4096;  // with its padding

std::string field(std::string_view name, std::string_view value) {
  return ByteWriter().text(std::string(name) + "=" + std::string(value)).bytes();
}
template <std::integral T>
std::string field(std::string_view name, T value) {
  return field(name, std::string_view(reinterpret_cast<const char*>(&value), sizeof value));
}
std::string op(std::uint8_t code) {
  return field("op", code);
}
std::string record(std::string_view header, std::string_view data) {
  return ByteWriter().text(header).text(data).bytes();
}
std::string packedTime(std::int64_t ns) {
  return ByteWriter().time(ns).bytes();
}

}  // namespace

BagWriter::BagWriter(std::string compression) : compression_(std::move(compression)), file_("#ROSBAG V2.0\n") {
  file_.append(kBagHeader, ' ');
}

std::uint32_t BagWriter::connect(const std::string& topic, const std::string& type) {
  const auto id = static_cast<std::uint32_t>(connections_.size());
  const std::string data = field("topic", topic) + field("type", type) + field("md5sum", "*") +
                           field("message_definition", std::string(3000, '#'));
  connections_.push_back(record(op(7) + field("conn", id) + field("topic", topic), data));
  introduced_.push_back(false);
  return id;
}

void BagWriter::write(std::uint32_t connection, std::int64_t time_ns, const std::string& message) {
  if (!introduced_[connection]) chunk_ += connections_[connection];
  introduced_[connection] = true;
  index_[connection].time(time_ns).add(static_cast<std::uint32_t>(chunk_.size()));
  ++counts_[connection];
  chunk_ += record(op(2) + field("conn", connection) + field("time", packedTime(time_ns)), message);
}

std::string BagWriter::pack(const std::string& plain) const {
  if (compression_ == "none") return plain;
  std::string packed(plain.size() * 2 + 1024, '\0');
  if (compression_ == "lz4") {
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    preferences.frameInfo.blockMode = LZ4F_blockIndependent;
    const std::size_t size = LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), &preferences);
    if (LZ4F_isError(size) != 0) throw std::runtime_error("lz4");
    packed.resize(size);
    return packed;
  }
  auto size = static_cast<unsigned>(packed.size());
  std::string copy = plain;
  if (BZ2_bzBuffToBuffCompress(packed.data(), &size, copy.data(), static_cast<unsigned>(copy.size()), 9, 0, 0) != 0) {
    throw std::runtime_error("bz2");
  }
  packed.resize(size);
  return packed;
}

void BagWriter::writeHole(std::uint32_t connection, std::int64_t time_ns, std::uint32_t bytes) {
  write(connection, time_ns, "");
  const std::string length = ByteWriter().add(bytes).bytes();
  chunk_.replace(chunk_.size() - length.size(), length.size(), length);
  hole_ = bytes;
  endChunk();
}

void BagWriter::endChunk() {
  if (chunk_.empty()) return;
  infos_.push_back({position(), counts_});
  const std::string packed = pack(chunk_);
  const std::string header =
      op(5) + field("compression", compression_) + field("size", static_cast<std::uint32_t>(chunk_.size() + hole_));
  file_ += ByteWriter().text(header).add(static_cast<std::uint32_t>(packed.size() + hole_)).raw(packed).bytes();
  if (hole_ > 0) holes_.emplace_back(file_.size(), hole_);
  skipped_ += std::exchange(hole_, 0);
  for (const auto& [connection, entries] : index_) {
    file_ +=
        record(op(4) + field("ver", std::uint32_t{1}) + field("conn", connection) + field("count", counts_[connection]),
               entries.bytes());
  }
  chunk_.clear();
  index_.clear();
  counts_.clear();
}

std::string BagWriter::finish(bool indexed) {
  endChunk();
  const std::uint64_t index_pos = indexed ? position() : 0;
  for (const std::string& connection : connections_) {
    if (indexed) file_ += connection;
  }
  for (const Info& info : infos_) {
    if (!indexed) break;
    ByteWriter counts;
    for (const auto& [connection, count] : info.counts) counts.add(connection).add(count);
    file_ += record(op(6) + field("ver", std::uint32_t{1}) + field("chunk_pos", info.begin) +
                        field("start_time", packedTime(0)) + field("end_time", packedTime(0)) +
                        field("count", static_cast<std::uint32_t>(info.counts.size())),
                    counts.bytes());
  }
  const std::string header = op(3) + field("index_pos", index_pos) +
                             field("conn_count", static_cast<std::uint32_t>(indexed ? connections_.size() : 0)) +
                             field("chunk_count", static_cast<std::uint32_t>(indexed ? infos_.size() : 0));
  const std::string padding(kBagHeader - header.size() - 2 * sizeof(std::uint32_t), ' ');
  file_.replace(13, kBagHeader, record(header, padding));
  return file_;
}

void BagWriter::save(const std::string& path, bool indexed) {
  const std::string bytes = finish(indexed);
  std::ofstream file(path, std::ios::binary);
  std::size_t written = 0;
  for (const auto& [place, length] : holes_) {
    file.write(bytes.data() + written, static_cast<std::streamsize>(place - written));
    file.seekp(length, std::ios::cur);
    written = place;
  }
  file.write(bytes.data() + written, static_cast<std::streamsize>(bytes.size() - written));
}

}  // namespace relievo::test
