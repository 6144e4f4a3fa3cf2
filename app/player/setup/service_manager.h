// SPDX-License-Identifier: Apache-2.0
// Sends systemd the state of the player's service as datagrams of sd_notify(3); sends nothing if systemd has not
// started it. Does not use libsystemd, whose call waits for a manager that does not read.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <string>
#include <string_view>

#include "platform/clock.h"
#include "platform/unique_fd.h"

namespace relievo {

// Use from one thread. No call waits: a message that does not fit is lost, except the watchdog's, which is sent later.
class ServiceManager {
 public:
  // Reads $NOTIFY_SOCKET and $WATCHDOG_USEC.
  ServiceManager() noexcept;

  // Call once, when the devices are open or known to be missing.
  void ready() noexcept { send("READY=1"); }
  // Call once a round of the player's loop. Notifies the watchdog at half its interval; nothing else does.
  void wentRound(MonotonicTime now) noexcept;
  // A few words for `systemctl status`.
  void status(const std::string& text) noexcept;
  void stopping() noexcept { send("STOPPING=1"); }

 private:
  bool send(std::string_view message) noexcept;

  UniqueFd fd_;
  sockaddr_un address_{};
  socklen_t address_bytes_ = 0;
  Duration pause_{0};  // 0: no watchdog
  MonotonicTime next_;
};

}  // namespace relievo
