// SPDX-License-Identifier: Apache-2.0
// The pages of a TIFF file, each as a TIFF file of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "platform/error.h"
#include "platform/files/answered_file.h"

namespace relievo::tiff {

// TIFF 6.0, section 2. At most 65,536 pages; what is read of one is bounded by the file's size.
class Pages {
 public:
  // Nullopt unless the file is a TIFF in 32 bits (no BigTIFF) whose first page can be read.
  [[nodiscard]] static std::optional<Pages> of(const AnsweredFile& file);

  // Pages of the first one's size and type of numbers; smaller copies and others are left out.
  [[nodiscard]] std::size_t count() const noexcept { return directories_.size(); }
  [[nodiscard]] std::size_t leftOut() const noexcept { return left_out_; }

  // A file that holds the page alone. Corrupt if the page is damaged or cut off; else as the file.
  [[nodiscard]] Result<std::vector<std::uint8_t>> page(const AnsweredFile& file, std::size_t index) const;

 private:
  bool swapped_ = false;
  std::vector<std::uint32_t> directories_;  // offsets in the file
  std::size_t left_out_ = 0;
};

}  // namespace relievo::tiff
