// SPDX-License-Identifier: Apache-2.0
// All haptic devices over USB that have a driver, for tests that run on each of them.
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

// A file with a firmware image of that many bytes, deleted by the destructor.
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

// A device's driver and model. The driver uses the model through a given port or through libusb; with a port, only
// `read` checks the watchdog.
struct UsbBench {
  std::unique_ptr<HapticModel> model;
  std::function<std::unique_ptr<HapticDevice>(std::unique_ptr<UsbPort>, Clock&)> driver;
  std::function<std::unique_ptr<HapticDevice>(Clock&)> driver_on_libusb;
};

struct UsbKind {
  const char* name;
  UsbDeviceId id;
  UsbBench (*make)();
  glm::dvec3 rest_mm;   // the hand's position after homing
  Duration answers_in;  // after a command, with the place of that time
  // Corrupts an answer's bytes as a bad cable would; bytes put into `late` come before the next answer.
  void (*spoil)(std::vector<std::uint8_t>& bytes, std::vector<std::uint8_t>& late, std::mt19937& random);
};
[[nodiscard]] std::span<const UsbKind> usbKinds();
void PrintTo(const UsbKind& kind, std::ostream* out);

}  // namespace relievo::test
