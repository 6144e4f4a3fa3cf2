// SPDX-License-Identifier: Apache-2.0
// Depth that phones put behind a JPEG picture in ways of their own.
#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "drivers/photo/photo.h"
#include "platform/files/answered_file.h"

namespace relievo {
namespace {

constexpr const char* kSamsung =
    "it holds the depth of a Samsung phone, in a form that is not read; take it out: exiftool -b -DepthMapTiff FILE > "
    "depth.tif (or -SingleShotDepthMapTiff), and give --depth depth.tif";
constexpr const char* kHuawei =
    "it holds the depth of a Huawei phone, in a form that is not read: the gray picture behind the mark edof; give "
    "that with --depth";

constexpr const char* kLeia =
    "it is a photo of Leia's (LIF), whose depth is in a form that is not read; export it as a picture with its depth "
    "(RGB-D)";
constexpr std::string_view kLif = "\x1eLIF";  // the last bytes of such a file

// Samsung's directory lies at the file's end: "SEFH", the entries, their size, "SEFT". Each piece of data begins with
// its name.
bool isOfSamsung(std::string_view end) {
  constexpr std::size_t kFoot = 8;
  if (end.size() < kFoot || !end.ends_with("SEFT")) return false;
  const std::size_t head = end.rfind("SEFH");
  return head != end.npos && (end.find("DualShot_DepthMap") < head || end.find("SingeShot_DepthMap") < head ||
                              end.find("SingleShot_DepthMap") < head);
}

}  // namespace

const char* unreadDepth(const std::string& path) {
  constexpr std::uint64_t kMostEnd = std::uint64_t{24} << 20;  // behind it lie the phone's own pictures too
  const auto file = AnsweredFile::open(path);
  const std::uint64_t bytes = file && file->regular() ? file->bytes().value_or(0) : 0;
  const std::uint64_t size = std::min(kMostEnd, bytes);
  std::string end(static_cast<std::size_t>(size), '\0');
  const std::span<std::uint8_t> out(reinterpret_cast<std::uint8_t*>(end.data()), end.size());
  if (size == 0 || file->read(bytes - size, out).value_or(0) != size) return nullptr;
  if (isOfSamsung(end)) return kSamsung;
  if (end.ends_with(kLif)) return kLeia;
  const std::size_t picture_end = end.find("\xff\xd9");
  return picture_end != end.npos && end.find(std::string_view("\0edof\0", 6), picture_end) != end.npos ? kHuawei
                                                                                                       : nullptr;
}

}  // namespace relievo
