// SPDX-License-Identifier: Apache-2.0
// Where the pictures of a scan lie in its file.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/error.h"
#include "platform/files/answered_file.h"

namespace relievo::scan {

inline constexpr std::uint32_t kMostPicture = 1u << 26;  // bytes

enum class Coding : std::uint8_t { Raw, Deflated, Jpeg, Png };

struct Place {
  std::uint64_t begin = 0;
  std::uint32_t bytes = 0;  // at most kMostPicture; 0: none
};
struct ScanFrame {
  std::uint64_t time_us = 0;
  Place color, depth;
};
struct Scan {
  Coding color = Coding::Jpeg, depth = Coding::Deflated;
  std::uint32_t color_cols = 0, color_rows = 0, depth_cols = 0, depth_rows = 0;
  double codes_per_metre = 1000;
  std::vector<ScanFrame> frames;
  bool cut_off = false;
};

// Reads .sens, version 4, and .klg. Corrupt if the file is none, or has no whole frame; Unsupported for depth in a
// coding that is not read.
[[nodiscard]] Result<Scan> readSens(const AnsweredFile& file, const std::atomic<bool>& cancelled);
[[nodiscard]] Result<Scan> readKlg(const AnsweredFile& file, const std::atomic<bool>& cancelled);

}  // namespace relievo::scan
