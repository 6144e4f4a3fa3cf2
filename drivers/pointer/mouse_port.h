// SPDX-License-Identifier: Apache-2.0
// What the driver needs of a mouse: events as the kernel tells them. A test fakes it.
#pragma once

#include <linux/input.h>

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>

#include "drivers/window/window_input.h"
#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

// One bit each.
constexpr std::uint8_t kLeftButton = 1, kRightButton = 2, kMiddleButton = 4;
// Up and to the right of the middle, where a mouse knows the place that it points at (EV_ABS).
constexpr double kMmPerAbs = 0.01;

// `open` and `close` on the owner's thread; the others on the real-time thread: one system call each, never waiting.
class MousePort {
 public:
  virtual ~MousePort() = default;

  // NotFound, PermissionDenied; Unsupported when it is no mouse.
  [[nodiscard]] virtual Result<void> open() = 0;
  virtual void close() noexcept = 0;
  // How far it points from the middle, right or left, up or down. Known from `open` on.
  [[nodiscard]] virtual glm::dvec2 reachMm() const noexcept { return {100, 75}; }
  // The oldest events that wait, how many; 0 when none do. Lost.
  [[nodiscard]] virtual Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT = 0;
  // Which buttons are down now. Lost.
  [[nodiscard]] virtual Result<std::uint8_t> buttonsDown() RELIEVO_RT = 0;
};

// `path`: /dev/input/eventN, or empty for the first device that has REL_X, REL_Y and BTN_LEFT.
[[nodiscard]] std::unique_ptr<MousePort> makeEvdevPort(std::string path);
// The mouse over a window. NotFound and Lost where there is none.
[[nodiscard]] std::unique_ptr<MousePort> makeWindowPort(std::shared_ptr<WindowInput> input);

}  // namespace relievo
