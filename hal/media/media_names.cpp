// SPDX-License-Identifier: Apache-2.0
#include "hal/media/media_names.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "platform/text/lower_case.h"

namespace relievo {
namespace {

constexpr std::array<std::string_view, 40> kFilms{
    "mkv",  "mk3d", "webm", "mp4",  "m4v", "mov", "qt",  "avi",  "ts",   "m2ts", "mts",  "mpg", "mpeg", "vob",
    "flv",  "wmv",  "asf",  "ogv",  "ogm", "nut", "ivf", "y4m",  "m3u8", "3gp",  "3g2",  "mxf", "dv",   "264",
    "h264", "265",  "bag",  "mcap", "db3", "oni", "klg", "sens", "f4v",  "m2v",  "h265", "hevc"};
constexpr std::array<std::string_view, 31> kPictures{"png", "pgm", "ppm", "pbm", "pnm",  "pam",  "jpg",  "jpeg",
                                                     "jpe", "jps", "mpo", "tif", "tiff", "bmp",  "webp", "exr",
                                                     "pfm", "dpt", "npy", "npz", "heic", "heif", "avif", "jp2",
                                                     "j2k", "dpx", "tga", "sgi", "hdr",  "qoi",  "phm"};

bool isDigit(char c) noexcept {
  return c >= '0' && c <= '9';
}

// As unsigned: a char has a sign on x86 and none on ARM, where scripts beyond ASCII would come first and last.
unsigned char byteOf(std::string_view text) noexcept {
  return static_cast<unsigned char>(text.front());
}

// The run of digits at the beginning, without leading zeros.
std::string_view numberOf(std::string_view text) noexcept {
  const auto end = std::find_if_not(text.begin(), text.end(), isDigit);
  text = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  return text.substr(std::min(text.find_first_not_of('0'), text.size()));
}

std::string_view behindNumber(std::string_view text) noexcept {
  const auto end = std::find_if_not(text.begin(), text.end(), isDigit);
  return text.substr(static_cast<std::size_t>(end - text.begin()));
}

}  // namespace

std::string endingOf(std::string_view name) {
  name = name.substr(name.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return "";
  return lowerCase(name.substr(dot + 1));
}

MediaKind mediaKindOf(std::string_view name) noexcept {
  const std::string ending = endingOf(name);
  if (std::ranges::find(kPictures, ending) != kPictures.end()) return MediaKind::Picture;  // folders hold thousands
  return std::ranges::find(kFilms, ending) != kFilms.end() ? MediaKind::Film : MediaKind::Neither;
}

bool isPhotoName(std::string_view name) {
  constexpr std::array<std::string_view, 7> kPhotos{"jpg", "jpeg", "jpe", "jps", "mpo", "heic", "heif"};
  return std::ranges::find(kPhotos, endingOf(name)) != kPhotos.end();
}

std::vector<std::string> wordsOf(std::string_view name) {
  std::vector<std::string> words(1);
  for (const unsigned char c : name) {
    if (std::isalpha(c) != 0) words.back() += static_cast<char>(std::tolower(c));
    else if (!words.back().empty()) words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool saysDepth(std::string_view path) {
  const std::string_view name = stemOf(path.substr(path.rfind('/') + 1));
  const bool is_title = name.find_first_of(" .") != name.npos;
  return std::ranges::any_of(wordsOf(name), [&](const std::string& word) {
    return std::ranges::find(kDepthWords, word) != kDepthWords.end() && !(is_title && word == "depths");
  });
}

bool naturalLess(std::string_view a, std::string_view b) noexcept {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (isDigit(a.front()) && isDigit(b.front())) {
      const std::string_view left = numberOf(a), right = numberOf(b);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
      a = behindNumber(a), b = behindNumber(b);
      continue;
    }
    if (a.front() != b.front()) return byteOf(a) < byteOf(b);
    a.remove_prefix(1), b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;
}

char matterportLetter(std::string_view name) noexcept {
  constexpr std::size_t kDigits = 32, kRest = 5;
  const std::string_view stem = name.substr(0, name.find('.'));
  if (stem.size() != kDigits + kRest || stem.find_first_not_of("0123456789abcdef") != kDigits) return '\0';
  const std::string_view rest = stem.substr(kDigits);
  const bool of_form =
      rest[0] == '_' && rest[2] >= '0' && rest[2] <= '2' && rest[3] == '_' && rest[4] >= '0' && rest[4] <= '5';
  return of_form && (rest[1] == 'd' || rest[1] == 'i') ? rest[1] : '\0';
}

}  // namespace relievo
