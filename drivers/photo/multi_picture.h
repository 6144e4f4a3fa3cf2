// SPDX-License-Identifier: Apache-2.0
// The index of a JPEG file of several pictures (CIPA DC-007-2009, 5.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace relievo::photo {

// The numbers of a TIFF structure, in its byte order; 0 beyond its end.
struct Numbers {
  std::string_view bytes;
  bool high_first = false;

  [[nodiscard]] std::size_t at(std::size_t place, std::size_t size) const noexcept;
};

// One of the pictures that the index lists, which is within the file.
struct ListedPicture {
  std::size_t type = 0;
  std::span<const std::uint8_t> coded;
};
inline constexpr std::size_t kViewType = 0x020002;  // "disparity": one of two views

// In order, the file's own picture first; none if there is no index. At most 64.
[[nodiscard]] std::vector<ListedPicture> picturesIn(std::span<const std::uint8_t> jpeg);

}  // namespace relievo::photo
