// SPDX-License-Identifier: Apache-2.0
// Plugs a model of a USB device into this machine: the real libusb, in this process and in those that it starts, finds
// it and speaks to it through usbfs. Only under `umockdev-wrapper`.
#pragma once

#include <umockdev.h>

#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "drivers/usb/usb_port.h"
#include "tests/support/usb_model.h"

namespace relievo::test {

// Whether umockdev's library was loaded first; without it nothing can be plugged in.
[[nodiscard]] bool machineIsMocked();

class UmockdevUsb {
 public:
  // `model` is called on a thread of this object's, with `lock` held, at the system's monotonic time.
  UmockdevUsb(UsbModel& model, const UsbDeviceId& id);
  ~UmockdevUsb();
  UmockdevUsb(const UmockdevUsb&) = delete;
  UmockdevUsb& operator=(const UmockdevUsb&) = delete;

  void plug();
  void unplug();
  // Take it to look at the model.
  [[nodiscard]] std::mutex& lock() { return lock_; }
  // Requests of the kernel's interface that were not answered, since nobody taught them here.
  [[nodiscard]] int unknownRequests() const { return unknown_; }

 private:
  struct Urb {
    UMockdevIoctlData* urb = nullptr;
    UMockdevIoctlData* buffer = nullptr;
  };
  static gboolean onRequest(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  bool answer(UMockdevIoctlClient* client);
  void submit(UMockdevIoctlData* argument);
  void bulk(UMockdevIoctlData* argument, UMockdevIoctlClient* client);
  bool discard(UMockdevIoctlData* argument);
  void pump();
  void finish(const Urb& urb, int status, std::size_t bytes);

  UsbModel& model_;
  UsbDeviceId id_;
  UMockdevTestbed* bed_ = nullptr;
  UMockdevIoctlBase* handler_ = nullptr;
  GMainContext* context_ = nullptr;
  GMainLoop* loop_ = nullptr;
  std::thread thread_;
  std::mutex lock_;
  bool plugged_ = false;
  int unknown_ = 0;
  std::deque<Urb> waiting_, done_;
};

}  // namespace relievo::test
