// SPDX-License-Identifier: Apache-2.0
// Reads the terminal's pending bytes without waiting.
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <deque>
#include <string_view>

#include "drivers/terminal/terminal.h"
#include "drivers/terminal/terminal_keys.h"

namespace relievo {
namespace {

class TerminalRemote final : public RemoteInput {
 public:
  explicit TerminalRemote(int fd) noexcept : fd_(fd) {}
  ~TerminalRemote() override { close(); }

 private:
  Result<void> openRemote() override {
    if (::tcgetattr(fd_, &before_) != 0) {
      return fail(ErrorCode::Unsupported, "standard input is no terminal; choose another --remote", errno);
    }
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VMIN] = 0;
    keys.c_cc[VTIME] = 0;
    if (inForeground() && ::tcsetattr(fd_, TCSANOW, &keys) != 0) {
      return fail(ErrorCode::Io, "the terminal cannot be switched to single keys; choose another --remote", errno);
    }
    return {};
  }

  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    if (keys_.empty()) readKeys(now);
    if (keys_.empty()) return std::nullopt;
    const KeyEvent key = keys_.front();
    keys_.pop_front();
    return key;
  }

  void readKeys(MonotonicTime now) {
    pollfd wait{.fd = fd_, .events = POLLIN, .revents = 0};
    if (!inForeground() || ::poll(&wait, 1, 0) <= 0 || (wait.revents & POLLIN) == 0) return;
    std::array<char, 256> buffer{};
    const ssize_t got = ::read(fd_, buffer.data(), buffer.size());
    if (got <= 0) return;  // hung up: no more keys
    for (std::string_view bytes(buffer.data(), static_cast<std::size_t>(got)); !bytes.empty();) {
      const auto code = takeTerminalKey(bytes);
      if (!code) continue;
      for (const auto action : {KeyEvent::Action::Press, KeyEvent::Action::Release}) {
        keys_.push_back({.code = *code, .action = action, .time = now});
      }
    }
  }

  void closeRemote() noexcept override {
    keys_.clear();
    if (!inForeground()) return;
    ::tcflush(fd_, TCIFLUSH);
    ::tcsetattr(fd_, TCSANOW, &before_);
  }

  // The kernel stops a background program that reads from or configures its terminal.
  [[nodiscard]] bool inForeground() const noexcept {
    const pid_t group = ::tcgetpgrp(fd_);
    return group == ::getpgrp() ||
           (group < 0 && errno == ENOTTY);  // not the controlling terminal: the kernel does not stop it
  }

  const int fd_;
  termios before_{};
  std::deque<KeyEvent> keys_;
};

}  // namespace

std::unique_ptr<RemoteInput> makeTerminalRemote(int fd) {
  return std::make_unique<TerminalRemote>(fd);
}

}  // namespace relievo
