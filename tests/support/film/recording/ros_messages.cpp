// SPDX-License-Identifier: Apache-2.0
// Each message is written once, for both serialisations.
#include "tests/support/film/recording/ros_messages.h"

#include "tests/support/byte_writer.h"

namespace relievo::test {
namespace {

class Ros1Writer {
 public:
  template <class T>
  Ros1Writer& add(T value) {
    bytes_.add(value);
    return *this;
  }
  Ros1Writer& text(std::string_view text) { return block(text); }
  Ros1Writer& block(std::string_view data) {
    bytes_.text(data);
    return *this;
  }
  Ros1Writer& header(std::int64_t ns, std::string_view frame) {
    bytes_.add(std::uint32_t{7}).time(ns).text(frame);  // its number, first
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_.bytes(); }

 private:
  ByteWriter bytes_;
};

// Each value at a multiple of its size behind the first four bytes.
class CdrWriter {
 public:
  template <class T>
  CdrWriter& add(T value) {
    while ((bytes_.size() - 4) % sizeof value != 0) bytes_ += '\0';
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  CdrWriter& text(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.append(text) += '\0';
    return *this;
  }
  CdrWriter& block(std::string_view data) {
    add(static_cast<std::uint32_t>(data.size()));
    bytes_.append(data);
    return *this;
  }
  CdrWriter& header(std::int64_t ns, std::string_view frame) {
    return add(static_cast<std::int32_t>(ns / 1'000'000'000))
        .add(static_cast<std::uint32_t>(ns % 1'000'000'000))
        .text(frame);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_{"\0\1\0\0", 4};
};

template <class Writer>
Writer image(const BagImage& image, std::string_view frame) {
  Writer out;
  out.header(image.stamp_ns, frame).add(image.rows).add(image.cols).text(image.encoding);
  return out.add(static_cast<std::uint8_t>(image.big_endian)).add(image.step).block(image.data);
}

template <class Writer>
std::string compressedImage(std::int64_t stamp_ns, std::string_view format, std::string_view data) {
  return Writer().header(stamp_ns, "camera").text(format).block(data).bytes();
}

template <class Writer>
std::string cameraInfo(const BagCamera& camera) {
  Writer out;
  out.header(0, "camera").add(camera.rows).add(camera.cols).text(camera.model);
  out.add(static_cast<std::uint32_t>(camera.distortion.size()));
  for (const double d : camera.distortion) out.add(d);
  for (const double k : {camera.focal_x, 0.0, camera.center_x, 0.0, camera.focal_y, camera.center_y, 0.0, 0.0, 1.0}) {
    out.add(k);
  }
  for (int i = 0; i < 9; ++i) out.add(0.0);  // R
  for (const double p : camera.projection) out.add(p);
  for (int i = 0; i < 6; ++i) out.add(std::uint32_t{0});  // binning, region
  return out.add(std::uint8_t{0}).bytes();
}

template <class Writer>
Writer& transform(Writer& out, const std::array<double, 3>& translation_m, const std::array<double, 4>& rotation) {
  for (const double value : translation_m) out.add(value);
  for (const double value : rotation) out.add(value);
  return out;
}

template <class Writer>
std::string frameMotion(std::string_view parent, std::string_view child, const std::array<double, 3>& translation_m,
                        const std::array<double, 4>& rotation) {
  Writer out;
  out.add(std::uint32_t{1}).header(0, parent).text(child);
  return transform(out, translation_m, rotation).bytes();
}

}  // namespace

std::string bagImage(const BagImage& image) {
  auto out = test::image<Ros1Writer>(image, image.unit_m > 0 ? "1" : image.frame);
  if (image.unit_m > 0) out.add(image.unit_m);
  return out.bytes();
}
std::string bagCompressedImage(std::int64_t stamp_ns, std::string_view format, std::string_view data) {
  return compressedImage<Ros1Writer>(stamp_ns, format, data);
}
std::string bagCameraInfo(const BagCamera& camera) {
  return cameraInfo<Ros1Writer>(camera);
}
std::string bagTransform(const std::array<double, 3>& translation_m, const std::array<double, 4>& rotation) {
  Ros1Writer out;
  return transform(out, translation_m, rotation).bytes();
}
std::string bagFrameMotion(std::string_view parent, std::string_view child, const std::array<double, 3>& translation_m,
                           const std::array<double, 4>& rotation) {
  return frameMotion<Ros1Writer>(parent, child, translation_m, rotation);
}

std::string ros2Image(const BagImage& image) {
  return test::image<CdrWriter>(image, image.frame).bytes();
}
std::string ros2CompressedImage(std::int64_t stamp_ns, std::string_view format, std::string_view data) {
  return compressedImage<CdrWriter>(stamp_ns, format, data);
}
std::string ros2CameraInfo(const BagCamera& camera) {
  return cameraInfo<CdrWriter>(camera);
}
std::string ros2FrameMotion(std::string_view parent, std::string_view child, const std::array<double, 3>& translation_m,
                            const std::array<double, 4>& rotation) {
  return frameMotion<CdrWriter>(parent, child, translation_m, rotation);
}

}  // namespace relievo::test
