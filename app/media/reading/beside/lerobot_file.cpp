// SPDX-License-Identifier: Apache-2.0
// LeRobotDataset 2.1 and 3.0: "videos/observation.images.front_depth/chunk-000/file-000.mp4" below the folder that has
// "meta/info.json"; the depth is quantised as lerobot/datasets/depth_utils.py does it (0.6.0).
#include "app/media/reading/beside/lerobot_file.h"

#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "platform/print.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

const Json* partOf(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? &*found : nullptr;
}

bool isTrue(const Json& info, const char* key) {
  const auto found = info.find(key);
  return found != info.end() && found->is_boolean() && found->get<bool>();
}

// What data set 2.0 and 3.0 call the part that describes a camera's film.
const Json* infoOfDepth(const Json& features, const std::string& camera) {
  const Json* const feature = partOf(features, camera);
  if (feature == nullptr) return nullptr;
  for (const char* name : {"info", "video_info"}) {
    const Json* const info = partOf(*feature, name);
    if (info != nullptr && (isTrue(*info, "is_depth_map") || isTrue(*info, "video.is_depth_map"))) return info;
  }
  return nullptr;
}

// Nullopt if the distances make no sense.
std::optional<EvenSteps> stepsIn(const Json& info) {
  constexpr double kMmPerMetre = 1000, kFarthest = 1e9;
  EvenSteps steps;
  const auto take = [&info](const char* key, float& mm) {
    const auto found = info.find(key);
    if (found == info.end() || !found->is_number()) return;
    const double value = kMmPerMetre * found->get<double>();
    mm = std::abs(value) < kFarthest ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
  };
  take("video.depth_min", steps.nearest_mm);
  take("video.depth_max", steps.farthest_mm);
  take("video.shift", steps.shift_mm);
  steps.logarithmic = !info.contains("video.use_log") || isTrue(info, "video.use_log");
  const bool in_range = steps.nearest_mm >= 0 && steps.farthest_mm > steps.nearest_mm;
  const bool has_logarithm = !steps.logarithmic || steps.nearest_mm + steps.shift_mm > 0;
  return in_range && has_logarithm ? std::optional(steps) : std::nullopt;
}

RecordingPlace placeOf(const fs::path& file, const EvenSteps& steps) {
  KnownKind kind = *findKind("lerobot");
  kind.order = SampleOrder(steps);
  auto own = std::make_shared<const KnownKind>(kind);
  return {own.get(),
          CalibrationOrigin::FileBeside,
          {{"unit", print("%.9g", steps.unitMm())}},
          print("%s says 12 bits from %g to %g m, %s", file.c_str(), 1e-3 * static_cast<double>(steps.nearest_mm),
                1e-3 * static_cast<double>(steps.farthest_mm), steps.logarithmic ? "by logarithm" : "even steps"),
          file.string(),
          std::nullopt,
          std::move(own)};
}

}  // namespace

RecordingPlace lookForLeRobot(const fs::path& film) {
  constexpr int kFoldersUp = 4;  // of the film, the camera and its part, "videos", the data set
  fs::path at = film.parent_path();
  for (int i = 0; i < kFoldersUp && at.has_relative_path(); ++i) {
    at = at.parent_path();
    const fs::path file = at / "meta" / "info.json";
    const auto text = readWholeFile(file.string(), FileSize::Settings, "cannot be read");
    if (!text) continue;
    const Json json = Json::parse(*text, nullptr, false);
    const Json* const features = json.is_object() ? partOf(json, "features") : nullptr;
    if (features == nullptr) return {};
    for (fs::path folder = film.parent_path(); folder != at; folder = folder.parent_path()) {
      const Json* const info = infoOfDepth(*features, folder.filename().string());
      const auto steps = info != nullptr ? stepsIn(*info) : std::nullopt;
      if (steps) return placeOf(file, *steps);
    }
    return {};
  }
  return {};
}

}  // namespace relievo
