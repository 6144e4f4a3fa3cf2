// SPDX-License-Identifier: Apache-2.0
// Elements of RFC 8794 and RFC 9559: an id, a size, and as many bytes.
#include "drivers/ffmpeg/bounds/matroska_bounds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace relievo::ffmpeg {
namespace {

constexpr std::uint32_t kHeader = 0x1A45DFA3, kSegment = 0x18538067, kCluster = 0x1F43B675, kTags = 0x1254C367;
constexpr std::uint32_t kSeekHead = 0x114D9B74, kSeek = 0x4DBB, kSeekId = 0x53AB, kSeekPosition = 0x53AC;
constexpr std::uint32_t kInfo = 0x1549A966, kTracks = 0x1654AE6B, kAttachments = 0x1941A469, kChapters = 0x1043A770,
                        kCues = 0x1C53BB6B, kCuePoint = 0xBB, kCuePosition = 0xB7;
constexpr std::string_view kSimpleTag = "\x67\xC8";
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr int kMostElements = 1000;                          // in all, that are looked at; of a list, too
constexpr std::size_t kMostSought = 64;                      // places; FFmpeg follows no more
constexpr std::size_t kLongestHead = 12;                     // bytes: an id and a size
constexpr std::uint64_t kFarthest = std::uint64_t{1} << 62;  // the kernel refuses to read beyond 2^63
constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

// All elements of a kind together.
struct Kind {
  std::uint32_t id;
  std::uint64_t most;  // bytes
  const char* why;
  bool listed = false;  // what is in them is counted
  std::uint64_t bytes = 0;
};

struct Element {
  std::uint32_t id = 0;
  std::uint64_t data = 0, bytes = 0;  // kUnknown: until an element that cannot be in it
};

// The mark that says how many bytes it has is part of an id, but not of a size.
std::uint64_t number(std::span<const std::uint8_t> bytes, bool marked) {
  const std::uint8_t below = static_cast<std::uint8_t>((1U << (8 - bytes.size())) - 1);
  std::uint64_t number = marked ? bytes[0] : bytes[0] & below;
  bool unknown = !marked && number == below;
  for (const std::uint8_t byte : bytes.subspan(1)) {
    number = number << 8 | byte;
    unknown = unknown && byte == 0xFF;
  }
  return unknown ? kUnknown : number;
}

std::optional<Element> elementAt(const Readable& file, std::uint64_t place) {
  std::array<std::uint8_t, kLongestHead> head{};
  if (place > kFarthest || file(place, head) < 2) return std::nullopt;
  const std::size_t id_bytes = static_cast<std::size_t>(std::countl_zero(head[0])) + 1;
  if (id_bytes > 4) return std::nullopt;
  const std::size_t size_bytes = static_cast<std::size_t>(std::countl_zero(head[id_bytes])) + 1;
  if (size_bytes > 8) return std::nullopt;
  const std::span bytes(head);
  return Element{.id = static_cast<std::uint32_t>(number(bytes.first(id_bytes), true)),
                 .data = place + id_bytes + size_bytes,
                 .bytes = number(bytes.subspan(id_bytes, size_bytes), false)};
}

class Lists {
 public:
  explicit Lists(const Readable& file) noexcept : file_(file) {}

  const char* exceeded() {
    const auto header = elementAt(file_, 0);
    if (!header || header->id != kHeader) return nullptr;
    for (auto element = elementFrom(behind(*header)); element; element = next(*element)) note(*element);
    for (std::size_t i = 0; i < sought_.size(); ++i) {
      for (auto element = elementAt(file_, sought_[i]); element; element = next(*element)) {
        note(*element);
        if (element->bytes != kUnknown && !damage_) break;
      }
    }
    return exceeded_;
  }

 private:
  // What is in the segment, or in an element without a size, stands behind it.
  static std::uint64_t behind(const Element& element) noexcept {
    const bool within = element.id == kSegment || element.bytes == kUnknown;
    return element.data + (within ? 0 : element.bytes);
  }

  // None at the first cluster.
  std::optional<Element> next(const Element& element) {
    if (exceeded_ != nullptr || element.id == kCluster) return std::nullopt;
    return elementFrom(std::exchange(damage_, std::nullopt).value_or(behind(element)));
  }

  // As FFmpeg goes on: behind what is no element, with the next list or cluster, even if the segment has not begun.
  std::optional<Element> elementFrom(std::uint64_t place) const {
    if (const auto element = elementAt(file_, place)) return element;
    constexpr std::size_t kIdBytes = 4;
    std::vector<std::uint8_t> piece(std::size_t{1} << 16);
    for (std::size_t got = piece.size(); got == piece.size(); place += got - (kIdBytes - 1)) {
      got = place > kFarthest ? 0 : file_(place, piece);
      for (std::size_t i = 0; i + kIdBytes <= got; ++i) {
        if (piece[i] >> 4 != 1) continue;  // not an id of four bytes
        const auto id = static_cast<std::uint32_t>(number(std::span(piece).subspan(i, kIdBytes), true));
        if (id == kCluster || std::ranges::find(kinds_, id, &Kind::id) != std::end(kinds_)) {
          return elementAt(file_, place + i);
        }
      }
    }
    return std::nullopt;
  }

  void exceed(const char* why) noexcept {
    if (exceeded_ == nullptr) exceeded_ = why;
  }

  void note(const Element& element) {
    if (element.id == kCluster) return;
    if (++looked_at_ > kMostElements) return exceed(kTooManyElements);
    if (element.id == kSegment) return void(segment_ = element.data);
    const auto kind = std::ranges::find(kinds_, element.id, &Kind::id);
    if (element.bytes == kUnknown) {
      sizeless_ = true;
    } else if (kind != std::end(kinds_)) {
      measure(*kind, element);
    } else if (sizeless_) {
      measure(loose_, element);
    }
  }

  void measure(Kind& kind, const Element& element) {
    // A seek head may point to what was met before the first cluster.
    if (std::ranges::find(measured_, element.data) != measured_.end()) return;
    measured_.push_back(element.data);
    kind.bytes += std::min(element.bytes, kFarthest);
    if (kind.bytes > kind.most) return exceed(kind.why);
    if (kind.listed) countItems(kind, element);
    if (kind.id == kCues) countCues(element);
    if (kind.id == kTags || &kind == &loose_) countTags(element);
    if (kind.id == kSeekHead) followSeeks(element);
  }

  void countItems(const Kind& kind, const Element& list) {
    const std::uint64_t end = list.data + list.bytes;
    std::uint64_t place = list.data;
    for (int items = 0; place < end; ++items) {
      if (items == kMostElements) return exceed(kind.why);
      const auto item = elementAt(file_, place);
      if (!item) return void(damage_ = place);
      place = behind(*item);
    }
  }

  // FFmpeg keeps each point and each position in it, also those that hold nothing.
  void countCues(const Element& cues) {
    const auto bytes = contentOf(cues);
    const Readable content = readable(std::span(bytes));
    for (std::uint64_t place = 0; place < bytes.size();) {
      const auto item = elementAt(content, place);
      const bool is_point = item && item->id == kCuePoint;
      if (!item || (item->bytes == kUnknown && !is_point)) return void(damage_ = cues.data + place);
      if ((is_point || item->id == kCuePosition) && ++cues_ > kMostCues) return exceed(kTooManyCues);
      place = item->data + (is_point ? 0 : item->bytes);  // what is in a point comes next
    }
  }

  std::vector<std::uint8_t> contentOf(const Element& element) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(element.bytes));  // its kind's most
    bytes.resize(file_(element.data, bytes));
    return bytes;
  }

  void countTags(const Element& tags) {
    const auto bytes = contentOf(tags);
    for (auto at = bytes.begin(); tags_ <= kMostTags; ++tags_, ++at) {
      at = std::search(at, bytes.end(), kSimpleTag.begin(), kSimpleTag.end(),
                       [](std::uint8_t byte, char sought) { return byte == static_cast<std::uint8_t>(sought); });
      if (at == bytes.end()) return;
    }
    exceed(kTooManyTags);
  }

  void followSeeks(const Element& head) {
    const auto bytes = contentOf(head);
    const Readable content = readable(std::span(bytes));
    std::optional<std::uint64_t> id, position;
    const auto follow = [&] {
      if (position && id != kCluster) seek(segment_ + *position);  // FFmpeg follows none to clusters
      id.reset();
      position.reset();
    };
    for (std::uint64_t place = 0; const auto element = elementAt(content, place);) {
      if (element->bytes == kUnknown || exceeded_ != nullptr) break;
      if (element->id == kSeek) follow();
      if (element->id == kSeekId) id = valueOf(*element, content);
      if (element->id == kSeekPosition) position = valueOf(*element, content);
      place = element->data + (element->id == kSeek ? 0 : element->bytes);  // what is in a seek comes next
    }
    follow();
  }

  static std::uint64_t valueOf(const Element& element, const Readable& content) {
    std::array<std::uint8_t, 8> bytes{};
    if (element.bytes > bytes.size()) return 0;
    const std::size_t read = content(element.data, std::span(bytes).first(static_cast<std::size_t>(element.bytes)));
    std::uint64_t value = 0;
    for (const std::uint8_t byte : std::span(bytes).first(read)) value = value << 8 | byte;
    return value;
  }

  void seek(std::uint64_t place) {
    if (std::ranges::find(sought_, place) != sought_.end()) return;
    if (sought_.size() == kMostSought) return exceed(kTooManyElements);
    sought_.push_back(place);
  }

  const Readable& file_;
  Kind kinds_[7] = {{kTags, kMiB, kTooLongTags},         {kInfo, kMiB, kTooManyElements},
                    {kChapters, kMiB, kTooLongChapters}, {kTracks, 4 * kMiB, kTooManyTracks, true},
                    {kCues, 24 * kMiB, kTooManyCues},    {kAttachments, 128 * kMiB, kTooManyAttachments, true},
                    {kSeekHead, kMiB, kTooManyElements}};
  Kind loose_{0, 4 * kMiB, kTooManyElements};  // what is in elements without a size
  bool sizeless_ = false;                      // there was such an element
  std::optional<std::uint64_t> damage_;        // the place in a list where it is not one
  std::uint64_t segment_ = 0;                  // as FFmpeg takes it if damage hides where it begins
  std::vector<std::uint64_t> sought_, measured_;
  int looked_at_ = 0, tags_ = 0, cues_ = 0;
  const char* exceeded_ = nullptr;
};

}  // namespace

const char* exceededMatroskaBound(const Readable& file) {
  return Lists(file).exceeded();
}

}  // namespace relievo::ffmpeg
