// SPDX-License-Identifier: Apache-2.0
// systemd's end of $NOTIFY_SOCKET, for programs and code that a test runs while this exists.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "platform/unique_fd.h"

namespace relievo::test {

class NotifySocket {
 public:
  // `watchdog` 0: without.
  NotifySocket(const std::string& path, std::chrono::microseconds watchdog) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    fd_.reset(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    bound_ = ::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    if (watchdog.count() > 0) ::setenv("WATCHDOG_USEC", std::to_string(watchdog.count()).c_str(), 1);
  }
  ~NotifySocket() {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  [[nodiscard]] bool bound() const { return bound_; }
  // The next message; empty if none came in time.
  [[nodiscard]] std::string next(std::chrono::milliseconds wait = std::chrono::milliseconds(0)) const {
    pollfd polled{.fd = fd_.get(), .events = POLLIN};
    if (::poll(&polled, 1, static_cast<int>(wait.count())) <= 0) return "";
    std::array<char, 4096> bytes;
    const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
    return got < 0 ? "" : std::string(bytes.data(), static_cast<std::size_t>(got));
  }
  // All messages so far.
  [[nodiscard]] std::vector<std::string> all() const {
    std::vector<std::string> messages;
    for (std::string each = next(); !each.empty(); each = next()) messages.push_back(each);
    return messages;
  }

 private:
  UniqueFd fd_;
  bool bound_ = false;
};

}  // namespace relievo::test
