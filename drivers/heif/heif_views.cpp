// SPDX-License-Identifier: Apache-2.0
// Finds the stereo pair in a HEIF file's groups of entities (ISO/IEC 14496-12, 8.15.3: grpl), which libheif does not
// report.
#include <algorithm>
#include <string_view>

#include "drivers/heif/heif_handle.h"

namespace relievo::heif {
namespace {

constexpr std::size_t kVersionAndFlags = 4;

std::size_t number32(std::string_view bytes, std::size_t at) noexcept {
  std::size_t value = 0;
  if (bytes.size() < 4 || at > bytes.size() - 4) return 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

// The content of the first box of this type; empty if there is none, or if a box before it is damaged.
std::string_view contentOf(std::string_view boxes, std::string_view type) noexcept {
  constexpr std::size_t kHeader = 8, kLongHeader = 16;
  while (boxes.size() >= kHeader) {
    std::uint64_t announced = number32(boxes, 0);
    std::size_t header = kHeader;
    if (announced == 1) {
      announced = std::uint64_t{number32(boxes, 8)} << 32 | number32(boxes, 12);
      header = kLongHeader;
    }
    if (announced == 0) announced = boxes.size();
    if (announced < header || announced > boxes.size()) return {};
    const auto size = static_cast<std::size_t>(announced);
    if (boxes.substr(4, 4) == type) return boxes.substr(header, size - header);
    boxes.remove_prefix(size);
  }
  return {};
}

std::string_view after(std::string_view text, std::size_t bytes) noexcept {
  return text.substr(std::min(bytes, text.size()));
}

}  // namespace

// The first entity is the left view.
std::optional<StereoPair> stereoPairIn(std::span<const std::uint8_t> file) {
  const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
  const std::string_view meta = after(contentOf(bytes, "meta"), kVersionAndFlags);
  const std::string_view group = after(contentOf(contentOf(meta, "grpl"), "ster"), kVersionAndFlags);
  constexpr std::size_t kCount = 4, kIds = 8;  // behind the group's number
  if (group.size() < kIds + 8 || number32(group, kCount) != 2) return std::nullopt;
  return StereoPair{static_cast<heif_item_id>(number32(group, kIds)),
                    static_cast<heif_item_id>(number32(group, kIds + 4))};
}

}  // namespace relievo::heif
