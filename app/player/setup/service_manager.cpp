// SPDX-License-Identifier: Apache-2.0
// The names and the form of the messages are systemd's promise: sd_notify(3), sd_watchdog_enabled(3).
#include "app/player/setup/service_manager.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>

namespace relievo {
namespace {

std::string_view wordOf(const char* variable) noexcept {
  const char* const word = std::getenv(variable);
  return word == nullptr ? "" : word;
}

// The watchdog may be another process's.
Duration watchdogInterval() noexcept {
  const std::string_view pid = wordOf("WATCHDOG_PID");
  if (!pid.empty() && pid != std::to_string(::getpid())) return Duration(0);
  const std::string_view interval = wordOf("WATCHDOG_USEC");
  long long interval_us = 0;  // and stays so when it is no number
  std::from_chars(interval.data(), interval.data() + interval.size(), interval_us);
  return std::chrono::microseconds(std::clamp(interval_us, 0LL, 86'400'000'000LL));
}

}  // namespace

ServiceManager::ServiceManager() noexcept {
  const std::string_view path = wordOf("NOTIFY_SOCKET");
  if (path.size() < 2 || path.size() >= sizeof address_.sun_path || (path[0] != '/' && path[0] != '@')) return;
  address_.sun_family = AF_UNIX;
  path.copy(address_.sun_path, path.size());
  if (path[0] == '@') address_.sun_path[0] = '\0';  // a name without a file
  address_bytes_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  fd_.reset(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  pause_ = watchdogInterval() / 2;
}

void ServiceManager::wentRound(MonotonicTime now) noexcept {
  if (pause_ > Duration(0) && now >= next_ && send("WATCHDOG=1")) next_ = now + pause_;
}

// A line break would begin another message.
void ServiceManager::status(const std::string& text) noexcept {
  std::string line = "STATUS=" + text;
  std::ranges::replace_if(line, [](unsigned char c) { return c < ' '; }, ' ');
  send(line);
}

bool ServiceManager::send(std::string_view message) noexcept {
  return fd_.valid() && ::sendto(fd_.get(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                                 reinterpret_cast<const sockaddr*>(&address_), address_bytes_) >= 0;
}

}  // namespace relievo
