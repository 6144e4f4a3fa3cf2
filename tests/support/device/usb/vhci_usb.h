// SPDX-License-Identifier: Apache-2.0
// A model on the kernel's virtual host controller: the kernel and usbfs treat it as a real device.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <thread>

#include "platform/unique_fd.h"
#include "tests/support/device/usb/plugged_usb.h"

namespace relievo::test {

// Uses the kernel's USB/IP protocol (Documentation/usb/usbip_protocol.rst) over a pair of sockets, one of which
// vhci_hcd holds.
class VhciUsb final : public PluggedUsb {
 public:
  VhciUsb(UsbModel& model, const UsbDeviceId& id);
  ~VhciUsb() override;
  VhciUsb(const VhciUsb&) = delete;
  VhciUsb& operator=(const VhciUsb&) = delete;

  [[nodiscard]] static bool available();
  void plug() override;
  void unplug() override;
  void unplugAfter(int requests) override;
  void takesNothing() override;
  void takesAgain() override;
  [[nodiscard]] std::mutex& lock() override { return lock_; }

 private:
  struct Waiting {
    std::uint32_t sequence = 0;
    std::size_t most = 0;
  };
  struct Untaken {
    std::uint32_t sequence = 0;
    std::vector<std::uint8_t> data;
  };
  void serve();
  [[nodiscard]] bool takeRequest();
  void answerControl(std::uint32_t sequence, const std::uint8_t* setup, std::size_t length, bool in);
  void giveWhatThereIs();
  void take(const Untaken& command);
  void reply(std::uint32_t sequence, int status, std::size_t actual, UsbBytes data);
  [[nodiscard]] bool readAll(void* into, std::size_t bytes) const;

  UsbModel& model_;
  UsbDeviceId id_;
  UniqueFd socket_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  std::mutex lock_;
  int requests_left_ = 0;  // until it is unplugged; 0: never
  bool deaf_ = false;
  std::deque<Waiting> waiting_;
  std::deque<Untaken> untaken_;
};

}  // namespace relievo::test
