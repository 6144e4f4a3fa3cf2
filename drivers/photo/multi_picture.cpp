// SPDX-License-Identifier: Apache-2.0
#include "drivers/photo/multi_picture.h"

#include <algorithm>

#include "drivers/photo/jpeg_xmp.h"

namespace relievo::photo {
namespace {

constexpr std::uint8_t kApp2 = 0xe2;
constexpr std::string_view kName("MPF\0", 4);

std::vector<ListedPicture> picturesOf(const Numbers& index, std::size_t index_begin,
                                      std::span<const std::uint8_t> jpeg) {
  constexpr std::size_t kEntries = 0xb002, kEntryBytes = 16, kMostPictures = 64;
  std::vector<ListedPicture> pictures;
  const std::size_t directory = index.at(4, 4), fields = index.at(directory, 2);
  for (std::size_t i = 0; i < fields && i < kMostPictures; ++i) {
    const std::size_t field = directory + 2 + 12 * i;
    if (index.at(field, 2) != kEntries) continue;
    const std::size_t count = std::min(index.at(field + 4, 4) / kEntryBytes, kMostPictures),
                      at = index.at(field + 8, 4);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t entry = at + kEntryBytes * k;
      const std::size_t offset = index.at(entry + 8, 4);  // from the index; 0 for the file's first picture
      const std::size_t begin = offset == 0 ? 0 : index_begin + offset, length = index.at(entry + 4, 4);
      if (begin > jpeg.size() || length > jpeg.size() - begin) continue;
      pictures.push_back({index.at(entry, 4) & 0xffffff, jpeg.subspan(begin, length)});
    }
    break;
  }
  return pictures;
}

}  // namespace

std::size_t Numbers::at(std::size_t place, std::size_t size) const noexcept {
  std::size_t value = 0;
  if (place > bytes.size() || size > bytes.size() - place) return 0;
  for (std::size_t i = 0; i < size; ++i) {
    value = value << 8 | static_cast<std::uint8_t>(bytes[high_first ? place + i : place + size - 1 - i]);
  }
  return value;
}

std::vector<ListedPicture> picturesIn(std::span<const std::uint8_t> jpeg) {
  for (const std::string_view segment : segmentsOf(jpeg, kApp2)) {
    if (!segment.starts_with(kName)) continue;
    const std::string_view bytes = segment.substr(kName.size());
    const auto begin = static_cast<std::size_t>(bytes.data() - reinterpret_cast<const char*>(jpeg.data()));
    return picturesOf({bytes, bytes.starts_with("MM")}, begin, jpeg);
  }
  return {};
}

}  // namespace relievo::photo
