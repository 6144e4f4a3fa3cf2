// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/endings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "drivers/floats/npy_header.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_file.h"

namespace relievo::pictures {
namespace {

constexpr std::array<std::string_view, 8> kEndings{"pfm", "npy", "npz", "dpt", "exr", "tif", "tiff", "png"};

// PNG (ISO/IEC 15948): the signature, then IHDR with the size, the bits of a sample, and 0 for gray.
bool isGray16Png(const std::string& path) {
  constexpr std::size_t kBits = 24, kColor = 25;
  std::array<std::uint8_t, kColor + 1> head{};
  const auto file = AnsweredFile::open(path);
  return file && file->read(0, head).value_or(0) == head.size() && head[1] == 'P' && head[2] == 'N' && head[3] == 'G' &&
         head[kBits] == 16 && head[kColor] == 0;
}

// TIFF 6.0: one sample for each place, of 16 bits or more.
bool isGrayTiff(const std::string& path) {
  constexpr std::size_t kBits = 258, kSamples = 277, kEntry = 12, kMostEntries = 64;
  std::array<std::uint8_t, 2 + kEntry * kMostEntries> bytes{};
  const auto file = AnsweredFile::open(path);
  if (!file || file->read(0, std::span(bytes).first(8)).value_or(0) != 8) return false;
  const bool high_first = bytes[0] == 'M';
  const auto number = [&](std::size_t at, std::size_t size) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[high_first ? at + i : at + size - 1 - i];
    return value;
  };
  const std::size_t got = file->read(number(4, 4), bytes).value_or(0);
  const std::size_t entries = got < 2 ? 0 : std::min({number(0, 2), kMostEntries, (got - 2) / kEntry});
  std::size_t bits = 1, samples = 1;
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = 2 + kEntry * i, tag = number(at, 2);
    if (tag == kBits) bits = number(at + 8, 2);
    if (tag == kSamples) samples = number(at + 8, 2);
  }
  return samples == 1 && bits >= 16;
}

// Whether the array is one of a value for each place of a picture, not a pose or a camera's matrix.
bool isPlane(const std::string& path) {
  constexpr std::uint64_t kLeast = 16;  // rows and columns
  std::array<std::uint8_t, npy::kLongestHeader> head{};
  const auto file = AnsweredFile::open(path);
  const std::size_t bytes = file ? file->read(0, head).value_or(0) : 0;
  const auto header = npy::parseHeader(std::span(head).first(bytes));
  return header && header->pictures == 1 && header->components == 1 && std::min(header->rows, header->cols) >= kLeast;
}

// As many maps of floats as pictures: AirSim's, whose names differ in more than the ending.
std::vector<std::string> takeFloatsAmong(const std::string& folder, std::vector<std::string>& names) {
  const auto depth = std::ranges::partition(names, [](const auto& name) { return endingOf(name) != "pfm"; });
  if (2 * depth.size() != names.size() || isGray16Png(folder + names.front())) return {};
  std::vector<std::string> taken(depth.begin(), depth.end());
  names.erase(depth.begin(), depth.end());
  return taken;
}

// PNG of gray of 16 bits among others, where the first names are of both kinds: no photo has as many shades.
std::vector<std::string> takeGray16Among(const std::string& folder, std::vector<std::string>& names) {
  constexpr std::size_t kFirst = 4;
  if (std::ranges::any_of(names, [](const auto& name) { return endingOf(name) != "png"; })) return {};
  std::ranges::sort(names, naturalLess);
  const auto isColor = [&](const std::string& name) { return !isGray16Png(folder + name); };
  const std::span<const std::string> first(names.data(), std::min(kFirst, names.size()));
  if (std::ranges::all_of(first, isColor) || std::ranges::none_of(first, isColor)) return {};
  const auto depth = std::ranges::partition(names, isColor);
  std::vector<std::string> taken(depth.begin(), depth.end());
  names.erase(depth.begin(), depth.end());
  if (4 * names.size() >= taken.size()) return taken;
  names = std::move(taken);  // the others were a thumbnail, or the like
  return {};
}

}  // namespace

std::ptrdiff_t depthRankOf(const std::string& name) {
  return std::ranges::find(kEndings, endingOf(name)) - kEndings.begin();
}

bool holdsNumbers(const std::string& path) {
  const std::string ending = endingOf(path);
  if (ending == "png") return isGray16Png(path);
  if (ending == "npy") return isPlane(path);
  if (ending == "tif" || ending == "tiff") return isGrayTiff(path);
  return ending == "pfm" || ending == "dpt";
}

bool holdsPhotograph(const std::vector<std::string>& names) {
  return std::ranges::any_of(names, isPhotoName);
}

std::vector<std::string> oneKind(std::vector<std::string> names, Role role, std::size_t& left_out) {
  std::map<std::string, std::size_t> count;
  for (const std::string& name : names) ++count[endingOf(name)];
  if (count.size() < 2) return names;
  const auto areNumbers = [](const std::string& ending) {
    return ending == "npz" || ending == "npy" || ending == "pfm" || ending == "dpt";
  };
  const auto worth = [&](const auto& entry) {
    const bool depth = role == Role::Depth;
    return std::tuple(depth || !areNumbers(entry.first), entry.second, depth ? -depthRankOf('.' + entry.first) : 0);
  };
  const std::string most = std::ranges::max_element(count, {}, worth)->first;
  left_out += std::erase_if(names, [&](const std::string& name) { return endingOf(name) != most; });
  return names;
}

std::vector<std::string> chosen(std::vector<std::string> names, Role role, std::size_t& left_out) {
  const auto isOther = [roles = Roles()](const std::string& name) mutable { return roles.of(name) == Role::Other; };
  if (!std::ranges::all_of(names, isOther)) left_out += std::erase_if(names, isOther);
  if (role == Role::Depth) left_out += keepBestDepth(names);
  return oneKind(std::move(names), role, left_out);
}

std::vector<std::string> takeDepthOfPhotos(const std::string& folder, std::vector<std::string>& names) {
  const std::set<std::string> all(names.begin(), names.end());
  for (const std::string_view ending : {"pfm", "dpt", "npy", "tif", "tiff", "png", "npz"}) {
    const auto besideOf = [&](const std::string& name) { return name.substr(0, name.rfind('.') + 1).append(ending); };
    const auto isColor = [&](const std::string& name) {
      return isPhotoName(name) || (ending != "png" && endingOf(name) == "png" && !isGray16Png(folder + name));
    };
    const auto photo = std::ranges::find_if(
        names, [&](const std::string& name) { return all.contains(besideOf(name)) && isColor(name); });
    if (photo == names.end()) continue;
    const std::string beside = folder + besideOf(*photo);
    if ((ending == "png" && !isGray16Png(beside)) || (ending == "npy" && !isPlane(beside))) continue;
    if (ending.starts_with("tif") && !isGrayTiff(beside)) continue;
    const auto depth = std::ranges::partition(names, [&](const auto& name) { return endingOf(name) != ending; });
    std::vector<std::string> taken(depth.begin(), depth.end());
    names.erase(depth.begin(), depth.end());
    return taken;
  }
  auto floats = takeFloatsAmong(folder, names);
  return floats.empty() ? takeGray16Among(folder, names) : floats;
}

}  // namespace relievo::pictures
