// SPDX-License-Identifier: Apache-2.0
// Interface of a remote control: keys as Linux input event codes.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

struct KeyEvent {
  enum class Action : std::uint8_t { Press, Repeat, Release };
  std::uint16_t code = 0;  // KEY_PLAY, BTN_SOUTH, .. of linux/input-event-codes.h
  Action action = Action::Press;
  MonotonicTime time;
};

// States: Closed -open-> Open -close-> Closed. A call in a state that does not allow it returns InvalidState.
// Thread: one at a time. Blocking: never. A remote that is unplugged yields no more keys; that is no error.
class RemoteInput {
 public:
  enum class State : std::uint8_t { Closed, Open };
  virtual ~RemoteInput() = default;

  [[nodiscard]] Result<void> open();
  // The oldest key event not yet returned, or nullopt. Open only.
  [[nodiscard]] Result<std::optional<KeyEvent>> poll(MonotonicTime now);
  void close() noexcept;
  [[nodiscard]] State state() const noexcept { return state_; }
  // A gamepad is among its devices now.
  [[nodiscard]] virtual bool hasPad() const noexcept { return false; }

 private:
  virtual Result<void> openRemote() = 0;
  virtual Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) = 0;
  virtual void closeRemote() noexcept = 0;

  State state_ = State::Closed;
};

}  // namespace relievo
