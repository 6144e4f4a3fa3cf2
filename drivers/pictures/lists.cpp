// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/lists.h"

#include <algorithm>
#include <optional>

#include "drivers/pictures/clock_unit.h"
#include "drivers/pictures/names.h"
#include "hal/media/media_names.h"

namespace relievo::pictures {
namespace {

constexpr std::size_t kMostLines = 1'000'000;
constexpr const char* kFormat =
    "is a text, not a film, and lists no pictures either; give a film, or lines TIME PICTURE TIME PICTURE; if it is a "
    "table of numbers: python3 -c 'import numpy; numpy.save(\"depth.npy\", numpy.loadtxt(\"FILE\"))'";

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
  return dot == time.npos || (dot + 1 < time.size() && time.find_first_not_of('0', dot + 1) == time.npos);
}

using Words = std::vector<std::string_view>;

std::optional<std::vector<ListedPicture>> lineOf(const Words& words, bool whole) {
  std::vector<ListedPicture> line;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const auto time = whole ? integerIn(words[i].substr(0, words[i].find('.'))) : nanosecondsIn(words[i]);
    if (!time || *time < 0 || mediaKindOf(words[i + 1]) != MediaKind::Picture) return std::nullopt;
    line.push_back({*time, std::string(words[i + 1])});
  }
  return line;
}

// Whole numbers may be times. False for greater numbers than count pictures.
bool takeClock(PictureList& list) {
  constexpr std::int64_t kMostPictures = 9'000'000'000;
  std::vector<std::int64_t> values;
  values.reserve(list.lines.size());
  for (const auto& line : list.lines) values.push_back(line.front().value);
  const std::int64_t ns = clockUnit(std::move(values));
  list.numbers = ns == 0;
  for (auto& line : list.lines) {
    for (ListedPicture& picture : line) {
      if (list.numbers && picture.value > kMostPictures) return false;
      picture.value *= list.numbers ? 1 : ns;
    }
  }
  return true;
}

}  // namespace

Result<PictureList> parsePictureList(std::string_view text, std::size_t pictures) {
  std::vector<Words> lines;
  bool whole = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    Words words = wordsOf(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (words.empty()) continue;
    if (words.size() != 2 * pictures) return fail(ErrorCode::Corrupt, kFormat);
    if (lines.size() == kMostLines) return fail(ErrorCode::Exhausted, "names over a million pictures; split it");
    for (std::size_t i = 0; i < words.size(); i += 2) whole = whole && isWhole(words[i]);
    lines.push_back(std::move(words));
  }
  if (lines.empty()) return fail(ErrorCode::Corrupt, kFormat);
  PictureList list;
  for (const Words& words : lines) {
    auto line = lineOf(words, whole);
    if (!line) return fail(ErrorCode::Corrupt, kFormat);
    list.lines.push_back(std::move(*line));
  }
  if (whole && !takeClock(list)) return fail(ErrorCode::Corrupt, kFormat);
  return list;
}

}  // namespace relievo::pictures
