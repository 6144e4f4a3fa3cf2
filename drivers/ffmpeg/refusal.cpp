// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/refusal.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/local_file.h"
#include "drivers/ffmpeg/network_error.h"
#include "platform/files/answered_file.h"

namespace relievo::ffmpeg {
namespace {

constexpr std::size_t kHeadBytes = 16;

// Fewer bytes if the file is shorter or cannot be read.
std::string headOf(const std::string& path) {
  std::array<std::uint8_t, kHeadBytes> head{};
  const auto file = AnsweredFile::open(path);
  const std::size_t bytes = file ? file->read(0, head).value_or(0) : 0;
  return {head.begin(), head.begin() + static_cast<std::ptrdiff_t>(bytes)};
}

// ISO/IEC 23008-12.
bool isHeic(const std::string& path) {
  const std::string head = headOf(path);
  if (head.size() < 12) return false;
  constexpr std::array<std::string_view, 6> kBrands{"heic", "heix", "heim", "heis", "mif1", "msf1"};
  return head.substr(4, 4) == "ftyp" && std::ranges::find(kBrands, head.substr(8, 4)) != kBrands.end();
}

}  // namespace

Error refusal(const Address& address, int code, const std::string& words) {
  if (code == AVERROR_INVALIDDATA && address.way == Way::File && isHeic(localPathOf(address.url))) {
    return {ErrorCode::Unsupported, 0,
            "it is a HEIC photo, which this FFmpeg cannot read; with libheif (RELIEVO_HEIF) those with a depth map or "
            "two views are read; save it as JPEG or PNG"};
  }
  if (!address.remote()) return openError(code);
  // FFmpeg returns EINVAL for what the whitelists of `optionsFor` forbid.
  if (code != AVERROR(EINVAL) || address.way != Way::Http) return networkError(code, words);
  return {ErrorCode::Unsupported, 0,
          "it is no film, or a playlist that names files or protocols forbidden to network sources; check the "
          "address"};
}

}  // namespace relievo::ffmpeg
