// SPDX-License-Identifier: Apache-2.0
#include "tests/support/device/usb/usb_kinds.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "drivers/falcon/falcon.h"
#include "drivers/falcon/link.h"
#include "drivers/polhem/polhem.h"
#include "drivers/polhem/report.h"
#include "tests/support/device/falcon_model.h"
#include "tests/support/device/polhem_model.h"

namespace relievo::test {
namespace {

// Just powered on: opening it loads the firmware.
UsbBench falconBench() {
  const auto firmware = std::make_shared<FirmwareFile>(500);
  const auto config = [firmware](bool watchdog_thread) {
    return FalconConfig{.firmware_path = firmware->path(), .watchdog_thread = watchdog_thread};
  };
  return {.model = std::make_unique<FalconModel>(firmware->image()),
          .driver = [config](std::unique_ptr<UsbPort> port,
                             Clock& clock) { return makeFalcon(config(false), std::move(port), clock); },
          .driver_on_libusb = [config](Clock& clock) { return makeFalcon(config(true), clock); }};
}

template <std::size_t report_bytes>
UsbBench polhemBench() {
  return {
      .model = std::make_unique<PolhemModel>(polhem::kWoodenHaptics2019, PolhemFaults{.report_bytes = report_bytes}),
      .driver = [](std::unique_ptr<UsbPort> port,
                   Clock& clock) { return makePolhem({.watchdog_thread = false}, std::move(port), clock); },
      .driver_on_libusb = [](Clock& clock) { return makePolhem({}, clock); }};
}

unsigned below(std::mt19937& random, unsigned n) {
  return static_cast<unsigned>(random() % n);
}
std::uint8_t anyByte(std::mt19937& random) {
  return static_cast<std::uint8_t>(random());
}

void spoilFalcon(std::vector<std::uint8_t>& bytes, std::vector<std::uint8_t>& late, std::mt19937& random) {
  const auto at = bytes.begin() + below(random, falcon::kPacketBytes);
  switch (below(random, 6)) {
    case 0:
      bytes[below(random, 16)] = anyByte(random);
      break;
    case 1:  // another valid nibble
      bytes[1 + below(random, 12)] = static_cast<std::uint8_t>('A' + below(random, 16));
      break;
    case 2:  // a part is lost
      bytes.erase(at, bytes.end());
      break;
    case 3:  // a part comes a tick later
      late.assign(at, bytes.end());
      bytes.erase(at, bytes.end());
      break;
    case 4:
      bytes.clear();
      break;
    default:  // something comes before it
      bytes.insert(bytes.begin(), {'<', 'A', '>', anyByte(random)});
  }
}

void spoilPolhem(std::vector<std::uint8_t>& bytes, std::vector<std::uint8_t>& /*late*/, std::mt19937& random) {
  switch (below(random, 5)) {
    case 0:  // one of the most important bytes
      bytes[1 + 2 * below(random, 3)] = anyByte(random);
      break;
    case 1:  // a burst
      for (std::uint8_t& byte : bytes) byte = anyByte(random);
      break;
    case 2:  // a part is lost
      bytes.erase(bytes.begin() + 1 + below(random, 13), bytes.end());
      break;
    case 3:
      bytes.clear();
      break;
    default:  // too many bytes
      bytes.resize(bytes.size() + 1 + below(random, 50), anyByte(random));
  }
}

const std::array kKinds = {
    UsbKind{"falcon", falcon::kUsbId, falconBench, FalconModel::kRestMm, Duration(0), spoilFalcon},
    UsbKind{"mbed", polhem::kMbedId, polhemBench<polhem::kReportBytes>, glm::dvec3(0), PolhemModel::kAnswersIn,
            spoilPolhem},
    UsbKind{"teensy", polhem::kTeensyId, polhemBench<polhem::kPaddedBytes>, glm::dvec3(0), PolhemModel::kAnswersIn,
            spoilPolhem},
};

}  // namespace

FirmwareFile::FirmwareFile(std::size_t bytes) : image_(bytes) {
  std::mt19937 random(7);
  for (std::uint8_t& byte : image_) byte = anyByte(random);
  static int count = 0;
  const std::string name = "relievo-firmware-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
  path_ = std::filesystem::temp_directory_path() / name;
  std::ofstream(path_, std::ios::binary)
      .write(reinterpret_cast<const char*>(image_.data()), static_cast<std::streamsize>(image_.size()));
}

FirmwareFile::~FirmwareFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

std::span<const UsbKind> usbKinds() {
  return kKinds;
}

void PrintTo(const UsbKind& kind, std::ostream* out) {
  *out << kind.name;
}

}  // namespace relievo::test
