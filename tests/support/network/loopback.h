// SPDX-License-Identifier: Apache-2.0
// Sockets of the loopback interface.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "platform/clock.h"
#include "platform/unique_fd.h"

namespace relievo::test {

[[nodiscard]] inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

// With SOCK_STREAM it also listens. Port 0: any free one.
[[nodiscard]] inline UniqueFd bindLoopback(int type, std::uint16_t port = 0) {
  UniqueFd fd(::socket(AF_INET, type | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in address = loopback(port);
  if (::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      (type == SOCK_STREAM && ::listen(fd.get(), 8) != 0)) {
    throw std::runtime_error("no port of the loopback interface");
  }
  return fd;
}

[[nodiscard]] inline std::uint16_t portOf(const UniqueFd& fd) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  ::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

[[nodiscard]] inline bool readable(const UniqueFd& fd, Duration wait) {
  pollfd poll{.fd = fd.get(), .events = POLLIN, .revents = 0};
  return ::poll(&poll, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(wait).count())) > 0;
}

// False if the other side has closed the connection.
inline bool sendAll(const UniqueFd& to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(to.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

// Reads up to an empty line, or until the other side closes the connection.
[[nodiscard]] inline std::string receiveHead(const UniqueFd& from) {
  std::string head;
  for (char c = 0; !head.ends_with("\r\n\r\n") && ::recv(from.get(), &c, 1, 0) == 1;) head += c;
  return head;
}

}  // namespace relievo::test
