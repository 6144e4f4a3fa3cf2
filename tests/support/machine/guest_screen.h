// SPDX-License-Identifier: Apache-2.0
// The screens of toolchain/guest --screens: reads back what one shows, and plugs or unplugs each.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/unique_fd.h"

namespace relievo::test {

inline constexpr const char* kNoGuest = "run it by toolchain/guest --screens";

struct ScreenDump {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // the top row first

  [[nodiscard]] std::array<int, 3> at(int x, int y) const {
    const std::uint8_t* p = rgb.data() + (static_cast<std::size_t>(y) * width + x) * 3;
    return {p[0], p[1], p[2]};
  }
};

// A file of portable pixels (PPM, P6).
[[nodiscard]] ScreenDump readPixels(const std::string& path);

class GuestScreen {
 public:
  // `driver`: of the card, "virtio" or "vkms". Null outside of the guest.
  [[nodiscard]] static std::unique_ptr<GuestScreen> find(const std::string& driver);
  ~GuestScreen() { plug(true); }
  GuestScreen(const GuestScreen&) = delete;
  GuestScreen& operator=(const GuestScreen&) = delete;

  [[nodiscard]] const std::string& card() const noexcept { return card_; }  // "/dev/dri/card0"
  // Simulates plugging or unplugging the cable; the kernel notifies all programs.
  void plug(bool in) const;
  // The picture on QEMU's screen; only for virtio.
  [[nodiscard]] ScreenDump dump();

 private:
  GuestScreen(std::string card, std::string status) : card_(std::move(card)), status_(std::move(status)) {}
  std::string card_, status_;
  UniqueFd monitor_;
};

}  // namespace relievo::test
