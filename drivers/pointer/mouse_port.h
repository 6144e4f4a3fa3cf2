// SPDX-License-Identifier: Apache-2.0
// What the driver needs of a mouse: input events in the kernel's format. Tests fake it.
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

// Bits of `buttonsDown`.
constexpr std::uint8_t kLeftButton = 1, kRightButton = 2, kMiddleButton = 4;
// `open` and `close` on the owner's thread; the others on the real-time thread: one system call each, never waiting.
class MousePort {
 public:
  virtual ~MousePort() = default;

  // NotFound, PermissionDenied; Unsupported if it is no mouse.
  [[nodiscard]] virtual Result<void> open() = 0;
  virtual void close() noexcept = 0;
  // Half the width and half the height of the workspace. Valid after `open`.
  [[nodiscard]] virtual glm::dvec2 reachMm() const noexcept { return {100, 75}; }
  // A mouse over a picture points along a line of sight; any other reports how far it has moved.
  [[nodiscard]] virtual bool overPicture() const noexcept { return false; }
  // That line, as of the last `take`; null if it points at nothing yet.
  [[nodiscard]] virtual const SceneRay* ray() const RELIEVO_RT { return nullptr; }
  // Reads the oldest pending events and returns their number, or 0. Lost.
  [[nodiscard]] virtual Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT = 0;
  // The buttons that are down now. Lost.
  [[nodiscard]] virtual Result<std::uint8_t> buttonsDown() RELIEVO_RT = 0;
};

// `path`: /dev/input/eventN, or empty for the first device that has REL_X, REL_Y and BTN_LEFT.
[[nodiscard]] std::unique_ptr<MousePort> makeEvdevPort(std::string path);
// The mouse over the player's window. NotFound or Lost without a window.
[[nodiscard]] std::unique_ptr<MousePort> makeWindowPort(std::shared_ptr<WindowInput> input);

}  // namespace relievo
