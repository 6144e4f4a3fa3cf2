// SPDX-License-Identifier: Apache-2.0
// What systemd is told when it has started the player as a service, in the datagrams of sd_notify(3); nothing when it
// has not. Not by libsystemd: its call waits for a manager that does not read, and a film must not.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <string>
#include <string_view>

#include "platform/clock.h"
#include "platform/unique_fd.h"

namespace relievo {

// One thread. Nothing waits: a message that finds no room is lost, but for the watchdog's, which goes out later.
class ServiceManager {
 public:
  // Takes $NOTIFY_SOCKET and $WATCHDOG_USEC.
  ServiceManager() noexcept;

  // The devices are open, or are known to be missing. Once.
  void ready() noexcept { send("READY=1"); }
  // The player's loop has gone round once more. The watchdog hears of it at half its interval, and of nothing else.
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
