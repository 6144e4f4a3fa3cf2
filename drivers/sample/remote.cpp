// SPDX-License-Identifier: Apache-2.0
// Remote control: converts a receiver's bytes to the kernel's key codes.
#include <linux/input-event-codes.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <utility>

#include "drivers/sample/sample.h"

namespace relievo {
namespace {

constexpr std::array<std::pair<char, std::uint16_t>, 6> kKeys{
    {{'O', KEY_OK}, {'P', KEY_PLAYPAUSE}, {'S', KEY_STOP}, {'L', KEY_LEFT}, {'R', KEY_RIGHT}, {'I', KEY_INFO}}};

class SampleRemote final : public RemoteInput {
 public:
  explicit SampleRemote(int fd) noexcept : fd_(fd) {}

 private:
  // Discards keys that were pressed before.
  Result<void> openRemote() override {
    while (nextByte()) {
    }
    pressed_.reset();
    return {};
  }

  // Never waits. This receiver reports only presses: each is followed by a release at once, so that no key seems held.
  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    if (pressed_) {
      return KeyEvent{.code = *std::exchange(pressed_, std::nullopt), .action = KeyEvent::Action::Release, .time = now};
    }
    while (const auto byte = nextByte()) {
      for (const auto& [known, code] : kKeys) {
        if (*byte != known) continue;
        pressed_ = code;
        return KeyEvent{.code = code, .action = KeyEvent::Action::Press, .time = now};
      }
    }
    return std::nullopt;  // also if the receiver was unplugged: that is no error
  }

  void closeRemote() noexcept override {}

  [[nodiscard]] std::optional<char> nextByte() const noexcept {
    pollfd wait{.fd = fd_, .events = POLLIN, .revents = 0};
    char byte = 0;
    const bool got = ::poll(&wait, 1, 0) == 1 && (wait.revents & POLLIN) != 0 && ::read(fd_, &byte, 1) == 1;
    return got ? std::optional(byte) : std::nullopt;
  }

  const int fd_;
  std::optional<std::uint16_t> pressed_;
};

}  // namespace

std::unique_ptr<RemoteInput> makeSampleRemote(int fd) {
  return std::make_unique<SampleRemote>(fd);
}

}  // namespace relievo
