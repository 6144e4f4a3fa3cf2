// SPDX-License-Identifier: Apache-2.0
// Polls one remote after the other.
#include "drivers/terminal/joined_remote.h"

#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

class TwoRemotes : public RemoteInput {
 public:
  TwoRemotes(std::unique_ptr<RemoteInput> first, std::unique_ptr<RemoteInput> second)
      : first_(std::move(first)), second_(std::move(second)) {}
  ~TwoRemotes() override { close(); }
  TwoRemotes(const TwoRemotes&) = delete;
  TwoRemotes& operator=(const TwoRemotes&) = delete;

  [[nodiscard]] bool hasPad() const noexcept override { return first_->hasPad() || second_->hasPad(); }

 protected:
  [[nodiscard]] RemoteInput& first() noexcept { return *first_; }
  [[nodiscard]] RemoteInput& second() noexcept { return *second_; }

 private:
  void closeRemote() noexcept final {
    first_->close();
    second_->close();
  }

  std::unique_ptr<RemoteInput> first_, second_;
};

class JoinedRemote final : public TwoRemotes {
 public:
  using TwoRemotes::TwoRemotes;

 private:
  Result<void> openRemote() override {
    if (auto opened = first().open(); !opened) return opened;
    has_second_ = second().open().has_value();
    return {};
  }
  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    auto key = first().poll(now);
    if (!key || *key || !has_second_) return key;
    return second().poll(now);
  }

  bool has_second_ = false;
};

// The second is the terminal.
class RemoteAtTerminal final : public TwoRemotes {
 public:
  using TwoRemotes::TwoRemotes;

 private:
  Result<void> openRemote() override {
    const bool typed = second().open().has_value();
    const auto opened = first().open();
    if (opened || !typed) return opened;
    log(LogLevel::Warning, "remote", "%s; until then the terminal's keys are taken", opened.error().message);
    return {};
  }
  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    if (first().state() != State::Open) return second().poll(now);
    while (second().state() == State::Open) {
      const auto typed = second().poll(now);
      if (!typed || !*typed) break;
    }
    return first().poll(now);
  }
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
