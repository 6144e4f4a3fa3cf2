// SPDX-License-Identifier: Apache-2.0
// State guards of the remote control.
#include "hal/remote_input.h"

namespace relievo {

Result<void> RemoteInput::open() {
  if (state_ != State::Closed) return fail(ErrorCode::InvalidState, "the remote is open already; close it first");
  auto opened = openRemote();
  if (!opened) {
    closeRemote();
    return opened;
  }
  state_ = State::Open;
  return {};
}

Result<std::optional<KeyEvent>> RemoteInput::poll(MonotonicTime now) {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, "the remote is closed; open it first");
  return nextKey(now);
}

void RemoteInput::close() noexcept {
  if (state_ == State::Closed) return;
  closeRemote();
  state_ = State::Closed;
}

}  // namespace relievo
