// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/recording_place.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "app/media/reading/beside/depthkit_file.h"
#include "app/media/reading/beside/lerobot_file.h"
#include "app/media/reading/float_reading.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_place.h"
#include "platform/print.h"
#include "platform/text/lower_case.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string number(double value) {
  return print("%.6g", value);
}

std::optional<Json> readJson(const fs::path& path) {
  const auto text = readWholeFile(path.string(), FileSize::Settings, "cannot be read");
  if (!text) return std::nullopt;
  Json json = Json::parse(*text, nullptr, false);
  return json.is_object() ? std::optional(std::move(json)) : std::nullopt;
}

std::optional<double> numberIn(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

// Each tells the mm of a code.
using Scale = std::optional<double>;

Scale ofMetre(Scale codes) {
  return codes && *codes > 0 ? std::optional(1000 / *codes) : std::nullopt;
}
Scale inMetres(Scale metres) {
  return metres ? std::optional(1000 * *metres) : std::nullopt;
}

// NICE-SLAM's Replica: {"camera": {.., "scale": 6553.5}}, in codes a metre.
Scale scaleOfReplica(const Json& json) {
  const auto camera = json.find("camera");
  return camera != json.end() && camera->is_object() ? ofMetre(numberIn(*camera, "scale")) : std::nullopt;
}

// BOP: {"0": {"cam_K": [..], "depth_scale": 0.1}, "1": ..}, or one camera.json for all of a data set.
Scale scaleOfBop(const Json& json) {
  if (const auto scale = numberIn(json, "depth_scale")) return scale;
  for (const Json& picture : json) {
    if (!picture.is_object()) continue;
    if (const auto scale = numberIn(picture, "depth_scale")) return scale;
  }
  return std::nullopt;
}

// Open3D's recorder: {"depth_scale": 1000.0, "intrinsic_matrix": [..], ..}, in codes a metre.
Scale scaleOfOpen3d(const Json& json) {
  return ofMetre(numberIn(json, "depth_scale"));
}

// Cameras of NeRFs: nerfstudio's and instant-ngp's keys, metres a code.
Scale scaleOfNerf(const Json& json) {
  const auto scale = numberIn(json, "depth_unit_scale_factor");
  return inMetres(scale ? scale : numberIn(json, "integer_depth_scale"));
}

// NVIDIA's Falling Things and its relatives: always 10000 codes a metre.
Scale scaleOfFallingThings(const Json& json) {
  return json.contains("camera_settings") ? std::optional(0.1) : std::nullopt;
}

struct CameraFile {
  const char *name, *kind;
  Scale (*scale)(const Json&);
};
constexpr CameraFile kCameraFiles[] = {
    {"scene_camera.json", "bop", scaleOfBop},
    {"camera.json", "bop", scaleOfBop},
    {"cam_params.json", "replica", scaleOfReplica},
    {"camera_intrinsic.json", "bop", scaleOfOpen3d},
    {"intrinsic.json", "bop", scaleOfOpen3d},
    {"transforms.json", "bop", scaleOfNerf},
    {"_camera_settings.json", "bop", scaleOfFallingThings},
};

RecordingPlace lookForScale(const fs::path& folder) {
  constexpr int kFoldersUp = 4;
  fs::path at = folder;
  for (int i = 0; i < kFoldersUp; ++i) {
    for (const CameraFile& camera : kCameraFiles) {
      const auto json = readJson(at / camera.name);
      const auto scale = json ? camera.scale(*json) : std::nullopt;
      if (!scale || !(*scale > 0)) continue;
      return {findKind(camera.kind),
              CalibrationOrigin::FileBeside,
              {{"unit", number(*scale)}},
              print("%s says that a code is %g mm", (at / camera.name).c_str(), *scale),
              (at / camera.name).string()};
    }
    if (!at.has_parent_path() || at.parent_path() == at) break;
    at = at.parent_path();
  }
  return {};
}

bool hasDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

// "1305031102.175304": seconds with a fraction, with so many digits before it.
bool isSeconds(std::string_view stem, std::size_t digits = 9) {
  const std::size_t dot = std::min(stem.find('.'), stem.size());
  return dot >= digits && hasDigits(stem.substr(0, dot)) && dot < stem.size() && hasDigits(stem.substr(dot + 1));
}

// "d-1294886360.208451-2996770081"
bool isRawNyu(std::string_view stem) {
  return stem.starts_with("d-") && isSeconds(stem.substr(2, stem.rfind('-') - 2));
}

bool isTum(const fs::path& path, const fs::path& folder) {
  const fs::path above = folder.parent_path();
  // Beside color/ the pictures tell the unit: recorders in mm name them so (OpenLORIS, ROS).
  const auto lists = [&above](const char* name) { return isRegularFile(above / name); };
  const bool beside_rgb = folder.filename() == "depth" && isFolder(above / "rgb");
  return (isSeconds(path.stem().string(), beside_rgb ? 1 : 9) && !isFolder(above / "color")) ||
         lists("associations.txt") || lists("associate.txt") || lists("association.txt") || lists("assoc.txt") ||
         (lists("depth.txt") && lists("rgb.txt"));
}

// Replica as NICE-SLAM renders it: "results/frame000000.jpg", "results/depth000000.png", "traj.txt".
bool isNiceSlam(const fs::path& path, const fs::path& folder) {
  const std::string stem = path.stem().string();
  return folder.filename() == "results" && stem.starts_with("depth") && hasDigits(std::string_view(stem).substr(5)) &&
         isRegularFile(folder.parent_path() / "traj.txt");
}

// SceneNet RGB-D: "photo/25.jpg", "depth/25.png" and "instance/25.png".
bool isSceneNet(const fs::path& folder) {
  const fs::path above = folder.parent_path();
  return folder.filename() == "depth" && isFolder(above / "photo") && isFolder(above / "instance");
}

RecordingPlace asTum() {
  return {findKind("tum"), CalibrationOrigin::Name, {}, "names and lists as TUM's"};
}

RecordingPlace named(const char* kind, const char* sign) {
  return {findKind(kind), CalibrationOrigin::Name, {}, print("the name has %s", sign)};
}

// In this order: the more specific sign first.
RecordingPlace lookAtNames(const fs::path& path, const fs::path& folder) {
  struct Sign {
    const char *word, *kind;
  };
  constexpr Sign kSigns[] = {
      {"disp_occ", "kitti-disparity"},
      {"disp_noc", "kitti-disparity"},
      {"proj_depth", "kitti"},
      {"velodyne_raw", "kitti"},
      {"depth_selection", "kitti"},

      {"vkitti", "vkitti"},
      {"virtual_kitti", "vkitti"},
      {"depth/camera_0/depth_", "vkitti"},
      {"depth/camera_1/depth_", "vkitti"},
      {"undistorted_depth_images", "matterport"},
      {"matterport_depth_images", "matterport"},
      {"kitti", "kitti"},
      {"domain_depth", "taskonomy"},
      {"sunrgbd", "sun"},
      {"sun3d", "sun"},
      {"depth_bfx", "sun"},
      {"living_room_traj", "icl"},
      {"office_room_traj", "icl"},
      {"icl-nuim", "icl"},
      {"icl_nuim", "icl"},
      {"interiornet", "interiornet"},
      {"/depth0/data/", "interiornet"},
      {"scenenet", "scenenet"},
      {"rgbd_dataset_freiburg", "tum"},
      {"aligned_depth", "mm"},  // RealSense's; OpenLORIS has TUM's layout
      {".geometric.png", "co3d"},
      {".depth.png", "mm"},
      {"/depth_bw/", "near-dark"},
      {"/mist/", "near-dark"},  // Blender's pass: from 0 at its start to 1 in the distance
      {"scannet", "scannet"},
      {"record3d", "record3d"},
      {"worlddepth", "unreal"},
      {"heightmap", "heights"},
      {"height_map", "heights"},
      {"elevation", "heights"},
  };
  if (isRawNyu(path.stem().string())) {
    // The picture reader has already put a PGM's bytes in order.
    return named(path.extension() == ".pgm" ? "kinect-raw" : "nyu-raw", "NYU's form d-SECONDS-TICKS");
  }
  if (matterportLetter(path.filename().string()) == 'd') return named("matterport", "Matterport3D's form HEX_d0_0");
  const std::string words = lowerCase(path.string());
  for (const Sign& sign : kSigns) {
    if (words.find(sign.word) != std::string::npos) return named(sign.kind, sign.word);
  }
  if (isNiceSlam(path, folder)) return named("replica", "NICE-SLAM's form results/depth000000 beside traj.txt");
  if (isSceneNet(folder)) return named("scenenet", "SceneNet's form depth beside photo and instance");
  if (isTum(path, folder)) return asTum();
  return {};
}

// Middlebury's names of disparities and of the view that they belong to.
bool hasView(const fs::path& path, const fs::path& folder, const char* disparities, const char* view) {
  return path.stem() == disparities && path.extension() == ".png" && isRegularFile(folder / view);
}

// Middlebury's calib.txt. Its cameras are used if the name or --as says that the numbers are disparities.
// The pictures of 2005 and 2006 are all of one pair of cameras; those of 2001 and 2003 are of unknown ones.
void addStereoCamera(const fs::path& path, const fs::path& folder, RecordingPlace& place) {
  const fs::path file = folder / "calib.txt";
  place.camera = stereoCameraIn(file);
  if (place.camera) place.file = file.string();
  if (place.kind != nullptr) return;
  place.origin = CalibrationOrigin::Name;
  if (place.camera) {
    if (!namesDisparity(path.string()).value_or(lowerCase(path.extension().string()) == ".pfm")) return;
    place.origin = CalibrationOrigin::FileBeside;
    place.why = print("%s has the cameras, %.4g mm apart", file.c_str(), place.camera->baseline_mm);
  } else if (hasView(path, folder, "disp1", "view1.png")) {
    place.camera = stereoCameraOf2006(folder / "dmin.txt");
    place.file = (folder / "dmin.txt").string();
    place.why = "its files are named as Middlebury's of 2005 and 2006";
  } else if (hasView(path, folder, "disp2", "im2.png") || hasView(path, folder, "disp2", "im2.ppm")) {
    place.why = "its files are named as Middlebury's of 2001 and 2003";
  } else {
    return;
  }
  place.kind = findKind("middlebury");
}

}  // namespace

RecordingPlace lookAtPlace(const std::string& url, const std::string& depth_url, const std::string& layout) {
  const std::string& depth = depth_url.empty() ? url : depth_url;
  if (depth.find("://") != std::string::npos || depth.starts_with("v4l2:")) return {};
  std::error_code error;
  const fs::path path = fs::absolute(depth, error);
  if (error) return {};
  const fs::path folder = isFolder(path) ? path : path.parent_path();
  if (auto depthkit = lookForDepthkit(path); depthkit.kind != nullptr) return depthkit;
  if (auto lerobot = lookForLeRobot(path); lerobot.kind != nullptr) return lerobot;
  if (auto scale = lookForScale(folder); scale.kind != nullptr) return scale;
  RecordingPlace place = layout == "tum" ? asTum() : lookAtNames(path, folder);
  addStereoCamera(path, folder, place);
  return place;
}

RecordingPlace lookAtTags(const std::map<std::string, std::string>& tags) {
  for (const auto& [key, value] : tags) {
    if (!value.starts_with('{')) continue;
    const Json json = Json::parse(value, nullptr, false);
    if (!json.is_object() || !json.contains("intrinsicMatrix")) continue;
    double near = 0, far = 3;
    const auto range = json.find("rangeOfEncodedDepth");
    if (range != json.end() && range->is_array() && range->size() == 2 && (*range)[0].is_number() &&
        (*range)[1].is_number()) {
      near = (*range)[0];
      far = (*range)[1];
    }
    if (!(near >= 0 && far > near && far < 1e6)) continue;
    return {findKind("record3d"),
            CalibrationOrigin::ContainerTags,
            {{"near", number(std::max(1e-3, 1000 * near))}, {"far", number(1000 * far)}},
            print("the tag %s has the camera of Record3D, hue over %g to %g m", key.c_str(), near, far)};
  }
  return {};
}

}  // namespace relievo
