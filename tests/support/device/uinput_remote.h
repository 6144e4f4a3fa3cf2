// SPDX-License-Identifier: Apache-2.0
// A remote control that the kernel creates and removes (uinput).
#pragma once

#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

#include <vector>

namespace relievo::test {

inline constexpr const char* kNoUinput = "/dev/uinput is not there; toolchain/guest has one";

class UinputRemote {
 public:
  [[nodiscard]] static bool available() { return ::access("/dev/uinput", W_OK) == 0; }

  // With these keys: KEY_OK, ..
  explicit UinputRemote(const std::vector<unsigned>& keys) {
    libevdev* const codes = libevdev_new();
    libevdev_set_name(codes, "infra-red");
    for (const unsigned key : keys) libevdev_enable_event_code(codes, EV_KEY, key, nullptr);
    libevdev_uinput_create_from_device(codes, LIBEVDEV_UINPUT_OPEN_MANAGED, &device_);
    libevdev_free(codes);
  }
  ~UinputRemote() {
    if (device_ != nullptr) libevdev_uinput_destroy(device_);
  }
  UinputRemote(const UinputRemote&) = delete;
  UinputRemote& operator=(const UinputRemote&) = delete;

  // 1: pressed, 0: let go.
  void press(unsigned key, int value) {
    libevdev_uinput_write_event(device_, EV_KEY, key, value);
    libevdev_uinput_write_event(device_, EV_SYN, SYN_REPORT, 0);
  }

 private:
  libevdev_uinput* device_ = nullptr;
};

}  // namespace relievo::test
