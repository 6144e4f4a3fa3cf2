// SPDX-License-Identifier: Apache-2.0
// A small file of numbers.
#include "app/player/sound/loudness.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "platform/atomic_file.h"
#include "platform/log.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

using Json = nlohmann::json;

// An unreadable file counts as empty.
Json load(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Settings, "");
  const Json json = text ? Json::parse(*text, nullptr, false) : Json::object();
  return json.is_object() ? json : Json::object();
}

}  // namespace

Loudness::Loudness(std::string path, std::string device) : path_(std::move(path)), device_(std::move(device)) {
  if (path_.empty()) return;
  const Json json = load(path_);
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

void Loudness::keep() {
  if (path_.empty() || percent_ == kept_percent_) return;
  kept_percent_ = percent_;
  Json json = load(path_);
  json[device_] = percent_;
  std::error_code none;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), none);
  auto file = AtomicFile::create(path_);
  const auto written =
      file ? (file->write(json.dump() + "\n"), file->commit()) : Result<void>(std::unexpected(file.error()));
  if (!written)
    log(LogLevel::Warning, "play", "%s: the volume is not remembered: %s", path_.c_str(), written.error().message);
}

}  // namespace relievo
