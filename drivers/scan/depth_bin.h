// SPDX-License-Identifier: Apache-2.0
// The pictures of ScanNet++'s depth.bin: an iPhone's depth of 256 x 192 samples, in one of three codings.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/inflate/inflate.h"
#include "drivers/scan/scan_file.h"
#include "platform/error.h"
#include "platform/files/answered_file.h"

namespace relievo::scan {

// Each picture has a length of 32 bits before it and is packed by LZ4 (mm of 16 bits) or DEFLATE (m in floating point);
// older files are one DEFLATE stream of all pictures.
class DepthBin {
 public:
  static constexpr int kCols = 256, kRows = 192;

  // Reads the length of each picture, no picture but the first. Corrupt if it is none.
  [[nodiscard]] static Result<DepthBin> open(AnsweredFile file, const std::atomic<bool>& cancelled);

  // Nullopt for one stream, whose pictures nobody has counted.
  [[nodiscard]] std::optional<std::size_t> pictures() const noexcept;
  [[nodiscard]] bool cutOff() const noexcept { return cut_off_; }

  enum class Read : std::uint8_t { Picture, Damaged, End };
  // The picture after the last that was read, as mm of 16 bits, the lower byte first.
  [[nodiscard]] Read next(std::vector<std::uint8_t>& mm);
  // Goes to picture `number`, or to the end of one stream that has fewer; false if it was interrupted.
  bool goTo(std::size_t number, const std::atomic<bool>& cancelled);

 private:
  // A place in the one stream to go on from.
  struct Mark {
    std::size_t picture = 0;
    Inflater inflater;
  };
  explicit DepthBin(AnsweredFile file) : file_(std::move(file)) {}
  bool list(std::uint64_t end, const std::atomic<bool>& cancelled);
  void addMark();

  AnsweredFile file_;
  std::vector<Place> places_;
  std::vector<Mark> marks_;
  std::size_t marks_apart_ = 64;
  std::optional<Inflater> stream_;
  std::size_t next_ = 0;
  bool cut_off_ = false;
};

}  // namespace relievo::scan
