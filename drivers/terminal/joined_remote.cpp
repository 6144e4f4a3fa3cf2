// SPDX-License-Identifier: Apache-2.0
// Polls one remote after the other.
#include "drivers/terminal/joined_remote.h"

#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

class JoinedRemote final : public RemoteInput {
 public:
  JoinedRemote(std::unique_ptr<RemoteInput> first, std::unique_ptr<RemoteInput> second)
      : first_(std::move(first)), second_(std::move(second)) {}
  ~JoinedRemote() override { close(); }
  JoinedRemote(const JoinedRemote&) = delete;
  JoinedRemote& operator=(const JoinedRemote&) = delete;

  [[nodiscard]] bool hasPad() const noexcept override { return first_->hasPad() || second_->hasPad(); }

 private:
  Result<void> openRemote() override {
    if (auto opened = first_->open(); !opened) return opened;
    has_second_ = second_->open().has_value();
    return {};
  }
  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    auto key = first_->poll(now);
    if (!key || *key || !has_second_) return key;
    return second_->poll(now);
  }
  void closeRemote() noexcept override {
    first_->close();
    second_->close();
  }

  std::unique_ptr<RemoteInput> first_, second_;
  bool has_second_ = false;
};

class RemoteAtTerminal final : public RemoteInput {
 public:
  RemoteAtTerminal(std::unique_ptr<RemoteInput> first, std::unique_ptr<RemoteInput> terminal)
      : first_(std::move(first)), terminal_(std::move(terminal)) {}
  ~RemoteAtTerminal() override { close(); }
  RemoteAtTerminal(const RemoteAtTerminal&) = delete;
  RemoteAtTerminal& operator=(const RemoteAtTerminal&) = delete;

  [[nodiscard]] bool hasPad() const noexcept override { return first_->hasPad(); }

 private:
  Result<void> openRemote() override {
    const bool typed = terminal_->open().has_value();
    const auto opened = first_->open();
    if (opened || !typed) return opened;
    log(LogLevel::Warning, "remote", "%s; until then the terminal's keys are taken", opened.error().message);
    return {};
  }
  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    if (first_->state() != State::Open) return terminal_->poll(now);
    while (terminal_->state() == State::Open) {
      const auto typed = terminal_->poll(now);
      if (!typed || !*typed) break;
    }
    return first_->poll(now);
  }
  void closeRemote() noexcept override {
    first_->close();
    terminal_->close();
  }

  std::unique_ptr<RemoteInput> first_, terminal_;
};

}  // namespace

std::unique_ptr<RemoteInput> makeJoinedRemote(std::unique_ptr<RemoteInput> first, std::unique_ptr<RemoteInput> second) {
  return std::make_unique<JoinedRemote>(std::move(first), std::move(second));
}

std::unique_ptr<RemoteInput> makeRemoteAtTerminal(std::unique_ptr<RemoteInput> first,
                                                  std::unique_ptr<RemoteInput> terminal) {
  return std::make_unique<RemoteAtTerminal>(std::move(first), std::move(terminal));
}

}  // namespace relievo
