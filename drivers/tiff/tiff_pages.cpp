// SPDX-License-Identifier: Apache-2.0
#include "drivers/tiff/tiff_pages.h"

#include <algorithm>
#include <cstring>
#include <set>

namespace relievo::tiff {
namespace {

constexpr std::size_t kHeaderBytes = 8, kEntryBytes = 12, kMostEntries = 1024, kMostPages = 1 << 16;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 29;  // of a page
constexpr std::uint16_t kReduced = 254, kStrips = 273, kStripBytes = 279, kTiles = 324, kTileBytes = 325;
constexpr std::uint16_t kShort = 3, kLong = 4;
constexpr std::array<std::uint16_t, 6> kShape{256, 257, 258, 262, 277, 339};
constexpr std::array<std::uint16_t, 3> kDirectories{330, 34665,
                                                    34853};  // they lie elsewhere, and no picture needs them

using Bytes = std::vector<std::uint8_t>;

struct Entry {
  std::uint16_t tag = 0, type = 0;
  std::uint32_t count = 0;
  std::array<std::uint8_t, 4> value{};  // or the value's offset in the file
};

// Numbers of a file, which may have its high bytes first.
struct Order {
  bool swapped = false;
  [[nodiscard]] std::uint16_t number16(const std::uint8_t* at) const noexcept {
    std::uint16_t value;
    std::memcpy(&value, at, sizeof value);
    return swapped ? __builtin_bswap16(value) : value;
  }
  [[nodiscard]] std::uint32_t number32(const std::uint8_t* at) const noexcept {
    std::uint32_t value;
    std::memcpy(&value, at, sizeof value);
    return swapped ? __builtin_bswap32(value) : value;
  }
  void append16(Bytes& to, std::uint16_t value) const {
    if (swapped) value = __builtin_bswap16(value);
    to.insert(to.end(), reinterpret_cast<std::uint8_t*>(&value), reinterpret_cast<std::uint8_t*>(&value) + 2);
  }
  void put32(std::uint8_t* to, std::uint32_t value) const noexcept {
    if (swapped) value = __builtin_bswap32(value);
    std::memcpy(to, &value, sizeof value);
  }
};

struct Directory {
  std::vector<Entry> entries;
  std::uint32_t next = 0;
  [[nodiscard]] const Entry* find(std::uint16_t tag) const noexcept {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.tag == tag; });
    return found == entries.end() ? nullptr : &*found;
  }
};

std::optional<Bytes> read(const AnsweredFile& file, std::uint64_t offset, std::uint64_t count) {
  constexpr std::uint64_t kUnasked = 1 << 16;  // more than a directory: so much is allocated before the size is known
  if (count > kMostBytes) return std::nullopt;
  if (count > kUnasked) {
    const std::uint64_t whole = file.bytes().value_or(0);
    if (offset > whole || count > whole - offset) return std::nullopt;
  }
  Bytes bytes(static_cast<std::size_t>(count));
  return file.read(offset, bytes).value_or(0) == bytes.size() ? std::optional(std::move(bytes)) : std::nullopt;
}

std::optional<Directory> readDirectory(const AnsweredFile& file, std::uint32_t offset, const Order& order) {
  const auto begin = read(file, offset, 2);
  const std::size_t count = begin ? order.number16(begin->data()) : 0;
  if (count == 0 || count > kMostEntries) return std::nullopt;
  const auto bytes = read(file, std::uint64_t{offset} + 2, count * kEntryBytes + 4);
  if (!bytes) return std::nullopt;
  Directory directory;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* const at = &(*bytes)[i * kEntryBytes];
    Entry entry{order.number16(at), order.number16(at + 2), order.number32(at + 4), {}};
    std::copy_n(at + 8, entry.value.size(), entry.value.begin());
    if (std::ranges::find(kDirectories, entry.tag) == kDirectories.end()) directory.entries.push_back(entry);
  }
  directory.next = order.number32(&(*bytes)[count * kEntryBytes]);
  return directory;
}

std::uint64_t bytesOf(const Entry& entry) noexcept {
  constexpr std::array<std::uint8_t, 14> kBytes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};
  return std::uint64_t{entry.count} * (entry.type < kBytes.size() ? kBytes[entry.type] : 0);
}

std::optional<Bytes> valueOf(const AnsweredFile& file, const Entry& entry, const Order& order) {
  const std::uint64_t bytes = bytesOf(entry);
  if (bytes > entry.value.size()) return read(file, order.number32(entry.value.data()), bytes);
  return Bytes(entry.value.begin(), entry.value.begin() + static_cast<std::ptrdiff_t>(bytes));
}

// Nullopt for other types than whole numbers.
std::optional<std::vector<std::uint32_t>> numbersOf(const AnsweredFile& file, const Entry* entry, const Order& order) {
  if (entry == nullptr || (entry->type != kShort && entry->type != kLong)) return std::nullopt;
  const auto bytes = valueOf(file, *entry, order);
  if (!bytes) return std::nullopt;
  std::vector<std::uint32_t> numbers;
  const std::size_t step = entry->type == kShort ? 2 : 4;
  for (std::size_t at = 0; at < bytes->size(); at += step) {
    numbers.push_back(step == 2 ? order.number16(&(*bytes)[at]) : order.number32(&(*bytes)[at]));
  }
  return numbers;
}

bool isReduced(const Directory& directory, const Order& order) noexcept {
  const Entry* const kind = directory.find(kReduced);
  return kind != nullptr && (order.number32(kind->value.data()) & 1) != 0;
}

bool areAlike(const Directory& a, const Directory& b, const Order& order) noexcept {
  return isReduced(a, order) == isReduced(b, order) && std::ranges::all_of(kShape, [&](std::uint16_t tag) {
           const Entry *const of_a = a.find(tag), *const of_b = b.find(tag);
           if (of_a == nullptr || of_b == nullptr) return of_a == of_b;
           const bool here = bytesOf(*of_a) <= of_a->value.size();
           return of_a->count == of_b->count && (!here || of_a->value == of_b->value);
         });
}

// Appends the picture's pieces to `page`; returns the offset of each there.
std::optional<std::vector<std::uint32_t>> appendPieces(const AnsweredFile& file, const std::vector<std::uint32_t>& at,
                                                       const std::vector<std::uint32_t>& bytes, Bytes& page) {
  if (at.size() != bytes.size()) return std::nullopt;
  std::vector<std::uint32_t> places;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto piece = read(file, at[i], bytes[i]);
    if (!piece || page.size() + piece->size() > kMostBytes) return std::nullopt;
    places.push_back(static_cast<std::uint32_t>(page.size()));
    page.insert(page.end(), piece->begin(), piece->end());
  }
  return places;
}

// The value that the entry has in a file of this page alone.
std::optional<Bytes> newValueOf(const AnsweredFile& file, const Directory& directory, Entry& entry, const Order& order,
                                Bytes& page) {
  if (entry.tag != kStrips && entry.tag != kTiles) return valueOf(file, entry, order);
  const auto at = numbersOf(file, &entry, order);
  const auto bytes = numbersOf(file, directory.find(entry.tag == kStrips ? kStripBytes : kTileBytes), order);
  const auto places = at && bytes ? appendPieces(file, *at, *bytes, page) : std::nullopt;
  if (!places) return std::nullopt;
  entry.type = kLong;
  Bytes value(4 * places->size());
  for (std::size_t i = 0; i < places->size(); ++i) order.put32(&value[4 * i], (*places)[i]);
  return value;
}

}  // namespace

std::optional<Pages> Pages::of(const AnsweredFile& file) {
  const auto header = read(file, 0, kHeaderBytes);
  if (!header) return std::nullopt;
  const bool big = std::memcmp(header->data(), "MM\0*", 4) == 0;
  if (!big && std::memcmp(header->data(), "II*\0", 4) != 0) return std::nullopt;
  const Order order{big};
  std::uint32_t offset = order.number32(&(*header)[4]);
  const auto first = readDirectory(file, offset, order);
  if (!first) return std::nullopt;
  Pages pages;
  pages.swapped_ = big;
  std::set<std::uint32_t> seen;
  for (auto directory = first; directory && seen.insert(offset).second && seen.size() < kMostPages;) {
    if (areAlike(*first, *directory, order)) pages.directories_.push_back(offset);
    else ++pages.left_out_;
    offset = directory->next;
    directory = offset != 0 ? readDirectory(file, offset, order) : std::nullopt;
  }
  return pages;
}

Result<std::vector<std::uint8_t>> Pages::page(const AnsweredFile& file, std::size_t index) const {
  const Order order{swapped_};
  const auto damaged = [] { return fail(ErrorCode::Corrupt, "a page of it is damaged"); };
  auto directory = readDirectory(file, directories_[index], order);
  if (!directory) return damaged();
  Bytes page(kHeaderBytes);
  std::memcpy(page.data(), swapped_ ? "MM\0*" : "II*\0", 4);
  order.put32(&page[4], kHeaderBytes);
  order.append16(page, static_cast<std::uint16_t>(directory->entries.size()));
  const std::size_t entries = page.size();
  page.resize(entries + directory->entries.size() * kEntryBytes + 4);
  for (std::size_t i = 0; i < directory->entries.size(); ++i) {
    Entry entry = directory->entries[i];
    const auto value = newValueOf(file, *directory, entry, order, page);
    if (!value) return damaged();
    Bytes head;
    order.append16(head, entry.tag);
    order.append16(head, entry.type);
    head.resize(kEntryBytes);
    order.put32(&head[4], entry.count);
    if (value->size() > entry.value.size()) {
      if (page.size() + value->size() > kMostBytes) return damaged();  // many entries may give the same bytes
      page.resize(page.size() + page.size() % 2);
      order.put32(&head[8], static_cast<std::uint32_t>(page.size()));
      page.insert(page.end(), value->begin(), value->end());
    } else {
      std::ranges::copy(*value, head.begin() + 8);
    }
    std::ranges::copy(head, page.begin() + static_cast<std::ptrdiff_t>(entries + i * kEntryBytes));
  }
  return page;
}

}  // namespace relievo::tiff
