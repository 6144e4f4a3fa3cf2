// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/lists.h"

#include <algorithm>
#include <cstdint>
#include <memory>

#include "drivers/ffmpeg/address.h"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/opt.h>
}

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

// RFC 3986, 5.2.2. FFmpeg takes "." and ".." out.
std::string wholeAddress(std::string_view part, std::string_view own) {
  if (!schemeOf(part).empty()) return std::string(part);
  own = own.substr(0, own.find_first_of("?#"));
  const std::size_t host = own.find("//");
  if (host == std::string_view::npos) return std::string(part);
  const std::size_t path = std::min(own.find('/', host + 2), own.size());
  std::string_view begin = own;
  if (part.starts_with("//")) begin = own.substr(0, host);
  else if (part.starts_with('/')) begin = own.substr(0, path);
  else if (!part.starts_with('?')) begin = own.substr(0, std::max(own.rfind('/') + 1, path));
  const bool lacks_path = begin.size() == path && path == own.size() && !part.starts_with('/');
  return std::string(begin) + (lacks_path ? "/" : "") + std::string(part);
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

bool isList(AVIOContext& file) noexcept {
  return firstBytes(file).starts_with(kBegin);
}

std::string optionOf(AVIOContext& file, const char* name) {
  std::uint8_t* value = nullptr;
  if (av_opt_get(&file, name, AV_OPT_SEARCH_CHILDREN, &value) < 0 || value == nullptr) return {};
  const std::unique_ptr<std::uint8_t, decltype(&av_free)> owned(value, av_free);
  return reinterpret_cast<const char*>(value);
}

std::string withWholeAddresses(std::string_view list, std::string_view own) {
  constexpr std::string_view kAddress = "URI=\"";
  std::string whole;
  while (!list.empty()) {
    const std::string_view line = list.substr(0, list.find('\n'));
    std::size_t begin = 0, end = line.find_last_not_of(kBlank) + 1;
    if (line.starts_with('#')) {
      begin = line.find(kAddress);
      begin = begin == std::string_view::npos ? line.size() : begin + kAddress.size();
      end = std::min(line.find('"', begin), line.size());
    }
    whole += line.substr(0, begin);
    if (begin < end) whole += wholeAddress(line.substr(begin, end - begin), own);
    whole += line.substr(end);
    list.remove_prefix(line.size());
    if (!list.empty()) whole += '\n';
    list.remove_prefix(std::min<std::size_t>(1, list.size()));
  }
  return whole;
}

}  // namespace relievo::ffmpeg
