// SPDX-License-Identifier: Apache-2.0
#include "drivers/openni/record.h"

#include <array>
#include <span>

#include "platform/files/byte_reader.h"

namespace relievo::openni {
namespace {

constexpr std::uint32_t kFileMagic = 0x3031494e;    // "NI10"
constexpr std::uint32_t kRecordMagic = 0x0052494e;  // "NIR"
constexpr std::size_t kFileHeader = 24, kWideHeader = 28, kNarrowHeader = 24;
constexpr std::uint64_t kMostFields = std::uint64_t{1} << 20;  // bytes
// 1.0.0.4 is the first version that OpenNI reads, 1.0.1.0 the last one and the first with positions of 64 bits.
constexpr std::uint64_t kFirstVersion = 0x0100'0000'0000'0004, kWideVersion = 0x0100'0001'0000'0000;

}  // namespace

Result<void> RecordFile::open(const std::string& path) {
  auto opened = AnsweredFile::open(path);
  if (!opened) return std::unexpected(opened.error());
  file_ = std::move(*opened);
  const auto size = file_.bytes();
  if (!size) return std::unexpected(size.error());
  bytes_ = *size;
  const auto header = read(0, kFileHeader, kFileHeader);
  if (const auto failed = failure()) return std::unexpected(*failed);
  ByteReader fields(header ? std::span<const std::uint8_t>(*header) : std::span<const std::uint8_t>());
  if (fields.value<std::uint32_t>() != kFileMagic) {
    return fail(ErrorCode::Corrupt, "is no recording of OpenNI; check the file");
  }
  const std::uint64_t major = fields.value<std::uint8_t>(), minor = fields.value<std::uint8_t>();
  const std::uint64_t maintenance = fields.value<std::uint16_t>(), build = fields.value<std::uint32_t>();
  const std::uint64_t version = major << 56 | minor << 48 | maintenance << 32 | build;
  if (version < kFirstVersion || version > kWideVersion) {
    return fail(ErrorCode::Unsupported,
                "the OpenNI recording is of a version that is not known; record it by OpenNI 2");
  }
  wide_ = version == kWideVersion;
  return {};
}

std::uint64_t RecordFile::firstRecord() const noexcept {
  return kFileHeader;
}

std::optional<Record> RecordFile::recordAt(std::uint64_t at) const {
  const std::size_t header_bytes = wide_ ? kWideHeader : kNarrowHeader;
  std::array<std::uint8_t, kNarrowHeader> header{};
  if (at >= bytes_ || bytes_ - at < header_bytes) return std::nullopt;
  if (file_.read(at, header).value_or(0) != header.size()) return std::nullopt;
  ByteReader fields(header);
  if (fields.value<std::uint32_t>() != kRecordMagic) return std::nullopt;
  Record record{.op = static_cast<Op>(fields.value<std::uint32_t>()), .node = fields.value<std::uint32_t>()};
  const std::uint64_t record_bytes = fields.value<std::uint32_t>(), data_bytes = fields.value<std::uint32_t>();
  if (record_bytes < header_bytes || record_bytes > kMostFields || bytes_ - at < record_bytes + data_bytes) {
    return std::nullopt;
  }
  record.fields_begin = at + header_bytes;
  record.data_begin = at + record_bytes;
  record.end = record.data_begin + data_bytes;
  return record;
}

std::optional<std::vector<std::uint8_t>> RecordFile::read(std::uint64_t begin, std::uint64_t end,
                                                          std::uint64_t most_bytes) const {
  if (end > bytes_ || begin > end || end - begin > most_bytes) return std::nullopt;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(end - begin));
  if (file_.read(begin, bytes).value_or(0) != bytes.size()) return std::nullopt;
  return bytes;
}

std::optional<std::vector<std::uint8_t>> RecordFile::fieldsOf(const Record& record) const {
  return read(record.fields_begin, record.data_begin, kMostFields);
}

}  // namespace relievo::openni
