// SPDX-License-Identifier: Apache-2.0
// The haptic devices over USB that there are drivers of: what must hold for each is tested on each.
#pragma once

#include <functional>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "hal/haptic_device.h"
#include "tests/support/device/haptic_model.h"

namespace relievo::test {

// A firmware image of so many bytes in a file of its own, which goes with this.
class FirmwareFile {
 public:
  explicit FirmwareFile(std::size_t bytes);
  ~FirmwareFile();
  FirmwareFile(const FirmwareFile&) = delete;
  FirmwareFile& operator=(const FirmwareFile&) = delete;
  [[nodiscard]] const std::vector<std::uint8_t>& image() const { return image_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::vector<std::uint8_t> image_;
  std::string path_;
};

// One of them. The drivers speak to the model through the port that they are given, or through libusb; on a port the
// watchdog looks from `read` alone.
struct UsbBench {
  std::unique_ptr<HapticModel> model;
  std::function<std::unique_ptr<HapticDevice>(std::unique_ptr<UsbPort>, Clock&)> driver;
  std::function<std::unique_ptr<HapticDevice>(Clock&)> driver_on_libusb;
};

struct UsbKind {
  const char* name;
  UsbDeviceId id;
  UsbBench (*make)();
  glm::dvec3 rest_mm;   // where the hand is once it is homed
  Duration answers_in;  // after a command, with the place of that time
  // Makes of the bytes of an answer what a bad cable does; `late` is what comes before the next.
  void (*spoil)(std::vector<std::uint8_t>& bytes, std::vector<std::uint8_t>& late, std::mt19937& random);
};
[[nodiscard]] std::span<const UsbKind> usbKinds();
void PrintTo(const UsbKind& kind, std::ostream* out);

}  // namespace relievo::test
