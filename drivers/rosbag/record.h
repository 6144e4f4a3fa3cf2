// SPDX-License-Identifier: Apache-2.0
// Records of the bag format 2.0: a header of named fields, and data.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/media/media_time.h"
#include "platform/files/answered_file.h"
#include "platform/files/byte_reader.h"

namespace relievo::rosbag {

using Bytes = std::span<const std::uint8_t>;

// Seconds and nanoseconds since 1970, or since whatever the recorder counts from.
[[nodiscard]] inline Duration takeTime(ByteReader& reader) noexcept {
  const auto seconds = reader.value<std::uint32_t>();
  return std::chrono::seconds(seconds) + Duration(reader.value<std::uint32_t>());
}

// No stamp is later. Recorded times are kept to it, so that the differences of all times can be told.
inline constexpr Duration kLatestTime = std::chrono::seconds(0xFFFFFFFF);

// A part of the file, or a chunk that was unpacked into memory.
struct Range {
  AnsweredFile file;
  std::uint64_t begin = 0, bytes = 0;
  std::shared_ptr<const std::vector<std::uint8_t>> memory;  // instead of the file

  // The number of bytes read; fewer than asked for at the end of the range, or if the file cannot be read.
  [[nodiscard]] std::size_t read(std::uint64_t at, std::span<std::uint8_t> out) const;
};

enum class Op : std::uint8_t {
  None,
  Message = 2,
  BagHeader = 3,
  Index = 4,
  Chunk = 5,
  ChunkInfo = 6,
  Connection = 7,
};

// The fields that a header may have; zero or empty if it has not.
struct Record {
  Op op = Op::None;
  std::uint32_t connection = 0;
  std::uint32_t size = 0;  // of a chunk, unpacked
  std::uint32_t chunk_count = 0;
  std::uint64_t index_pos = 0;
  std::uint64_t chunk_pos = 0;
  Duration time{0};
  std::string topic, compression;
  std::uint64_t data_begin = 0;  // in the range
  std::uint32_t data_bytes = 0;
  [[nodiscard]] std::uint64_t end() const noexcept { return data_begin + data_bytes; }
};

// The record that begins at `at`; its data may reach beyond the range. Nullopt if the header is damaged or not whole.
[[nodiscard]] std::optional<Record> readRecord(const Range& range, std::uint64_t at);

// Nullopt unless all of the data lies in the range and is at most `most_bytes` long.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> readData(const Range& range, const Record& record,
                                                                std::size_t most_bytes);

}  // namespace relievo::rosbag
