// SPDX-License-Identifier: Apache-2.0
// A server whose every answer is the test's.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <string>

#include "platform/unique_fd.h"

namespace relievo {

// A server on the loopback interface that sends the test's answers.
struct Server {
  UniqueFd listener{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::string port, url;

  Server() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    EXPECT_EQ(::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), length), 0);
    EXPECT_EQ(::listen(listener.get(), 4), 0);
    EXPECT_EQ(::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &length), 0);
    port = std::to_string(ntohs(address.sin_port));
    url = "http://127.0.0.1:" + port + "/film.mkv";
  }
  [[nodiscard]] UniqueFd accept() const { return UniqueFd(::accept(listener.get(), nullptr, nullptr)); }
};

}  // namespace relievo
