// SPDX-License-Identifier: Apache-2.0
// Any text as a description of a Polhem: it is rejected with a reason, or it describes a valid device.
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "drivers/polhem/arm.h"
#include "drivers/polhem/polhem.h"
#include "tests/fuzz/fuzz_port.h"

namespace relievo::polhem {
namespace {

using test::require;

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void fuzz(const std::string& text) {
  const auto description = parseDescription(text, "arm.json");
  if (!description) {
    require(description.error().thing.starts_with("arm.json"), "a failure names the file");
    require(std::string(description.error().error.message) != "", "and says what is wrong");
    return;
  }
  require(description->variant >= 0 && description->variant <= 2, "no kinematics that are not known");
  const Arm arm(*description);
  for (const EncoderCounts& counts : {EncoderCounts{}, description->calibrate_enc, EncoderCounts{32767, -32768, 32767},
                                      EncoderCounts{5, 5000, -77}}) {
    const glm::dvec3 theta = arm.anglesOf(counts);
    require(finite(arm.positionOf(theta)) && glm::length(arm.positionOf(theta)) < 10'000, "the tip is somewhere");
    require(finite(arm.currentsFor({1, -2, 3}, theta)), "a force has its currents");
  }
  ManualClock clock;
  FuzzedDataProvider none(nullptr, 0);
  const auto device =
      makePolhem({.description = *description, .watchdog_thread = false},
                 std::make_unique<test::FuzzPort>(none, clock, [](UsbBytes) { return std::nullopt; }), clock);
  const HapticCapabilities capabilities = device->capabilities();
  require(capabilities.peak_force_n > 0 && capabilities.peak_force_n <= description->max_linear_force, "a peak");
  require(capabilities.continuous_force_n > 0 && capabilities.continuous_force_n <= capabilities.peak_force_n,
          "what lasts is no more than the peak");
  require(EncoderGate::slackFor(arm.mmPerCount(), 1000) > EncoderGate::kRounding, "the gate lets some motion through");
}

}  // namespace
}  // namespace relievo::polhem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::polhem::fuzz(std::string(reinterpret_cast<const char*>(bytes), size));
  return 0;
}
