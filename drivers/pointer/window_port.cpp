// SPDX-License-Identifier: Apache-2.0
// The mouse over a window: its buttons and wheel as input events of the kernel's format, and what it points at.

#include <utility>

#include "drivers/pointer/mouse_port.h"

namespace relievo {
namespace {

constexpr double kReachMm = 1000;  // more than any picture is wide

constexpr std::uint8_t bitsOf(const WindowMouse& mouse) noexcept {
  return static_cast<std::uint8_t>((mouse.left ? kLeftButton : 0U) | (mouse.right ? kRightButton : 0U) |
                                   (mouse.middle ? kMiddleButton : 0U));
}

class WindowPort final : public MousePort {
 public:
  explicit WindowPort(std::shared_ptr<WindowInput> input) : input_(std::move(input)) {}

  Result<void> open() override {
    if (!input_->open) {
      return fail(ErrorCode::NotFound, "there is no window to point in; add --display window");
    }
    input_->mouse.refresh();
    told_ = input_->mouse.front();
    told_.left = told_.right = told_.middle = told_once_ = false;
    return {};
  }
  void close() noexcept override {}

  glm::dvec2 reachMm() const noexcept override { return {kReachMm, kReachMm}; }
  bool overPicture() const noexcept override { return true; }
  const SceneRay* ray() const RELIEVO_RT override { return told_.ray ? &*told_.ray : nullptr; }

  Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT override {
    if (!input_->open.load(std::memory_order_relaxed)) return gone();
    if (!input_->mouse.refresh() && std::exchange(told_once_, true)) return 0;
    told_once_ = true;
    const WindowMouse& mouse = input_->mouse.front();
    std::size_t count = 0;
    const auto say = [&](std::uint16_t type, std::uint16_t code, std::int32_t value) {
      events[count++] = {.type = type, .code = code, .value = value};
    };
    if (mouse.notches != told_.notches) say(EV_REL, REL_WHEEL, mouse.notches - told_.notches);
    if (mouse.left != told_.left) say(EV_KEY, BTN_LEFT, mouse.left ? 1 : 0);
    if (mouse.right != told_.right) say(EV_KEY, BTN_RIGHT, mouse.right ? 1 : 0);
    if (mouse.middle != told_.middle) say(EV_KEY, BTN_MIDDLE, mouse.middle ? 1 : 0);
    say(EV_SYN, SYN_REPORT, 0);
    told_ = mouse;
    return count;
  }

  Result<std::uint8_t> buttonsDown() RELIEVO_RT override {
    if (!input_->open.load(std::memory_order_relaxed)) return gone();
    return bitsOf(told_);
  }

 private:
  static std::unexpected<Error> gone() RELIEVO_RT {
    return fail(ErrorCode::Lost, "the window was closed, so the mouse cannot point any more; open a window again");
  }

  std::shared_ptr<WindowInput> input_;
  WindowMouse told_;
  bool told_once_ = false;
};

}  // namespace

std::unique_ptr<MousePort> makeWindowPort(std::shared_ptr<WindowInput> input) {
  return std::make_unique<WindowPort>(std::move(input));
}

}  // namespace relievo
