// SPDX-License-Identifier: Apache-2.0
// A client of the player's control socket.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <chrono>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "platform/unique_fd.h"

namespace relievo::test {

class ControlClient {
 public:
  using Json = nlohmann::json;

  // Connects as soon as the player listens.
  explicit ControlClient(const std::string& path, std::chrono::milliseconds patience = std::chrono::seconds(30))
      : patience_(patience) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const auto end = std::chrono::steady_clock::now() + patience_;
    do {
      fd_.reset(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
      connected_ = ::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
      if (!connected_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (!connected_ && std::chrono::steady_clock::now() < end);
  }

  [[nodiscard]] bool connected() const { return connected_; }
  [[nodiscard]] int fd() const { return fd_.get(); }
  bool sendBytes(std::string_view bytes) const {
    return ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  void say(const std::string& words) const { sendBytes(Json{{"do", words}}.dump() + "\n"); }
  void closeSide() const { ::shutdown(fd_.get(), SHUT_WR); }

  // The next line; waits at most `wait` for one. nullopt if none came or the player has closed the connection.
  std::optional<Json> next(std::chrono::milliseconds wait) {
    const auto end = std::chrono::steady_clock::now() + wait;
    for (;;) {
      if (const std::size_t line = in_.find('\n'); line != std::string::npos) {
        Json json = Json::parse(in_.substr(0, line), nullptr, false);
        in_.erase(0, line + 1);
        return json;
      }
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
      if (left.count() < 0 || !receive(static_cast<int>(left.count()))) return std::nullopt;
    }
  }
  // The next line that `wanted` accepts; skips those before it.
  template <class Wanted>
  std::optional<Json> until(Wanted&& wanted) {
    const auto end = std::chrono::steady_clock::now() + patience_;
    while (std::chrono::steady_clock::now() < end) {
      auto json = next(std::chrono::milliseconds(100));
      if (json && wanted(*json)) return json;
      if (!json && gone_) return std::nullopt;
    }
    return std::nullopt;
  }
  std::optional<Json> untilState(const std::string& state) {
    return until([&](const Json& j) { return j.value("event", "") == "state" && j["state"] == state; });
  }
  // Sends a command and waits for the answer.
  Json ask(const std::string& words) {
    say(words);
    return until([](const Json& j) { return j.contains("ok"); }).value_or(Json{{"ok", "no answer"}});
  }
  // True once the player has closed the connection; discards lines that come before that.
  bool isLetGo() {
    while (next(patience_)) {
    }
    return gone_;
  }

 private:
  bool receive(int wait_ms) {
    pollfd polled{.fd = fd_.get(), .events = POLLIN};
    if (::poll(&polled, 1, wait_ms) <= 0) return false;
    std::array<char, 65536> bytes;
    const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got > 0) in_.append(bytes.data(), static_cast<std::size_t>(got));
    gone_ = got <= 0;
    return got > 0;
  }

  std::chrono::milliseconds patience_;
  UniqueFd fd_;
  bool connected_ = false;
  bool gone_ = false;
  std::string in_;
};

}  // namespace relievo::test
