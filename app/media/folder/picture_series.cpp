// SPDX-License-Identifier: Apache-2.0
#include "app/media/folder/picture_series.h"

#include <algorithm>

#include "hal/media/media_names.h"
#include "platform/files/answered_place.h"

namespace relievo {

std::optional<std::string> seriesOf(const std::vector<std::string>& sources) {
  const auto isSpecial = [](const std::string& s) { return s.find_first_of("*?[\\") != s.npos; };
  const auto isPicture = [&](const std::string& s) {
    return mediaKindOf(s) == MediaKind::Picture && endingOf(s) == endingOf(sources.front());
  };
  if (sources.size() < 2 || !std::ranges::all_of(sources, isPicture)) return std::nullopt;
  if (std::ranges::any_of(sources, isSpecial)) return std::nullopt;
  std::string before = sources.front(), behind = sources.front();
  for (const std::string& source : sources) {
    const auto at = std::ranges::mismatch(before, source).in1;
    before.erase(at, before.end());
    const auto from = std::ranges::mismatch(behind.rbegin(), behind.rend(), source.rbegin(), source.rend()).in1;
    behind.erase(behind.begin(), from.base());
  }
  const std::string folder = before.substr(0, before.rfind('/') + 1);
  std::size_t named = 0;
  for (const auto& entry : entriesOf(folder.empty() ? "." : folder)) {
    const std::string path = folder + entry.name;
    const bool long_enough = path.size() >= before.size() + behind.size();
    if (long_enough && path.starts_with(before) && path.ends_with(behind)) ++named;
  }
  const bool one_folder = behind.find('/') == behind.npos;
  return one_folder && named == sources.size() ? std::optional(before + "*" + behind) : std::nullopt;
}

}  // namespace relievo
