// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/listed.h"

#include <array>
#include <map>
#include <string_view>
#include <utility>

#include "drivers/pictures/roles.h"
#include "platform/whole_file.h"

namespace relievo::pictures {
namespace {

constexpr std::array<std::string_view, 4> kAssociations{"associations.txt", "associate.txt", "association.txt",
                                                        "assoc.txt"};

std::optional<PictureList> readList(const std::string& path, std::size_t pictures) {
  const auto text = readWholeFile(path, FileSize::Recording, "");
  const auto list = text ? parsePictureList(*text, pictures) : Result<PictureList>(std::unexpected(text.error()));
  return list ? std::optional(*list) : std::nullopt;
}

// Lines in the order of the times in a column. Of two lines with one time the first counts.
std::map<std::int64_t, std::vector<ListedPicture>> byTime(PictureList list, std::size_t column) {
  std::map<std::int64_t, std::vector<ListedPicture>> lines;
  for (auto& line : list.lines) {
    const std::int64_t time = line[column].value;
    lines.try_emplace(time, std::move(line));
  }
  return lines;
}

// rgb.txt and depth.txt.
std::optional<FoundPictures> fromTwoLists(const std::string& folder) {
  const auto color = readList(folder + "rgb.txt", 1), depth = readList(folder + "depth.txt", 1);
  if (!color || !depth || color->numbers != depth->numbers) return std::nullopt;
  FoundPictures found{.color = {folder, {}}, .depth = {folder, {}}};
  found.listed_numbers = color->numbers;
  const auto take = [](const PictureList& list, PictureFiles& files, std::vector<std::int64_t>& values) {
    for (auto& [time, line] : byTime(list, 0)) {
      files.names.push_back(std::move(line[0].name));
      values.push_back(time);
    }
  };
  take(*color, found.color, found.color_values);
  take(*depth, found.depth, found.depth_values);
  return found;
}

}  // namespace

FoundPictures fromAssociations(const std::string& folder, PictureList list) {
  const std::size_t color = roleOf(list.lines.front().front().name) == Role::Depth ? 1 : 0;
  FoundPictures found{.color = {folder, {}}, .depth = {folder, {}}};
  found.listed_numbers = list.numbers;
  found.paired = true;
  for (auto& [time, line] : byTime(std::move(list), color)) {
    found.color.names.push_back(std::move(line[color].name));
    found.depth.names.push_back(std::move(line[1 - color].name));
    found.color_values.push_back(time);
  }
  found.depth_values = found.color_values;
  return found;
}

std::optional<FoundPictures> findListed(const std::string& folder) {
  for (const std::string_view name : kAssociations) {
    if (const auto list = readList(folder + std::string(name), 2)) return fromAssociations(folder, *list);
  }
  return fromTwoLists(folder);
}

}  // namespace relievo::pictures
