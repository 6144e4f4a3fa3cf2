// SPDX-License-Identifier: Apache-2.0
// A simulated mouse, or another input device depending on its codes: a node of /dev/input that answers evdev's requests
// and sends the test's events. Only under `umockdev-wrapper`.
#pragma once

#include <linux/input.h>
#include <umockdev.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/support/device/request_loop.h"

namespace relievo::test {

class UmockdevMouse {
 public:
  // The codes that the device has, by type; they determine its kind.
  using Codes = std::map<std::uint16_t, std::vector<std::uint16_t>>;
  static Codes mouse();
  static Codes keyboard();
  static Codes remote();
  static Codes pad();  // an Xbox pad

  // Creates the node /dev/input/eventN.
  UmockdevMouse(UMockdevTestbed* bed, int number, Codes codes);
  UmockdevMouse(const UmockdevMouse&) = delete;
  UmockdevMouse& operator=(const UmockdevMouse&) = delete;

  void say(std::uint16_t type, std::uint16_t code, std::int32_t value);
  void unplug();
  // Sets the state of a key that the device reports on request.
  void hold(std::uint16_t key, bool down);
  // Before the device is opened: the axis has another range than an Xbox pad's.
  void setRange(unsigned axis, int least, int most) { ranges_[axis] = {.minimum = least, .maximum = most}; }
  // Another program has grabbed it.
  void letOthersGrab() { others_grab_ = true; }
  [[nodiscard]] bool isGrabbed() const { return grabbed_; }
  // The number of unsupported requests.
  [[nodiscard]] int unknownRequests() const { return unknown_; }

 private:
  bool answer(UMockdevIoctlClient* client);
  bool grab(UMockdevIoctlClient* client);
  [[nodiscard]] input_absinfo rangeOf(std::size_t axis) const;

  UMockdevTestbed* bed_;
  std::string node_, device_;
  Codes codes_;
  std::mutex lock_;
  std::vector<std::uint16_t> held_;
  std::atomic<bool> grabbed_ = false, others_grab_ = false;
  std::map<std::size_t, input_absinfo> ranges_;
  int unknown_ = 0;
  RequestLoop requests_;
};

}  // namespace relievo::test
