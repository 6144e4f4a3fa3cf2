// SPDX-License-Identifier: Apache-2.0
// Reads the window's keys from their ring.
#include "drivers/window/window_remote.h"

#include <utility>

namespace relievo {
namespace {

class WindowRemote final : public RemoteInput {
 public:
  explicit WindowRemote(std::shared_ptr<WindowInput> input) : input_(std::move(input)) {}

 private:
  Result<void> openRemote() override {
    while (input_->keys.tryPop()) {
    }
    return {};
  }
  Result<std::optional<KeyEvent>> nextKey(MonotonicTime /*now*/) override { return input_->keys.tryPop(); }
  void closeRemote() noexcept override {}

  std::shared_ptr<WindowInput> input_;
};

}  // namespace

std::unique_ptr<RemoteInput> makeWindowRemote(std::shared_ptr<WindowInput> input) {
  return std::make_unique<WindowRemote>(std::move(input));
}

}  // namespace relievo
