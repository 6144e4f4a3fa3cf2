// SPDX-License-Identifier: Apache-2.0
// HDR pictures of 8 bits as a usual screen shows them, by the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <span>
#include <vector>

namespace relievo {

// asSdr by tables: within a code or two of it, at a hundredth of its time.
class SdrTable {
 public:
  // `transfer` and `primaries` as in a Frame. The tables are made anew only where they differ from the last ones.
  void prepare(std::uint8_t transfer, std::uint8_t primaries);
  // Pixels of four bytes; the fourth stays. Nothing is done of a transfer that is not HDR.
  void apply(std::span<std::uint8_t> rgba) const noexcept;

 private:
  template <bool kHasSystemGamma>
  void applyTo(std::span<std::uint8_t> rgba) const noexcept;

  std::uint8_t transfer_ = 0, primaries_ = 0;
  std::array<float, 256> light_{};  // by code; 1 is the most of the transfer
  glm::mat3 to_bt709_{1};
  // By the fourth root of light, in which all of these are smooth.
  std::vector<float> system_, code_, factor_;
};

}  // namespace relievo
