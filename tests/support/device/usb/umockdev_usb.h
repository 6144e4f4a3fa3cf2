// SPDX-License-Identifier: Apache-2.0
// Plugs a model of a USB device into a machine that umockdev simulates: the real libusb, in this process and in its
// children, finds it and uses it through usbfs. Only if umockdev's library is preloaded.
#pragma once

#include <umockdev.h>

#include <deque>
#include <map>
#include <string>

#include "tests/support/device/request_loop.h"
#include "tests/support/device/usb/plugged_usb.h"

namespace relievo::test {

class UmockdevUsb final : public PluggedUsb {
 public:
  UmockdevUsb(UsbModel& model, const UsbDeviceId& id);
  ~UmockdevUsb() override;
  UmockdevUsb(const UmockdevUsb&) = delete;
  UmockdevUsb& operator=(const UmockdevUsb&) = delete;

  void plug() override;
  void unplug() override;
  void unplugAfter(int requests) override;
  // The kernel does not accept the transfer of this number from now on.
  void refuseSubmit(int number);
  // Reads that the kernel has.
  [[nodiscard]] std::size_t waiting();
  void takesNothing() override;
  void takesAgain() override;
  [[nodiscard]] std::mutex& lock() override { return lock_; }
  [[nodiscard]] int unknownRequests() const override { return unknown_; }

 private:
  struct Urb {
    UMockdevIoctlData* urb = nullptr;
    UMockdevIoctlData* buffer = nullptr;
  };
  bool answer(UMockdevIoctlClient* client);
  [[nodiscard]] bool submit(UMockdevIoctlData* argument);
  void take(const Urb& urb);
  void bulk(UMockdevIoctlData* argument, UMockdevIoctlClient* client);
  bool discard(UMockdevIoctlData* argument);
  void pump();
  void finish(const Urb& urb, int status, std::size_t bytes);

  UsbModel& model_;
  UsbDeviceId id_;
  UMockdevTestbed* bed_ = nullptr;
  std::mutex lock_;
  bool plugged_ = false;
  int requests_left_ = 0;  // until it is unplugged; 0: never
  int submits_left_ = 0;   // until one is refused; 0: none is
  bool deaf_ = false;
  int unknown_ = 0;
  std::deque<Urb> waiting_, untaken_, done_;  // IN, OUT, and what may be reaped
  RequestLoop requests_;
};

}  // namespace relievo::test
