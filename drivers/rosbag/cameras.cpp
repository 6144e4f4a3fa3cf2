// SPDX-License-Identifier: Apache-2.0
// Finds camera parameters and transforms by the names of topics: RealSense's layout, and ROS's own.
#include "drivers/rosbag/cameras.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <span>

namespace relievo::rosbag {
namespace {

constexpr double kMmPerMetre = 1000;
constexpr std::size_t kLensCoefficients = 8;
// What is read of transforms: messages of a topic, bytes of a message, and frames of all topics.
constexpr std::size_t kMostMotions = 500, kMostMotionBytes = std::size_t{1} << 20, kMostFrames = 10'000;

std::optional<std::uint32_t> findTopic(const BagFile& bag, const std::string& name) {
  for (const auto& [id, connection] : bag.connections()) {
    if (connection.topic == name && connection.messages > 0) return id;
  }
  return std::nullopt;
}

std::string parentOf(const std::string& topic) {
  return topic.substr(0, topic.find_last_of('/'));
}

// RealSense: "/device_0/sensor_0/Depth_0" of "/device_0/sensor_0/Depth_0/image/data".
std::optional<std::string> streamOf(const std::string& topic) {
  constexpr std::string_view kEnd = "/image/data";
  if (!topic.starts_with("/device_") || !topic.ends_with(kEnd)) return std::nullopt;
  return topic.substr(0, topic.size() - kEnd.size());
}

bool isRectified(const std::string& image) {
  return image.substr(image.find_last_of('/') + 1).starts_with("image_rect");
}

// A camera's message describes its raw pictures. Those that were rectified have the intrinsics of P, and no distortion.
CameraMessage asRectified(CameraMessage camera) {
  const auto& p = camera.projection;
  camera.intrinsics = {p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]};
  camera.distortion.clear();
  return camera;
}

std::optional<CameraMessage> cameraOf(BagFile& bag, const Topic& topic) {
  const std::string image = topic.compressed ? parentOf(topic.name) : topic.name;
  const auto stream = streamOf(topic.name);
  for (const std::string& name : {stream.value_or("") + "/info/camera_info", parentOf(image) + "/camera_info"}) {
    const auto connection = findTopic(bag, name);
    const auto message = connection ? firstMessage(bag, *connection) : std::nullopt;
    if (!message) continue;
    auto camera = parseCamera(*message);
    return camera && isRectified(image) ? asRectified(*camera) : camera;
  }
  return std::nullopt;
}

// k1, k2, p1, p2, k3, k4, k5, k6; nullopt for a lens of a model that is not read here.
std::optional<std::array<double, kLensCoefficients>> lensOf(const CameraMessage& camera) {
  std::array<double, kLensCoefficients> lens{};
  const auto bends = [](double value) { return value != 0; };
  if (std::ranges::none_of(camera.distortion, bends)) return lens;
  const bool known =
      camera.model == "plumb_bob" || camera.model == "rational_polynomial" || camera.model.ends_with("Brown Conrady");
  const std::size_t count = std::min(camera.distortion.size(), kLensCoefficients);
  if (!known || std::ranges::any_of(std::span(camera.distortion).subspan(count), bends)) return std::nullopt;
  std::copy_n(camera.distortion.begin(), count, lens.begin());
  return lens;
}

// RealSense stores each stream's pose relative to a reference stream: the motion that maps the reference's points to
// the stream's.
struct Pose {
  std::string reference;
  Motion motion;
};
std::optional<Pose> poseOf(BagFile& bag, const std::string& stream) {
  const std::string prefix = stream + "/tf/";
  for (const auto& [id, connection] : bag.connections()) {
    if (!connection.topic.starts_with(prefix) || connection.messages == 0) continue;
    const auto message = firstMessage(bag, id);
    if (!message) return std::nullopt;
    const auto motion = parseTransform(*message);
    return motion ? std::optional(Pose{connection.topic.substr(prefix.size()), *motion}) : std::nullopt;
  }
  return std::nullopt;
}

std::string withoutSlash(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

using FrameTree = std::map<std::string, FrameMotion>;  // by child

FrameTree readFrames(BagFile& bag) {
  FrameTree tree;
  for (const auto& [id, connection] : bag.connections()) {
    if (connection.type != "tf2_msgs/TFMessage" && connection.type != "tf/tfMessage") continue;
    eachMessage(bag, id, kMostMotions, [&](const Range& content, const Record& record) {
      if (record.data_bytes > kMostMotionBytes) return true;
      const auto message = readMessage(bag, content, record);
      if (!message) return false;
      for (FrameMotion& motion : parseFrameMotions(*message)) {
        tree.emplace(withoutSlash(motion.child), std::move(motion));
      }
      return tree.size() < kMostFrames;
    });
  }
  return tree;
}

// Maps points of `frame` to the root of its tree.
Pose rootOf(const FrameTree& tree, const std::string& frame) {
  Pose pose{withoutSlash(frame), {}};
  constexpr int kDeepest = 64;  // a loop ends as well
  for (int i = 0; i < kDeepest; ++i) {
    const auto found = tree.find(pose.reference);
    if (found == tree.end()) break;
    pose.motion = chain(pose.motion, found->second.motion);
    pose.reference = withoutSlash(found->second.parent);
  }
  return pose;
}

std::optional<Motion> motionBetween(BagFile& bag, const Topic& depth, const Topic& color) {
  const auto depth_stream = streamOf(depth.name), color_stream = streamOf(color.name);
  if (depth_stream && color_stream) {
    const auto from = poseOf(bag, *depth_stream), to = poseOf(bag, *color_stream);
    if (!from || !to || from->reference != to->reference) return std::nullopt;
    return chain(inverse(from->motion), to->motion);
  }
  const FrameTree tree = readFrames(bag);
  const Pose from = rootOf(tree, depth.first.frame), to = rootOf(tree, color.first.frame);
  if (from.reference != to.reference) return std::nullopt;
  return chain(from.motion, inverse(to.motion));
}

template <std::size_t N>
std::string list(const char* key, const std::array<double, N>& values) {
  std::string text = std::string(key) + " = [";
  for (const double value : values) {
    std::array<char, 40> number{};
    // With a point or an exponent, as TOML wants a float.
    const auto end = std::to_chars(number.data(), number.data() + number.size(), value, std::chars_format::scientific);
    text += std::string(number.data(), end.ptr) + ", ";
  }
  return text + "]\n";
}

std::string table(const char* name, const CameraMessage& camera, const std::array<double, kLensCoefficients>& lens) {
  const auto& k = camera.intrinsics;
  return std::string("[") + name + "]\n" +
         list("size", std::array{static_cast<double>(camera.cols), static_cast<double>(camera.rows)}) +
         list("focal", std::array{k[0], k[4]}) + list("center", std::array{k[2], k[5]}) + list("distortion", lens);
}

bool isSound(const CameraMessage& camera) {
  const auto& k = camera.intrinsics;
  const auto finite = [](double value) { return std::isfinite(value); };
  return camera.cols > 0 && camera.rows > 0 && k[0] > 0 && k[4] > 0 && std::ranges::all_of(k, finite) &&
         std::ranges::all_of(camera.distortion, finite);
}

// The same frame, or a name that says so.
bool isInView(const Topic& depth, const Topic& color) {
  if (streamOf(depth.name)) return false;
  return depth.first.frame == color.first.frame || speaksOf(depth.name, "aligned") ||
         speaksOf(depth.name, "registered");
}

}  // namespace

std::optional<double> unitOf(BagFile& bag, const Topic& depth) {
  if (depth.first.unit_m && *depth.first.unit_m > 0) return static_cast<double>(*depth.first.unit_m) * kMmPerMetre;
  const auto stream = streamOf(depth.name);
  if (!stream) return std::nullopt;
  for (const auto& [id, connection] : bag.connections()) {
    if (!connection.topic.starts_with(parentOf(*stream) + "/option/Depth") || connection.messages == 0) continue;
    if (!speaksOf(connection.topic, "units/value")) continue;
    const auto message = firstMessage(bag, id);
    const float metres = message ? ByteReader(message->bytes).value<float>() : 0;
    if (metres > 0) return static_cast<double>(metres) * kMmPerMetre;
  }
  return std::nullopt;
}

std::optional<std::string> registrationOf(BagFile& bag, const Topic& depth, const Topic& color, double unit_mm) {
  if (isInView(depth, color)) return std::nullopt;
  const auto from = cameraOf(bag, depth), to = cameraOf(bag, color);
  if (!from || !to || !isSound(*from) || !isSound(*to)) return std::nullopt;
  const auto from_lens = lensOf(*from), to_lens = lensOf(*to);
  const auto motion = motionBetween(bag, depth, color);
  if (!from_lens || !to_lens || !motion) return std::nullopt;
  std::array<double, 3> translation_mm = motion->translation_m;
  for (double& value : translation_mm) value *= kMmPerMetre;
  std::string text = table("depth", *from, *from_lens);
  text += "unit_mm = " + std::to_string(unit_mm) + "\n" + table("color", *to, *to_lens);
  return text + "[depth_to_color]\n" + list("rotation", motion->rotation) + list("translation_mm", translation_mm);
}

}  // namespace relievo::rosbag
