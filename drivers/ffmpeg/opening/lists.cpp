// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/lists.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace relievo::ffmpeg {
namespace {

constexpr std::string_view kBegin = "#EXTM3U", kEnd = "#EXT-X-ENDLIST", kBlank = " \t\r\n";

// What FFmpeg reads of it at once.
std::string_view firstBytes(AVIOContext& file) noexcept {
  const std::int64_t begin = avio_tell(&file);
  avio_r8(&file);
  if (avio_tell(&file) == begin) return {};
  avio_seek(&file, begin, SEEK_SET);  // within its buffer
  return {reinterpret_cast<const char*>(file.buf_ptr), static_cast<std::size_t>(file.buf_end - file.buf_ptr)};
}

bool namesNothing(std::string_view list) noexcept {
  while (!list.empty()) {
    const std::string_view line = list.substr(0, list.find('\n'));
    if (line.find_first_not_of(kBlank) != std::string_view::npos && line[0] != '#') return false;
    list.remove_prefix(std::min(line.size() + 1, list.size()));
  }
  return true;
}

}  // namespace

bool isEmptyList(AVIOContext& file) noexcept {
  const std::string_view list = firstBytes(file);
  if (!list.starts_with(kBegin) || !namesNothing(list)) return false;
  const std::string_view whole = list.substr(0, list.find_last_not_of(kBlank) + 1);
  return whole.ends_with(kEnd) || avio_size(&file) == static_cast<std::int64_t>(list.size());
}

}  // namespace relievo::ffmpeg
