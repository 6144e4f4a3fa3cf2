// SPDX-License-Identifier: Apache-2.0
// Names of fields and their places are those of APPNOTE 6.3.9, sections 4.3 and 4.5.
#include "drivers/npz/archive.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "platform/files/byte_reader.h"

namespace relievo::npz {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50, kEnd64 = 0x06064b50,
                        kLocator64 = 0x07064b50;
constexpr std::size_t kLocalBytes = 30, kEndBytes = 22, kEnd64Bytes = 56, kLocatorBytes = 20;
constexpr std::size_t kLongestComment = 65535;
constexpr std::uint64_t kMostDirectory = std::uint64_t{1} << 20;  // bytes
constexpr std::size_t kMostMembers = 1000;
constexpr std::uint32_t kElsewhere = 0xffffffff;  // the 64-bit field has it

std::vector<std::uint8_t> bytesAt(const AnsweredFile& file, std::uint64_t at, std::uint64_t count) {
  std::vector<std::uint8_t> bytes(count);
  bytes.resize(file.read(at, bytes).value_or(0));
  return bytes;
}

struct Directory {
  std::uint64_t begin = 0, bytes = 0;
};

Directory directoryIn64(const AnsweredFile& file, std::uint64_t locator) {
  const auto place = bytesAt(file, locator, kLocatorBytes);
  ByteReader fields(place);
  if (fields.value<std::uint32_t>() != kLocator64) return {};
  static_cast<void>(fields.take(4));  // number of a disk
  const auto end = bytesAt(file, fields.value<std::uint64_t>(), kEnd64Bytes);
  ByteReader wide(end);
  if (wide.value<std::uint32_t>() != kEnd64) return {};
  static_cast<void>(wide.take(36));  // sizes, versions, disks and counts
  const auto bytes = wide.value<std::uint64_t>();
  return {.begin = wide.value<std::uint64_t>(), .bytes = wide.ok() ? bytes : 0};
}

// The record of its end is the last thing in the file, but for a comment.
Directory directoryOf(const AnsweredFile& file) {
  const std::uint64_t all = file.bytes().value_or(0);
  const std::uint64_t tail = std::min<std::uint64_t>(all, kEndBytes + kLongestComment);
  const auto bytes = bytesAt(file, all - tail, tail);
  for (std::size_t at = bytes.size() < kEndBytes ? 0 : bytes.size() - kEndBytes + 1; at-- > 0;) {
    ByteReader fields(std::span<const std::uint8_t>(bytes).subspan(at));
    if (fields.value<std::uint32_t>() != kEnd) continue;
    static_cast<void>(fields.take(8));  // disks and counts
    const auto size = fields.value<std::uint32_t>(), begin = fields.value<std::uint32_t>();
    if (size != kElsewhere && begin != kElsewhere) return {.begin = begin, .bytes = size};
    const std::uint64_t end = all - tail + at;
    return end < kLocatorBytes ? Directory{} : directoryIn64(file, end - kLocatorBytes);
  }
  return {};
}

// A field of 64 bits for each of the values that did not fit, in their order.
void widen(ByteReader extra, std::uint64_t& plain, std::uint64_t& packed, std::uint64_t& local) {
  constexpr std::uint16_t kZip64 = 1;
  while (extra.left() > 0 && extra.ok()) {
    const auto kind = extra.value<std::uint16_t>();
    ByteReader field(extra.take(extra.value<std::uint16_t>()));
    if (kind != kZip64) continue;
    for (std::uint64_t* const value : {&plain, &packed, &local}) {
      if (*value == kElsewhere) *value = field.value<std::uint64_t>();
    }
  }
}

// The member of the next entry of the directory; its name is empty if it cannot be read. Nullopt at the end.
std::optional<Member> nextMember(ByteReader& directory, const AnsweredFile& file) {
  if (directory.value<std::uint32_t>() != kCentral) return std::nullopt;
  static_cast<void>(directory.take(4));  // versions
  const auto flags = directory.value<std::uint16_t>(), method = directory.value<std::uint16_t>();
  static_cast<void>(directory.take(8));  // time and checksum
  std::uint64_t packed = directory.value<std::uint32_t>(), plain = directory.value<std::uint32_t>();
  const auto name_bytes = directory.value<std::uint16_t>(), extra_bytes = directory.value<std::uint16_t>(),
             comment_bytes = directory.value<std::uint16_t>();
  static_cast<void>(directory.take(8));  // disk, attributes
  std::uint64_t local = directory.value<std::uint32_t>();
  const auto name = directory.take(name_bytes);
  widen(ByteReader(directory.take(extra_bytes)), plain, packed, local);
  static_cast<void>(directory.take(comment_bytes));
  if (!directory.ok()) return std::nullopt;
  constexpr std::uint16_t kEncrypted = 1, kStored = 0, kDeflated = 8;
  const auto head = bytesAt(file, local, kLocalBytes);
  ByteReader fields(head);
  if (fields.value<std::uint32_t>() != kLocal || (flags & kEncrypted) != 0) return Member{};
  if (method != kStored && method != kDeflated) return Member{};
  static_cast<void>(fields.take(22));  // what the directory says as well
  const std::uint64_t before = fields.value<std::uint16_t>() + std::uint64_t{fields.value<std::uint16_t>()};
  const std::uint64_t begin = local + kLocalBytes + before, all = file.bytes().value_or(0);
  if (!fields.ok() || begin > all) return Member{};
  return Member{.name = std::string(name.begin(), name.end()),
                .begin = begin,
                .end = begin + std::min(packed, all - begin),
                .deflated = method == kDeflated};
}

}  // namespace

std::vector<Member> membersOf(const AnsweredFile& file) {
  const Directory place = directoryOf(file);
  const auto bytes = bytesAt(file, place.begin, std::min(place.bytes, kMostDirectory));
  ByteReader directory(bytes);
  std::vector<Member> members;
  for (std::size_t i = 0; i < kMostMembers; ++i) {
    auto member = nextMember(directory, file);
    if (!member) break;
    if (!member->name.empty()) members.push_back(std::move(*member));
  }
  return members;
}

MemberReader::MemberReader(AnsweredFile file, Member member) : file_(std::move(file)), member_(std::move(member)) {}

std::size_t MemberReader::read(std::uint64_t at, std::span<std::uint8_t> out) {
  if (!member_.deflated) {
    const std::uint64_t bytes = member_.end - member_.begin;
    if (at >= bytes) return 0;
    return file_.read(member_.begin + at, out.first(std::min<std::uint64_t>(out.size(), bytes - at))).value_or(0);
  }
  if (!inflater_ || at < position_) {
    inflater_.emplace(file_, member_.begin, member_.end);
    position_ = 0;
  }
  std::array<std::uint8_t, 4096> passed;
  while (position_ < at) {
    const auto room = std::span(passed).first(std::min<std::uint64_t>(passed.size(), at - position_));
    const std::size_t got = inflater_->read(room);
    position_ += got;
    if (got < room.size()) return 0;
  }
  const std::size_t got = inflater_->read(out);
  position_ += got;
  return got;
}

}  // namespace relievo::npz
