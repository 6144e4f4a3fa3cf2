// SPDX-License-Identifier: Apache-2.0
// Writes pictures to a YUV4MPEG2 file at a steady rate: raw 4:2:0 that every video tool reads.
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

// BT.709, limited range, chroma sited between the samples. YUV4MPEG2 can tell the range and the siting but not the
// matrix; BT.709 is what a reader takes for a picture of 720 lines or more.
class Y4mWriter {
 public:
  // Begins the file anew. `rate` in pictures per second.
  [[nodiscard]] static Result<Y4mWriter> create(const std::string& path, int width, int height, double rate);

  // width x height RGBA pixels of 8 bits, the bottom row first as GL reads them, shown from `time` on. The file's
  // pictures have no times of their own: where the next one was due half a period ago, the last one is repeated first,
  // and a picture that comes more than a period early is left out. Blocking: writes to the file.
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
  std::vector<std::uint8_t> picture_;  // Y, U, V one after the other
  MonotonicTime first_;
  std::uint64_t written_ = 0;
};

}  // namespace relievo
