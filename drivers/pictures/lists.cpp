// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/lists.h"

#include <algorithm>
#include <optional>

#include "drivers/pictures/names.h"
#include "hal/media/media_names.h"

namespace relievo::pictures {
namespace {

constexpr std::size_t kMostLines = 1'000'000;
constexpr const char* kFormat =
    "is a text, not a film, and lists no pictures either; give a film, or lines TIME PICTURE TIME PICTURE";

std::vector<std::string_view> wordsOf(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r,";
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != line.npos; at = line.find_first_not_of(kBlanks, at)) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

bool isWhole(std::string_view time) {
  const std::size_t dot = time.find('.');
  return dot == time.npos || time.find_first_not_of('0', dot + 1) == time.npos;
}

std::optional<std::vector<ListedPicture>> lineOf(const std::vector<std::string_view>& words, std::size_t pictures) {
  if (words.size() != 2 * pictures) return std::nullopt;
  std::vector<ListedPicture> line;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const auto time = nanosecondsIn(words[i]);
    if (!time || mediaKindOf(words[i + 1]) != MediaKind::Picture) return std::nullopt;
    line.push_back({*time, std::string(words[i + 1])});
  }
  return line;
}

}  // namespace

Result<PictureList> parsePictureList(std::string_view text, std::size_t pictures) {
  PictureList list{.numbers = true, .lines = {}};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::vector<std::string_view> words = wordsOf(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (words.empty()) continue;
    auto line = lineOf(words, pictures);
    if (!line) return fail(ErrorCode::Corrupt, kFormat);
    if (list.lines.size() == kMostLines) return fail(ErrorCode::Exhausted, "names over a million pictures; split it");
    for (std::size_t i = 0; i < words.size(); i += 2) list.numbers = list.numbers && isWhole(words[i]);
    list.lines.push_back(std::move(*line));
  }
  if (list.lines.empty()) return fail(ErrorCode::Corrupt, kFormat);
  for (auto& line : list.lines) {
    for (ListedPicture& picture : line) picture.value /= list.numbers ? 1'000'000'000 : 1;
  }
  return list;
}

}  // namespace relievo::pictures
