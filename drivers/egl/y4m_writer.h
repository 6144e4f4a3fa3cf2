// SPDX-License-Identifier: Apache-2.0
// Writes pictures to a YUV4MPEG2 file: raw 4:2:0 that every video tool reads.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "platform/error.h"

namespace relievo {

// BT.709, limited range, chroma sited between the samples. YUV4MPEG2 can tell the range and the siting but not the
// matrix; BT.709 is what a reader takes for a picture of 720 lines or more.
class Y4mWriter {
 public:
  // Begins the file anew. `rate` in pictures per second.
  [[nodiscard]] static Result<Y4mWriter> create(const std::string& path, int width, int height, double rate);

  // width x height RGBA pixels of 8 bits, the bottom row first as GL reads them. Blocking: writes to the file.
  [[nodiscard]] Result<void> write(std::span<const std::uint8_t> rgba);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  Y4mWriter(std::FILE* file, int width, int height);

  std::unique_ptr<std::FILE, Close> file_;
  int width_;
  int height_;
  std::vector<std::uint8_t> picture_;  // Y, U, V one after the other
};

}  // namespace relievo
