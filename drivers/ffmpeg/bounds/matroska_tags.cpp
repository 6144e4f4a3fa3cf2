// SPDX-License-Identifier: Apache-2.0
// Elements of RFC 8794 and RFC 9559: an id, a size, and as many bytes.
#include "drivers/ffmpeg/bounds/matroska_tags.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace relievo::ffmpeg {
namespace {

constexpr std::uint32_t kHeader = 0x1A45DFA3, kSegment = 0x18538067, kCluster = 0x1F43B675, kTags = 0x1254C367;
constexpr std::uint32_t kSeekHead = 0x114D9B74, kSeek = 0x4DBB, kSeekPosition = 0x53AC;
constexpr std::string_view kSimpleTag = "\x67\xC8";
constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr struct {
  std::uint32_t id;
  std::uint64_t most;  // bytes
  const char* why;
} kBounds[] = {{0x1043A770, kMostBytes, kTooLongChapters},
               {0x1654AE6B, 4 * kMostBytes, kTooManyTracks},
               {0x1C53BB6B, 24 * kMostBytes, kTooManyCues}};
constexpr int kMostElements = 1000;  // that are looked at; a film has about ten before its first cluster
constexpr std::uint64_t kFarthest = std::uint64_t{1} << 62;  // the kernel refuses to read beyond 2^63
constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

struct Element {
  std::uint32_t id = 0;
  std::uint64_t data = 0, bytes = 0;  // kUnknown: until an element that cannot be in it
};

class Counter {
 public:
  explicit Counter(const AnsweredFile& file) noexcept : file_(file) {}

  const char* find() {
    const auto header = elementAt(0);
    if (!header || header->id != kHeader) return nullptr;
    const auto segment = elementAt(header->data + header->bytes);
    if (!segment || segment->id != kSegment) return nullptr;
    segment_ = segment->data;
    for (std::uint64_t place = segment_; const auto element = elementAt(place);) {
      if (element->id == kCluster || element->bytes == kUnknown) break;
      note(*element);
      place = element->data + element->bytes;
    }
    for (std::size_t i = 0; i < sought_.size(); ++i) {
      const auto element = elementAt(sought_[i]);
      if (element && element->bytes != kUnknown) note(*element);
    }
    return tags_ > kMostTags ? kTooManyTags : too_long_;
  }

 private:
  // The mark that says how many bytes it has is part of an id, but not of a size.
  static std::uint64_t number(std::span<const std::uint8_t> bytes, bool marked) {
    const std::uint8_t below = static_cast<std::uint8_t>((1U << (8 - bytes.size())) - 1);
    std::uint64_t number = marked ? bytes[0] : bytes[0] & below;
    bool unknown = !marked && number == below;
    for (const std::uint8_t byte : bytes.subspan(1)) {
      number = number << 8 | byte;
      unknown = unknown && byte == 0xFF;
    }
    return unknown ? kUnknown : number;
  }

  std::optional<Element> elementAt(std::uint64_t place) {
    std::array<std::uint8_t, 12> head{};
    if (++looked_at_ > kMostElements || place > kFarthest || file_.read(place, head).value_or(0) < 2)
      return std::nullopt;
    const std::size_t id_bytes = static_cast<std::size_t>(std::countl_zero(head[0])) + 1;
    if (id_bytes > 4) return std::nullopt;
    const std::size_t size_bytes = static_cast<std::size_t>(std::countl_zero(head[id_bytes])) + 1;
    if (size_bytes > 8) return std::nullopt;
    const std::span bytes(head);
    return Element{.id = static_cast<std::uint32_t>(number(bytes.first(id_bytes), true)),
                   .data = place + id_bytes + size_bytes,
                   .bytes = number(bytes.subspan(id_bytes, size_bytes), false)};
  }

  void note(const Element& element) {
    for (const auto& bound : kBounds) {
      if (element.id == bound.id && element.bytes > bound.most) too_long_ = bound.why;
    }
    if (element.id == kTags) countTags(element);
    if (element.id == kSeekHead) followSeeks(element);
  }

  void countTags(const Element& tags) {
    // A seek head may point to what was met before the first cluster.
    if (std::ranges::find(counted_, tags.data) != counted_.end()) return;
    counted_.push_back(tags.data);
    std::vector<std::uint8_t> bytes(std::min<std::size_t>(tags.bytes, kMostBytes + 1));
    bytes.resize(file_.read(tags.data, bytes).value_or(0));
    if (bytes.size() > kMostBytes) too_long_ = kTooLongTags;
    for (auto at = bytes.begin(); tags_ <= kMostTags; ++tags_, ++at) {
      at = std::search(at, bytes.end(), kSimpleTag.begin(), kSimpleTag.end(),
                       [](std::uint8_t byte, char sought) { return byte == static_cast<std::uint8_t>(sought); });
      if (at == bytes.end()) break;
    }
  }

  void followSeeks(const Element& head) {
    const std::uint64_t end = head.data + head.bytes;
    for (std::uint64_t place = head.data; place < end;) {
      const auto element = elementAt(place);
      if (!element || element->bytes == kUnknown) return;
      std::array<std::uint8_t, 8> position{};
      if (element->id == kSeekPosition && element->bytes <= position.size()) {
        const std::span used = std::span(position).first(static_cast<std::size_t>(element->bytes));
        if (file_.read(element->data, used).value_or(0) != used.size()) return;
        std::uint64_t to = 0;
        for (const std::uint8_t byte : used) to = to << 8 | byte;
        if (std::ranges::find(sought_, segment_ + to) == sought_.end()) sought_.push_back(segment_ + to);
      }
      place = element->data + (element->id == kSeek ? 0 : element->bytes);  // what is in a seek comes next
    }
  }

  const AnsweredFile& file_;
  std::uint64_t segment_ = 0;
  std::vector<std::uint64_t> sought_, counted_;
  int looked_at_ = 0, tags_ = 0;
  const char* too_long_ = nullptr;
};

}  // namespace

const char* tooManyTags(const AnsweredFile& file) {
  return Counter(file).find();
}

}  // namespace relievo::ffmpeg
