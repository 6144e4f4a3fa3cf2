// SPDX-License-Identifier: Apache-2.0
// Reads what Azure Kinect's recorder stores about its two cameras: lenses for the whole sensor, of which each mode
// shows a part.
#include "app/media/registration/own_registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace relievo {
namespace {

using Json = nlohmann::json;

constexpr double kMmPerMetre = 1000;
constexpr const char* kDepthCamera = "CALIBRATION_CameraLocationD0";
constexpr const char* kColorCamera = "CALIBRATION_CameraLocationPV0";
constexpr const char* kLensModel = "CALIBRATION_LensDistortionModelBrownConrady";

// A mode's picture: this part of the sensor's whole picture at this scale.
struct Mode {
  double whole_cols, whole_rows;
  double left, top;
};

std::optional<Mode> depthMode(ModeSize size) noexcept {
  if (size.cols == 320 && size.rows == 288) return Mode{512, 512, 96, 90};
  if (size.cols == 640 && size.rows == 576) return Mode{1024, 1024, 192, 180};
  if (size.cols == size.rows && (size.cols == 512 || size.cols == 1024)) {
    const double side = size.cols;
    return Mode{side, side, 0, 0};
  }
  return std::nullopt;
}

// The sensor is 4:3; 16:9 modes show its middle rows.
std::optional<Mode> colorMode(ModeSize size) noexcept {
  const double rows = size.cols * 3.0 / 4;
  if (size.cols < 1 || (size.rows * 4 != size.cols * 3 && size.rows * 16 != size.cols * 9)) return std::nullopt;
  return Mode{static_cast<double>(size.cols), rows, 0, (rows - size.rows) / 2};
}

template <std::size_t N>
std::optional<std::array<double, N>> numbers(const Json& list) {
  std::array<double, N> values{};
  if (!list.is_array() || list.size() < N) return std::nullopt;
  for (std::size_t i = 0; i < N; ++i) {
    if (!list[i].is_number()) return std::nullopt;
    values[i] = list[i].get<double>();
    if (!std::isfinite(values[i])) return std::nullopt;
  }
  return values;
}

const Json& member(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : none;
}

const Json& cameraAt(const Json& calibration, const char* location) {
  static const Json none;
  for (const Json& camera : member(member(calibration, "CalibrationInformation"), "Cameras")) {
    if (member(camera, "Location") == location) return camera;
  }
  return none;
}

// Focal lengths and principal point are shares of the whole picture, from its corner.
std::optional<RigCamera> cameraOf(const Json& camera, const Mode& mode, ModeSize size, bool old_color) {
  const Json& intrinsics = member(camera, "Intrinsics");
  const auto p = numbers<14>(member(intrinsics, "ModelParameters"));
  if (!p || member(intrinsics, "ModelType") != kLensModel) return std::nullopt;
  const auto& [cx, cy, fx, fy, k1, k2, k3, k4, k5, k6, codx, cody, p2, p1] = *p;
  if (!(fx > 0) || !(fy > 0) || codx != 0 || cody != 0) return std::nullopt;
  // Old calibrations of the colour camera are for the 16:9 part of the sensor.
  const double rows = old_color ? mode.whole_cols * 9 / 16 : mode.whole_rows;
  const double above = (mode.whole_rows - rows) / 2;
  return RigCamera{.cols = static_cast<double>(size.cols),
                   .rows = static_cast<double>(size.rows),
                   .focal_x = fx * mode.whole_cols,
                   .focal_y = fy * rows,
                   .center_x = cx * mode.whole_cols - mode.left - 0.5,
                   .center_y = cy * rows + above - mode.top - 0.5,
                   .distortion = {k1, k2, p1, p2, k3, k4, k5, k6}};
}

bool isWide(const Json& camera) {
  const Json &width = member(camera, "SensorWidth"), &height = member(camera, "SensorHeight");
  return width.is_number() && height.is_number() && width.get<double>() * 9 == height.get<double>() * 16;
}

// Each camera's pose maps points of one common frame to its own, in metres.
bool placeCameras(const Json& depth, const Json& color, Registration& registration) {
  const Json &from = member(depth, "Rt"), &to = member(color, "Rt");
  const auto a = numbers<9>(member(from, "Rotation")), b = numbers<9>(member(to, "Rotation"));
  const auto s = numbers<3>(member(from, "Translation")), t = numbers<3>(member(to, "Translation"));
  if (!a || !b || !s || !t || !isRotation(*a) || !isRotation(*b)) return false;
  auto& m = registration.rotation;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      m[3 * i + j] = (*b)[3 * i] * (*a)[3 * j] + (*b)[3 * i + 1] * (*a)[3 * j + 1] + (*b)[3 * i + 2] * (*a)[3 * j + 2];
    }
    const double turned = m[3 * i] * (*s)[0] + m[3 * i + 1] * (*s)[1] + m[3 * i + 2] * (*s)[2];
    registration.translation_mm[i] = kMmPerMetre * ((*t)[i] - turned);
  }
  return true;
}

std::optional<Registration> fromAttachment(const MediaSource& source, const StreamInfo& color,
                                           const StreamInfo& depth) {
  for (const StreamInfo& stream : source.streams()) {
    const auto name = stream.tags.find("FILENAME");
    if (name == stream.tags.end() || name->second != "calibration.json" || stream.extradata.empty()) continue;
    const std::string_view text(reinterpret_cast<const char*>(stream.extradata.data()), stream.extradata.size());
    return parseKinectCalibration(text.substr(0, text.find('\0')), {depth.width, depth.height},
                                  {color.width, color.height});
  }
  return std::nullopt;
}

}  // namespace

std::optional<Registration> parseKinectCalibration(std::string_view json, ModeSize depth, ModeSize color) {
  constexpr bool kThrows = false;
  const Json calibration = Json::parse(json, nullptr, kThrows);
  const auto depth_mode = depthMode(depth), color_mode = colorMode(color);
  if (calibration.is_discarded() || !depth_mode || !color_mode) return std::nullopt;
  const Json &from = cameraAt(calibration, kDepthCamera), &to = cameraAt(calibration, kColorCamera);
  const auto depth_camera = cameraOf(from, *depth_mode, depth, false);
  const auto color_camera = cameraOf(to, *color_mode, color, isWide(to));
  if (!depth_camera || !color_camera) return std::nullopt;
  Registration registration{.depth = *depth_camera, .color = *color_camera};
  return placeCameras(from, to, registration) ? std::optional(registration) : std::nullopt;
}

std::optional<Registration> ownRegistration(const MediaSource& source, const StreamInfo& color,
                                            const StreamInfo& depth) {
  const auto tag = depth.tags.find("DEPTH_REGISTRATION");
  if (tag == depth.tags.end()) return fromAttachment(source, color, depth);
  const auto parsed = parseRegistration(tag->second);
  return parsed ? std::optional(*parsed) : std::nullopt;
}

}  // namespace relievo
