// SPDX-License-Identifier: Apache-2.0
// The mouse over a window, as input events of the kernel's format: the changes since the last call.
#include <algorithm>
#include <utility>

#include "drivers/pointer/mouse_port.h"

namespace relievo {
namespace {

// The default volume is 160 mm wide; the soft edge of a workspace is 4 mm wide.
constexpr double kHalfWidthMm = 80, kSoftEdgeMm = 4;

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
    told_.left = told_.right = told_.middle = false;
    place_told_ = false;
    half_height_mm_ = kHalfWidthMm * told_.height_px / std::max(told_.width_px, 1);
    return {};
  }
  void close() noexcept override {}

  // Has the window's aspect ratio. The player shows the largest picture that fits into the window, and maps the
  // smallest workspace that covers the picture; so one millimetre here is one there, and the finger is where the mouse
  // points.
  glm::dvec2 reachMm() const noexcept override { return {kHalfWidthMm + kSoftEdgeMm, half_height_mm_ + kSoftEdgeMm}; }

  Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT override {
    if (!input_->open.load(std::memory_order_relaxed)) return gone();
    if (!input_->mouse.refresh() && std::exchange(place_told_, true)) return 0;
    place_told_ = true;
    const WindowMouse& mouse = input_->mouse.front();
    std::size_t count = 0;
    const auto say = [&](std::uint16_t type, std::uint16_t code, std::int32_t value) {
      events[count++] = {.type = type, .code = code, .value = value};
    };
    const double mm_a_px =
        std::max(2 * kHalfWidthMm / std::max(mouse.width_px, 1), 2 * half_height_mm_ / std::max(mouse.height_px, 1));
    say(EV_ABS, ABS_X, static_cast<std::int32_t>(mouse.right_px * mm_a_px / kMmPerAbs));
    say(EV_ABS, ABS_Y, static_cast<std::int32_t>(mouse.up_px * mm_a_px / kMmPerAbs));
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
  bool place_told_ = false;
  double half_height_mm_ = 0;
};

}  // namespace

std::unique_ptr<MousePort> makeWindowPort(std::shared_ptr<WindowInput> input) {
  return std::make_unique<WindowPort>(std::move(input));
}

}  // namespace relievo
