// SPDX-License-Identifier: Apache-2.0
// Tone-maps HDR pictures of 8 bits for an SDR screen, on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <span>
#include <vector>

namespace relievo {

// asSdr by tables: within two codes of it, at a hundredth of its time.
class SdrTable {
 public:
  // `transfer` and `primaries` as in a Frame. The tables are made anew only where they differ from the last ones.
  void prepare(std::uint8_t transfer, std::uint8_t primaries);
  // Pixels of four bytes; the fourth is not changed. Does nothing for a transfer that is not HDR.
  void apply(std::span<std::uint8_t> rgba) const noexcept;

 private:
  template <bool kHasSystemGamma>
  void applyTo(std::span<std::uint8_t> rgba) const noexcept;

  std::uint8_t transfer_ = 0, primaries_ = 0;
  std::array<float, 256> light_{};  // by code; 1 is the transfer's maximum
  glm::mat3 to_bt709_{1};
  // Indexed by the fourth root of light, over which all of these are smooth.
  std::vector<float> system_, code_, factor_;
};

}  // namespace relievo
