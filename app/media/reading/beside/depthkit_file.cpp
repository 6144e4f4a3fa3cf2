// SPDX-License-Identifier: Apache-2.0
// Finds the numbers by their names, so that JSON, the same text inside of a Unity asset, and an asset's own lines are
// read alike; where several cameras are listed, the first one's.
#include "app/media/reading/beside/depthkit_file.h"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "platform/files/answered_place.h"
#include "platform/print.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

std::optional<double> numberNamed(const std::string& text, std::string_view name) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    std::size_t end = at + name.size();
    if (at > 0 && std::isalnum(static_cast<unsigned char>(text[at - 1])) != 0) continue;
    while (end < text.size() && (text[end] == '"' || text[end] == '\\')) ++end;
    end = text.find_first_not_of(" \t", end);
    if (end == std::string::npos || text[end] != ':') continue;
    const char* const begin = text.c_str() + end + 1;
    char* behind = nullptr;
    const double value = std::strtod(begin, &behind);
    if (behind != begin && std::isfinite(value)) return value;
  }
  return std::nullopt;
}

// Newer files have metres, older ones mm.
double mmPerUnit(double far) {
  constexpr double kFarthestMetres = 50;
  return far > kFarthestMetres ? 1 : 1000;
}

std::size_t camerasIn(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find("nearClip"); at != std::string::npos; at = text.find("nearClip", at + 1)) ++count;
  return count;
}

// True if the camera was turned on its side: in its pose, the right side of the picture points up or down.
bool liesOnItsSide(const std::string& text) {
  constexpr double kMostly = 0.8;
  return std::abs(numberNamed(text, "e10").value_or(0)) > kMostly;
}

std::optional<RecordingPlace> readFile(const fs::path& file) {
  if (!isRegularFile(file.string())) return std::nullopt;
  const auto text = readWholeFile(file.string(), FileSize::Settings, "cannot be read");
  if (!text) return std::nullopt;
  const auto near = numberNamed(*text, "nearClip"), far = numberNamed(*text, "farClip");
  if (!near || !far || *near <= 0 || *far <= *near) return std::nullopt;
  const double mm = mmPerUnit(*far);
  std::string why = print("%s says %.3g to %.3g m", file.c_str(), 1e-3 * mm * *near, 1e-3 * mm * *far);
  if (const std::size_t cameras = camerasIn(*text); cameras > 1) why += print(" for the first of %zu cameras", cameras);
  if (liesOnItsSide(*text)) why += "; its camera was turned on its side, and the picture is shown as it is stored";
  return RecordingPlace{.kind = findKind("depthkit"),
                        .origin = CalibrationOrigin::FileBeside,
                        .settings = {{"near", print("%.6g", mm * *near)}, {"far", print("%.6g", mm * *far)}},
                        .why = std::move(why),
                        .file = file.string(),
                        .camera = std::nullopt};
}

}  // namespace

RecordingPlace lookForDepthkit(const fs::path& film) {
  const fs::path stem = fs::path(film).replace_extension();
  for (const char* end : {".txt", ".json", ".asset", "_meta.txt", "_meta.json", "_meta.asset", ".Metadata.asset"}) {
    if (auto found = readFile(stem.string() + end)) return std::move(*found);
  }
  return {};
}

}  // namespace relievo
