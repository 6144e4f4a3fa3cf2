// SPDX-License-Identifier: Apache-2.0
// Reads records by position, in the file or in an unpacked chunk.
#include "drivers/rosbag/record.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace relievo::rosbag {
namespace {

constexpr std::size_t kUsualHeader = 256;                   // read at once
constexpr std::size_t kMostHeader = std::size_t{64} << 10;  // bytes

bool parseHeader(Bytes header, Record& record) {
  ByteReader fields(header);
  while (fields.left() > 0) {
    const std::string_view field = fields.text();
    const std::size_t equals = field.find('=');
    if (!fields.ok() || equals == field.npos) return false;
    const std::string_view name = field.substr(0, equals), text = field.substr(equals + 1);
    ByteReader value(Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    if (name == "op") record.op = static_cast<Op>(value.value<std::uint8_t>());
    if (name == "conn") record.connection = value.value<std::uint32_t>();
    if (name == "size") record.size = value.value<std::uint32_t>();
    if (name == "chunk_count") record.chunk_count = value.value<std::uint32_t>();
    if (name == "index_pos") record.index_pos = value.value<std::uint64_t>();
    if (name == "chunk_pos") record.chunk_pos = value.value<std::uint64_t>();
    if (name == "time") record.time = takeTime(value);
    if (name == "topic") record.topic = text;
    if (name == "compression") record.compression = text;
    if (!value.ok()) return false;
  }
  return true;
}

}  // namespace

std::size_t Range::read(std::uint64_t at, std::span<std::uint8_t> out) const {
  if (at >= bytes) return 0;
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), bytes - at));
  if (memory) {
    std::memcpy(out.data(), memory->data() + at, count);
    return count;
  }
  return file.read(begin + at, out.first(count)).value_or(0);
}

std::optional<Record> readRecord(const Range& range, std::uint64_t at) {
  std::array<std::uint8_t, kUsualHeader> usual;
  const std::size_t got = range.read(at, usual);
  const auto length = ByteReader(Bytes(usual).first(got)).value<std::uint32_t>();
  constexpr std::size_t kLengths = 2 * sizeof(std::uint32_t);
  if (length == 0 || length > kMostHeader) return std::nullopt;
  Bytes whole = Bytes(usual).first(got);
  std::vector<std::uint8_t> longer;
  if (length + kLengths > kUsualHeader) {
    longer.resize(length + kLengths);
    whole = Bytes(longer).first(range.read(at, longer));
  }
  ByteReader reader(whole);
  const Bytes header = reader.block();
  Record record;
  record.data_bytes = reader.value<std::uint32_t>();
  record.data_begin = at + reader.position();
  if (!reader.ok() || !parseHeader(header, record)) return std::nullopt;
  return record;
}

std::optional<std::vector<std::uint8_t>> readData(const Range& range, const Record& record, std::size_t most_bytes) {
  if (record.data_bytes > most_bytes || record.end() > range.bytes) return std::nullopt;
  std::vector<std::uint8_t> data(record.data_bytes);
  if (range.read(record.data_begin, data) != data.size()) return std::nullopt;
  return data;
}

}  // namespace relievo::rosbag
