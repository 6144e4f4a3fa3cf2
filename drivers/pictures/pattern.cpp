// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/pattern.h"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "drivers/pictures/other_files.h"
#include "hal/media/media_names.h"

namespace relievo::pictures {
namespace {

constexpr const char* kNoMatch = "no picture has a name of this pattern; check the folder and the pattern";

// "b%06d.png": the text around the number and the least number of its digits.
struct Numbered {
  std::string before, behind;
  std::size_t digits = 1;
};
std::optional<Numbered> numberedIn(const std::string& name) {
  for (std::size_t at = name.find('%'); at != name.npos; at = name.find('%', at + 1)) {
    std::size_t end = at + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
    if (end == name.size() || name[end] != 'd' || end - at > 4) continue;
    const std::string width = name.substr(at + 1, end - at - 1);
    return Numbered{name.substr(0, at), name.substr(end + 1), width.empty() ? 1 : std::max(std::stoul(width), 1UL)};
  }
  return std::nullopt;
}

}  // namespace

bool isPattern(const std::string& name) {
  return mediaKindOf(name) == MediaKind::Picture && (numberedIn(name) || name.find_first_of("*?") != name.npos);
}

bool matches(const std::string& pattern, const std::string& name) {
  const auto numbered = numberedIn(pattern);
  if (!numbered) return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0;
  const std::size_t around = numbered->before.size() + numbered->behind.size();
  if (name.size() < around + numbered->digits) return false;
  if (!name.starts_with(numbered->before) || !name.ends_with(numbered->behind)) return false;
  const auto digits = std::string_view(name).substr(numbered->before.size(), name.size() - around);
  return std::ranges::all_of(digits, [](unsigned char c) { return std::isdigit(c) != 0; });
}

Result<FoundPictures> findByPattern(const std::string& folder, const std::string& pattern) {
  FoundPictures found{.color = {folder, {}}};
  std::size_t may_list = 1;
  auto listing = listingOf(folder, may_list);
  if (!listing) return std::unexpected(listing.error());
  for (std::string& name : listing->pictures) {
    if (matches(pattern, name)) found.color.names.push_back(std::move(name));
  }
  if (found.color.names.empty()) return fail(ErrorCode::NotFound, kNoMatch);
  return found;
}

}  // namespace relievo::pictures
