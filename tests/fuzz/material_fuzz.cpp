// SPDX-License-Identifier: Apache-2.0
// Any text as a material: it is refused, or its printed form reads back as the same, and a device holds it.
#include <cmath>
#include <string_view>

#include "app/scene/material.h"
#include "tests/fuzz/fuzz_port.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  const auto material = parseMaterial({reinterpret_cast<const char*>(bytes), size});
  if (!material) return 0;
  const auto again = parseMaterial(materialText(*material));
  test::require(again.has_value() && *again == *material, "what is printed reads back");
  const HeldMaterial held = heldBy(*material, 0.5, 0.8, 8);
  test::require(held.stiffness_n_per_mm > 0 && held.stiffness_n_per_mm <= 0.8, "the device's stiffness");
  test::require(std::isfinite(held.texture.amplitude_mm) && held.texture.amplitude_mm >= 0, "an amplitude");
  return 0;
}
