// SPDX-License-Identifier: Apache-2.0
#include "tests/support/film/real_depth.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/support/film/depth_frames.h"

namespace relievo::test {

// The file is a TIFF of floats, uncompressed, whose rows lie one after the other up to its end.
std::optional<Disparity> readCones(const std::string& data_folder) {
  constexpr std::uintmax_t kBytes = std::uintmax_t{Disparity::kCols} * Disparity::kRows * sizeof(float);
  const std::string path = data_folder + "/cones/disp_left.tif";
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size < kBytes) return std::nullopt;
  Disparity disparity;
  disparity.pixels.resize(kBytes / sizeof(float));
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(size - kBytes));
  if (!file.read(reinterpret_cast<char*>(disparity.pixels.data()), kBytes)) return std::nullopt;
  return disparity;
}

Frame depthOf(const Disparity& disparity) {
  return makeGrayFrame(Disparity::kCols, Disparity::kRows, 16, MediaTime{}, [&](int c, int r) {
    return static_cast<std::uint32_t>(std::clamp(disparity.at(c, r) / Disparity::kMost, 0.0F, 1.0F) * 65535.0F + 0.5F);
  });
}

}  // namespace relievo::test
