// SPDX-License-Identifier: Apache-2.0
#include "app/media/folder/other_view.h"

#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "hal/media/media_names.h"
#include "platform/files/answered_place.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

using Sides = std::pair<std::string_view, std::string_view>;
constexpr std::array<Sides, 6> kWords{
    {{"left", "right"}, {"right", "left"}, {"Left", "Right"}, {"Right", "Left"}, {"LEFT", "RIGHT"}, {"RIGHT", "LEFT"}}};
constexpr std::array<Sides, 14> kEnds{{{"_l", "_r"},
                                       {"_r", "_l"},
                                       {"_L", "_R"},
                                       {"_R", "_L"},
                                       {"-l", "-r"},
                                       {"-r", "-l"},
                                       {"-L", "-R"},
                                       {"-R", "-L"},
                                       {".l", ".r"},
                                       {".r", ".l"},
                                       {".L", ".R"},
                                       {".R", ".L"},
                                       {"im0", "im1"},
                                       {"im1", "im0"}}};

// The stem with one side's sign replaced by the other's; empty if it has none.
std::string otherOf(const std::string& stem) {
  for (const auto& [here, there] : kWords) {
    const std::size_t at = stem.rfind(here);
    if (at != std::string::npos) return std::string(stem).replace(at, here.size(), there);
  }
  for (const auto& [here, there] : kEnds) {
    if (stem.ends_with(here)) return stem.substr(0, stem.size() - here.size()) + std::string(there);
  }
  return "";
}

}  // namespace

std::string otherViewBeside(const std::string& picture) {
  if (mediaKindOf(picture) != MediaKind::Picture || !isRegularFile(picture)) return "";
  const fs::path path(picture);
  const std::string other = otherOf(path.stem().string());
  if (other.empty()) return "";
  const auto beside = [&path](const std::string& stem) {
    return fs::path(path).replace_filename(stem + path.extension().string()).string();
  };
  // im2 beside im0 and im1: a series.
  const std::string counted = other.substr(0, other.size() - 1);
  if (path.stem().string().starts_with(counted) && counted.ends_with("im") && isRegularFile(beside(counted + "2")))
    return "";
  return isRegularFile(beside(other)) ? beside(other) : "";
}

}  // namespace relievo
