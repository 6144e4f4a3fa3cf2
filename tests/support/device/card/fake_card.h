// SPDX-License-Identifier: Apache-2.0
// A display card of this program alone: it defines the functions of libdrm and GBM, and the window surfaces of EGL,
// that the display driver calls. It accepts and refuses what a kernel does, and holds the picture that a television
// would show. Link relievo_fake_card into the program.
#pragma once

#include <xf86drmMode.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace relievo::test {

// Row 0 on top.
struct CardPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
  [[nodiscard]] std::array<int, 3> at(int x, int y) const {
    const std::uint8_t* p = rgba.data() + (static_cast<std::size_t>(y) * width + x) * 4;
    return {p[0], p[1], p[2]};
  }
  bool operator==(const CardPicture&) const = default;
};

class FakeCard {
 public:
  // `driver`: "vc4" takes frame packing as two halves, any other driver as one tall picture; each rejects the other's
  // (EINVAL). One card at a time.
  FakeCard(std::string driver, std::vector<drmModeModeInfo> modes);
  ~FakeCard();
  FakeCard(const FakeCard&) = delete;
  FakeCard& operator=(const FakeCard&) = delete;

  // Another program had the screen: HDR, a tint, and a mouse pointer are on. The card may `keep` them: it rejects a
  // commit that changes them.
  void wasUsed(bool keep);
  // The names of what of this is on still.
  [[nodiscard]] std::vector<std::string> left() const;

  [[nodiscard]] std::string path() const;  // for makeKmsDisplay
  // The mode that is set.
  [[nodiscard]] const std::optional<drmModeModeInfo>& mode() const;
  [[nodiscard]] int bufferWidth() const;
  [[nodiscard]] int bufferHeight() const;
  // What goes over the cable in one frame: with frame packing the left eye's rows, black ones for the blanking, and the
  // right eye's.
  [[nodiscard]] CardPicture seen() const;
  [[nodiscard]] int rejected() const;  // commits
};

}  // namespace relievo::test
