// SPDX-License-Identifier: Apache-2.0
// Writes pictures to a YUV4MPEG2 file at a constant rate: raw 4:2:0 that every video tool can read.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// BT.709, limited range, chroma sited between the samples. YUV4MPEG2 stores the range and the siting but not the
// matrix; readers assume BT.709 for pictures of 720 lines or more.
class Y4mWriter {
 public:
  // Truncates the file. `rate`: pictures per second.
  [[nodiscard]] static Result<Y4mWriter> create(const std::string& path, int width, int height, double rate);

  // `rgba`: width x height pixels of 8 bits per channel, the bottom row first as GL reads them, shown from `time` on.
  // To keep the file's rate, the last picture is repeated if this one is over half a period late, and this one is
  // dropped if it is over a period early. Blocking: writes to the file.
  [[nodiscard]] Result<void> write(std::span<const std::uint8_t> rgba, MonotonicTime time);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  Y4mWriter(std::FILE* file, int width, int height, double rate);
  void convert(std::span<const std::uint8_t> rgba) noexcept;
  [[nodiscard]] Result<void> append();

  std::unique_ptr<std::FILE, Close> file_;
  int width_;
  int height_;
  double rate_;
  std::vector<std::uint8_t> picture_;  // planes Y, U, V
  MonotonicTime first_;
  std::uint64_t written_ = 0;
};

}  // namespace relievo
