// SPDX-License-Identifier: Apache-2.0
// Reads and writes a small file of numbers.
#include "app/player/sound/loudness.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "platform/files/answered_place.h"
#include "platform/log.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

using Json = nlohmann::json;

// A damaged file counts as empty, like a missing one.
Result<Json> load(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Settings, "");
  if (!text && text.error().code != ErrorCode::NotFound) return std::unexpected(text.error());
  const Json json = text ? Json::parse(*text, nullptr, false) : Json::object();
  return json.is_object() ? json : Json::object();
}

// Keeps the values of other devices.
Result<void> write(const std::string& path, const std::string& device, double percent) {
  auto json = load(path);
  if (!json) return std::unexpected(json.error());
  (*json)[device] = percent;
  if (auto made = makeFolders(std::filesystem::path(path).parent_path()); !made) return made;
  return writeFile(path, json->dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace

Loudness::Loudness(std::string path, std::string device) : path_(std::move(path)), device_(std::move(device)) {
  if (path_.empty()) return;
  const Json json = load(path_).value_or(Json::object());
  const auto found = json.find(device_);
  if (found != json.end() && found->is_number()) set(found->get<double>());
  kept_percent_ = percent_;
}

void Loudness::set(double percent) noexcept {
  percent_ = std::clamp(percent, 0.0, kMostPercent);
}

double Loudness::gain() const noexcept {
  const double share = percent_ / 100;
  return muted_ ? 0.0 : share * share * share;
}

void Loudness::keep(FileWriter& files) {
  if (path_.empty() || percent_ == kept_percent_) return;
  kept_percent_ = percent_;
  files.give(path_, [path = path_, device = device_, percent = percent_] {
    if (const auto written = write(path, device, percent); !written)
      log(LogLevel::Warning, "play", "%s: the volume is not remembered: %s", path.c_str(), written.error().message);
  });
}

}  // namespace relievo
