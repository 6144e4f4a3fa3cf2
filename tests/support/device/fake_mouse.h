// SPDX-License-Identifier: Apache-2.0
// A mouse whose events come from the test.
#pragma once

#include <algorithm>
#include <deque>
#include <memory>

#include "drivers/pointer/mouse_port.h"

namespace relievo::test {

// The test's control of the mouse.
struct FakeMouse {
  std::deque<input_event> events;
  std::uint8_t down = 0;  // buttons, as the kernel knows them
  bool plugged = true;
  bool comes_back = false;         // it is plugged in again before the next `open`
  bool goes_when_started = false;  // is unplugged after its buttons were read
  bool open = false;

  void say(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    events.push_back({.type = type, .code = code, .value = value});
  }
  void report() { say(EV_SYN, SYN_REPORT, 0); }
  void move(std::int32_t x, std::int32_t y, std::int32_t wheel = 0) {
    if (x != 0) say(EV_REL, REL_X, x);
    if (y != 0) say(EV_REL, REL_Y, y);
    if (wheel != 0) say(EV_REL, REL_WHEEL, wheel);
    report();
  }
  void turn(std::uint16_t key, bool on) {
    say(EV_KEY, key, on ? 1 : 0);
    report();
  }
};

class FakeMousePort final : public MousePort {
 public:
  explicit FakeMousePort(std::shared_ptr<FakeMouse> mouse) : mouse_(std::move(mouse)) {}

  Result<void> open() override {
    if (mouse_->comes_back) mouse_->plugged = true;
    if (!mouse_->plugged) return fail(ErrorCode::NotFound, "no mouse is plugged in");
    mouse_->open = true;
    return {};
  }
  void close() noexcept override { mouse_->open = false; }
  Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT override {
    if (!mouse_->plugged) return gone();
    const std::size_t count = std::min(events.size(), mouse_->events.size());
    std::copy_n(mouse_->events.begin(), count, events.begin());
    mouse_->events.erase(mouse_->events.begin(), mouse_->events.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  Result<std::uint8_t> buttonsDown() RELIEVO_RT override {
    if (!mouse_->plugged) return gone();
    if (mouse_->goes_when_started) mouse_->plugged = false;
    return mouse_->down;
  }

 private:
  static std::unexpected<Error> gone() RELIEVO_RT { return fail(ErrorCode::Lost, "the mouse was unplugged"); }
  std::shared_ptr<FakeMouse> mouse_;
};

}  // namespace relievo::test
