// SPDX-License-Identifier: Apache-2.0
// An Inverse3 behind its service, on a clock of its own.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <utility>

#include "drivers/inverse3/inverse3.h"
#include "tests/support/device/inverse3_service.h"

namespace relievo::test {

using Version = Inverse3Service::Version;

inline constexpr Duration kTick = std::chrono::milliseconds(1);

// An emulator, and the driver on it.
struct Bench {
  explicit Bench(Version version, unsigned seed = 1) : service(version, seed) {
    auto own = std::make_unique<EmulatedWire>(service, clock);
    wire = own.get();
    device = makeInverse3({.watchdog_thread = false}, std::move(own), clock);
  }
  [[nodiscard]] Result<void> bringUp() {
    for (auto verb : {&HapticDevice::open, &HapticDevice::home, &HapticDevice::start}) {
      if (auto done = ((*device).*verb)(); !done) return done;
    }
    return {};
  }
  Result<HapticSample> tick(const glm::dvec3& force_n = {}) {
    auto sample = device->read();
    if (sample) {
      if (auto written = device->write(force_n); !written) return std::unexpected(written.error());
    }
    clock.advance(kTick);
    return sample;
  }
  // Pushes until the force has faded in.
  void push(const glm::dvec3& force_n) {
    for (int i = 0; i < 600; ++i) ASSERT_TRUE(tick(force_n));
  }

  ManualClock clock{MonotonicTime(std::chrono::hours(1))};
  Inverse3Service service;
  EmulatedWire* wire = nullptr;
  std::unique_ptr<HapticDevice> device;
};

class Inverse3Device : public testing::TestWithParam<Version> {
 protected:
  Bench bench{GetParam()};
};

}  // namespace relievo::test
