// SPDX-License-Identifier: Apache-2.0
// Reads serialised messages by their published definitions.
#include "drivers/rosbag/messages.h"

#include <algorithm>
#include <cmath>

namespace relievo::rosbag {
namespace {

// Reads the values of a message one after another. In CDR each value lies at a multiple of its size behind the four
// bytes that name the coding, and a text ends with a zero byte.
class MessageReader {
 public:
  explicit MessageReader(const Message& message) noexcept : bytes_(message.bytes), cdr_(message.cdr) {
    constexpr std::array<std::uint8_t, 2> kLittleEndian{0, 1};
    if (cdr_) sound_ = std::ranges::equal(bytes_.take(kCoding).first(bytes_.ok() ? 2 : 0), kLittleEndian);
  }

  template <class T>
  [[nodiscard]] T value() noexcept {
    if (cdr_) static_cast<void>(bytes_.take((kCoding - bytes_.position()) % sizeof(T)));
    return bytes_.value<T>();
  }
  [[nodiscard]] Bytes block() noexcept { return bytes_.take(value<std::uint32_t>()); }
  [[nodiscard]] std::string text() {
    const Bytes bytes = block();
    std::string text(bytes.begin(), bytes.end());
    if (cdr_ && text.ends_with('\0')) text.pop_back();
    return text;
  }
  [[nodiscard]] Duration time() noexcept {
    const auto seconds = value<std::uint32_t>();
    return std::chrono::seconds(seconds) + Duration(value<std::uint32_t>());
  }
  [[nodiscard]] std::size_t position() const noexcept { return bytes_.position(); }
  [[nodiscard]] std::size_t left() const noexcept { return bytes_.left(); }
  [[nodiscard]] bool ok() const noexcept { return sound_ && bytes_.ok(); }
  [[nodiscard]] bool cdr() const noexcept { return cdr_; }

 private:
  static constexpr std::size_t kCoding = 4;
  ByteReader bytes_;
  bool cdr_;
  bool sound_ = true;
};

// std_msgs/Header
struct Header {
  Duration stamp{0};
  std::string frame;
};
Header readHeader(MessageReader& reader) {
  if (!reader.cdr()) static_cast<void>(reader.value<std::uint32_t>());  // a counter
  const Duration stamp = reader.time();
  return {stamp, reader.text()};
}

constexpr double kLengthToWithin = 1e-2;  // of a quaternion

std::optional<Motion> readTransform(MessageReader& reader) {
  Motion motion;
  for (double& value : motion.translation_m) value = reader.value<double>();
  std::array<double, 4> q{};
  for (double& value : q) value = reader.value<double>();
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!reader.ok() || !(std::abs(length - 1) < kLengthToWithin)) return std::nullopt;
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  motion.rotation = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                     2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                     2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  return motion;
}

}  // namespace

std::optional<Duration> parseStamp(Bytes message) {
  ByteReader reader(message);
  static_cast<void>(reader.value<std::uint32_t>());  // ROS 1's counter, or the coding of CDR
  const Duration stamp = takeTime(reader);
  return reader.ok() ? std::optional(stamp) : std::nullopt;
}

std::optional<PictureMessage> parsePicture(const Message& message, bool compressed) {
  MessageReader reader(message);
  const Header header = readHeader(reader);
  PictureMessage picture{.stamp = header.stamp, .frame = header.frame, .encoding = {}, .compressed = compressed};
  if (!compressed) {
    picture.rows = reader.value<std::uint32_t>();
    picture.cols = reader.value<std::uint32_t>();
  }
  picture.encoding = reader.text();
  if (!compressed) {
    picture.big_endian = reader.value<std::uint8_t>() != 0;
    picture.step_bytes = reader.value<std::uint32_t>();
  }
  picture.data_bytes = reader.block().size();
  picture.data_begin = reader.position() - picture.data_bytes;
  if (!reader.ok()) return std::nullopt;
  // RealSense writes "1" instead of a frame's name, and the unit of depth behind the picture.
  if (!compressed && !message.cdr && header.frame == "1" && reader.left() == sizeof(float))
    picture.unit_m = reader.value<float>();
  return picture;
}

std::optional<CameraMessage> parseCamera(const Message& message) {
  MessageReader reader(message);
  static_cast<void>(readHeader(reader));
  CameraMessage camera;
  camera.rows = reader.value<std::uint32_t>();
  camera.cols = reader.value<std::uint32_t>();
  camera.model = reader.text();
  const auto count = reader.value<std::uint32_t>();
  constexpr std::uint32_t kMostCoefficients = 64;
  if (count > kMostCoefficients) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) camera.distortion.push_back(reader.value<double>());
  for (double& value : camera.intrinsics) value = reader.value<double>();
  for (int i = 0; i < 9; ++i) static_cast<void>(reader.value<double>());  // R: how a stereo camera's views were turned
  for (double& value : camera.projection) value = reader.value<double>();
  return reader.ok() ? std::optional(camera) : std::nullopt;
}

Motion inverse(const Motion& motion) noexcept {
  const auto& m = motion.rotation;
  Motion back{.rotation = {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}};
  const auto& t = motion.translation_m;
  for (std::size_t i = 0; i < 3; ++i) {
    back.translation_m[i] =
        -(back.rotation[3 * i] * t[0] + back.rotation[3 * i + 1] * t[1] + back.rotation[3 * i + 2] * t[2]);
  }
  return back;
}

Motion chain(const Motion& first, const Motion& second) noexcept {
  Motion both;
  for (std::size_t i = 0; i < 3; ++i) {
    const double* const row = &second.rotation[3 * i];
    for (std::size_t j = 0; j < 3; ++j) {
      both.rotation[3 * i + j] =
          row[0] * first.rotation[j] + row[1] * first.rotation[3 + j] + row[2] * first.rotation[6 + j];
    }
    const auto& t = first.translation_m;
    both.translation_m[i] = row[0] * t[0] + row[1] * t[1] + row[2] * t[2] + second.translation_m[i];
  }
  return both;
}

std::optional<Motion> parseTransform(const Message& message) {
  MessageReader reader(message);
  return readTransform(reader);
}

std::vector<FrameMotion> parseFrameMotions(const Message& message) {
  MessageReader reader(message);
  std::vector<FrameMotion> motions;
  const auto count = reader.value<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && reader.ok(); ++i) {
    FrameMotion motion;
    motion.parent = readHeader(reader).frame;
    motion.child = reader.text();
    const auto moved = readTransform(reader);
    if (!moved) break;
    motion.motion = *moved;
    motions.push_back(std::move(motion));
  }
  return motions;
}

}  // namespace relievo::rosbag
