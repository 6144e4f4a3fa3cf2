// SPDX-License-Identifier: Apache-2.0
// The nearest heights of a depth picture, block by block: shows in advance what will be behind the subtitles.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "app/scene/height_field.h"

namespace relievo {

class CoarseRelief {
 public:
  static constexpr int kAcross = 64, kDown = 36;
  struct Block {
    float left = 0, bottom = 0, right = 0, top = 0;  // scene frame, mm
    float height_mm = 0;                             // of the nearest sample that was read
  };

  // Reads at most 4 x 4 samples of each block, whatever the size of the picture.
  [[nodiscard]] static CoarseRelief of(const HeightField& field);

  // The blocks that have a height.
  [[nodiscard]] std::span<const Block> blocks() const noexcept { return blocks_; }

 private:
  std::vector<Block> blocks_;
};

// The coming pictures of the present shot.
struct ReliefAhead {
  struct Coming {
    int pictures = 1;  // distance from the present picture
    const CoarseRelief* relief = nullptr;
  };
  static constexpr std::size_t kMost = 8;
  std::array<Coming, kMost> coming{};  // ascending
  std::size_t count = 0;
  bool more = true;  // further pictures of the shot follow that are not known yet

  [[nodiscard]] std::span<const Coming> known() const noexcept { return std::span(coming).first(count); }
};

}  // namespace relievo
