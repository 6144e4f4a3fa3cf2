// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/layouts.h"

#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "hal/media/media_names.h"
#include "platform/print.h"
#include "platform/whole_file.h"

namespace relievo::pictures {
namespace {

namespace fs = std::filesystem;

// "a/b/rgb/1.png": "rgb" is the folder, "a/b/" the place.
std::string_view folderIn(std::string_view path) {
  path = path.substr(0, std::min(path.rfind('/'), path.size()));
  return path.substr(path.rfind('/') + 1);
}
std::string placeOf(const std::string& path) {
  return path.substr(0, path.rfind('/') - folderIn(path).size());
}

// True for a name in seconds, such as "1305031102.160407.png". Recordings that count in other units of time, such as
// Redwood's, store mm.
bool isSeconds(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1), stem = name.substr(0, name.rfind('.'));
  return stem.find('.') != stem.npos && stem.find_first_not_of("0123456789.") == stem.npos;
}

// The first depth_scale in scene_camera.json; 0 if there is none.
double bopScaleMm(const std::string& place) {
  const auto text = readWholeFile(place + "scene_camera.json", FileSize::Recording, "");
  constexpr std::string_view kKey = "\"depth_scale\":";
  const std::size_t at = text ? text->find(kKey) : std::string::npos;
  if (at == std::string::npos) return 0;
  const std::size_t number = text->find_first_not_of(" \t\n", at + kKey.size());
  double scale = 0;
  if (number != std::string::npos) std::from_chars(text->data() + number, text->data() + text->size(), scale);
  return std::isfinite(scale) && scale > 0 && scale < 1e4 ? scale : 0;
}

// Blanks, and comments to the end of their line.
std::size_t behindBlanks(std::string_view header, std::size_t at) {
  while (at < header.size() && header.find_first_of("0123456789", at) != at) {
    at = header[at] == '#' ? std::min(header.find('\n', at), header.size() - 1) + 1 : at + 1;
  }
  return at;
}

// Where the samples of a PGM of 16 bits begin, which is binary (P5) or text (P2); 0 if it is none.
std::size_t samplesOf(const std::vector<std::uint8_t>& pgm, std::string_view kind = "P5") {
  constexpr std::size_t kLongestHeader = 256;
  const std::string_view text(reinterpret_cast<const char*>(pgm.data()), std::min(pgm.size(), kLongestHeader));
  if (!text.starts_with(kind)) return 0;
  std::size_t at = 2;
  int most = 0;
  for (int number = 0; number < 3; ++number) {
    at = behindBlanks(text, at);
    if (at == text.size()) return 0;
    at = static_cast<std::size_t>(std::from_chars(text.data() + at, text.data() + text.size(), most).ptr - text.data());
  }
  return most > 255 ? at + 1 : 0;
}

}  // namespace

std::map<std::string, std::string> depthTagsOf(const std::string& color, const std::string& depth, bool listed) {
  if (::fnmatch("*_sync_groundtruth_depth_*_image_0[23].png", depth.c_str(), 0) == 0)
    return {{"DEPTH_UNIT", "3.90625"}, {"DEPTH_INVALID", "0"}};
  if (folderIn(depth) != "depth" || folderIn(color) != "rgb" || endingOf(depth) != "png") return {};
  if (listed || isSeconds(depth)) return {{kLayoutTag, "tum"}};
  const double scale = bopScaleMm(placeOf(depth));
  if (scale == 0) return {};
  return {{"DEPTH_UNIT", print("%.9g", scale)}, {"DEPTH_INVALID", "0"}};
}

std::optional<double> rateOf(const std::string& color, const std::string& depth) {
  struct Layout {
    const char* names;  // as fnmatch() has them
    double rate;
  };
  static constexpr Layout kLayouts[] = {
      {"*/image_[0-3]/[0-9][0-9][0-9][0-9][0-9][0-9]_1[01].png", 0},
      {"*/image_[0-3]/[0-9][0-9][0-9][0-9][0-9][0-9].png", 10},
      {"*/image_0[0-3]/*[0-9][0-9][0-9][0-9][0-9][0-9][0-9][0-9][0-9][0-9].png", 10},
      {"*/rgb/Camera_[01]/rgb_*", 10},
      {"*_sync_image_*_image_0[23].png", 0},
      {"*_indoors_*_depth.npy", 0},
      {"*_outdoor_*_depth.npy", 0},
      {"*.dpt", 24},
  };
  std::error_code error;
  const std::string paths[] = {fs::absolute(color, error).lexically_normal(),
                               fs::absolute(depth, error).lexically_normal()};
  for (const Layout& layout : kLayouts) {
    for (const std::string& path : paths) {
      if (::fnmatch(layout.names, path.c_str(), 0) == 0) return layout.rate;
    }
  }
  return std::nullopt;
}

bool isNyuDepth(const std::string& path) {
  const std::string_view name = std::string_view(path).substr(path.rfind('/') + 1);
  return name.starts_with("d-") && endingOf(name) == "pgm";
}

void mendByteOrder(std::vector<std::uint8_t>& pgm) {
  constexpr int kMost = 2047;
  const std::size_t begin = samplesOf(pgm);
  if (begin == 0) return;
  bool as_is = true, swapped = true;
  for (std::size_t i = begin; i + 1 < pgm.size(); i += 2) {
    as_is = as_is && (pgm[i] << 8 | pgm[i + 1]) <= kMost;
    swapped = swapped && (pgm[i + 1] << 8 | pgm[i]) <= kMost;
  }
  if (as_is || !swapped) return;
  for (std::size_t i = begin; i + 1 < pgm.size(); i += 2) std::swap(pgm[i], pgm[i + 1]);
}

void keepCodes(std::vector<std::uint8_t>& pgm) {
  constexpr std::string_view kHighest = "65535";
  const std::size_t begin = std::max(samplesOf(pgm), samplesOf(pgm, "P2"));
  if (begin == 0) return;
  const auto end = pgm.begin() + static_cast<std::ptrdiff_t>(begin - 1);
  auto digits = end;
  while (*std::prev(digits) >= '0' && *std::prev(digits) <= '9') --digits;
  pgm.insert(pgm.erase(digits, end), kHighest.begin(), kHighest.end());
}

}  // namespace relievo::pictures
