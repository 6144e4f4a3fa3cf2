// SPDX-License-Identifier: Apache-2.0
// Compares the misspelt name with those of the first files in its folder.
#include "app/player/setup/near_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "platform/text/near_words.h"

namespace relievo {

std::string nearFile(const std::string& path) {
  if (path.starts_with("www.")) return "https://" + path;
  constexpr std::size_t kMostFiles = 10'000;
  namespace fs = std::filesystem;
  const fs::path asked = path, folder = asked.parent_path();
  std::vector<fs::path> files;
  std::vector<std::string> stems;
  std::error_code error;
  for (fs::directory_iterator each(folder.empty() ? fs::path(".") : folder, error), end;
       !error && each != end && files.size() < kMostFiles; each.increment(error)) {
    files.push_back(each->path().filename());
    stems.push_back(files.back().stem().string());
  }
  const std::string stem = nearestWord(asked.stem().string(), stems);
  if (stem.empty()) return "";
  const auto isIt = [&stem](const fs::path& file) { return file.stem() == stem; };
  const auto same_kind = std::ranges::find_if(
      files, [&](const fs::path& file) { return isIt(file) && file.extension() == asked.extension(); });
  const auto found = same_kind != files.end() ? same_kind : std::ranges::find_if(files, isIt);
  return (folder / *found).string();
}

}  // namespace relievo
