// SPDX-License-Identifier: Apache-2.0
// Polls one remote after the other.
#include "drivers/terminal/joined_remote.h"

#include <utility>

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

}  // namespace

std::unique_ptr<RemoteInput> makeJoinedRemote(std::unique_ptr<RemoteInput> first, std::unique_ptr<RemoteInput> second) {
  return std::make_unique<JoinedRemote>(std::move(first), std::move(second));
}

}  // namespace relievo
