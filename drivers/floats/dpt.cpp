// SPDX-License-Identifier: Apache-2.0
// Reads .dpt, the depth of MPI Sintel: "PIEH", width and height in 32 bits, then 32-bit floats, rows from the top; all
// of it low bytes first.
#include <cstring>

#include "drivers/floats/floats.h"
#include "platform/files/answered_file.h"

namespace relievo {
namespace {

constexpr std::size_t kHeaderBytes = 12;

struct Size {
  std::uint32_t width = 0, height = 0;
};

std::optional<Size> sizeIn(std::span<const std::uint8_t> file) noexcept {
  if (file.size() < kHeaderBytes || std::memcmp(file.data(), "PIEH", 4) != 0) return std::nullopt;
  Size size;
  std::memcpy(&size.width, &file[4], sizeof size.width);
  std::memcpy(&size.height, &file[8], sizeof size.height);
  return isSoundSize(size.width, size.height) ? std::optional(size) : std::nullopt;
}

std::optional<FilePicture> readDpt(std::span<const std::uint8_t> file) {
  const auto size = sizeIn(file);
  if (!size) return std::nullopt;
  const std::size_t samples = std::size_t{size->width} * size->height;
  // Twice as many numbers are optical flow, which begins alike.
  if (file.size() != kHeaderBytes + samples * sizeof(float)) return std::nullopt;
  FilePicture picture{.width = static_cast<int>(size->width), .height = static_cast<int>(size->height)};
  picture.samples.resize(samples);
  std::memcpy(picture.samples.data(), &file[kHeaderBytes], samples * sizeof(float));
  return picture;
}

}  // namespace

const PictureFormat kDpt{"dpt", readDpt};

std::optional<StreamInfo> describeDpt(const std::string& path) {
  const auto file = AnsweredFile::open(path);
  if (!file) return std::nullopt;
  std::vector<std::uint8_t> begin(kHeaderBytes);
  begin.resize(file->read(0, begin).value_or(0));
  const auto size = sizeIn(begin);
  if (!size) return std::nullopt;
  StreamInfo stream{.kind = StreamKind::Video, .codec = kDpt.codec};
  stream.width = static_cast<int>(size->width);
  stream.height = static_cast<int>(size->height);
  stream.range = ColorRange::Full;
  return stream;
}

}  // namespace relievo
