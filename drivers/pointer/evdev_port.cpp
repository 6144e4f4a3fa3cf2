// SPDX-License-Identifier: Apache-2.0
// Uses libevdev to identify mice and read(2) for their events: libevdev_next_event asks the kernel for the state of
// every key, axis and slot when events were dropped, and keeps its own queue and log, which a mouse does not need and a
// tick cannot afford.
#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "drivers/evdev/event_nodes.h"
#include "drivers/pointer/mouse_port.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr const char* kNoRight =
    "no permission to read the mouse; add the user to the group input (sudo usermod -aG input $USER) and log in "
    "again";

constexpr const char* kTaken =
    "the mouse is already a finger, or another program has it for itself; plug in another one, or end that program";

bool isMouse(int fd) {
  libevdev* device = nullptr;
  if (libevdev_new_from_fd(fd, &device) != 0) return false;
  const bool mouse = libevdev_has_event_code(device, EV_REL, REL_X) != 0 &&
                     libevdev_has_event_code(device, EV_REL, REL_Y) != 0 &&
                     libevdev_has_event_code(device, EV_KEY, BTN_LEFT) != 0;
  libevdev_free(device);
  return mouse;
}

// By what sysfs shows to everybody; of other devices it does not matter that they may not be opened.
bool mayBeMouse(const std::string& path) {
  return mayHaveKey(path, BTN_LEFT) && mayHaveMotion(path, REL_X);
}

UniqueFd openEvents(const std::string& path) {
  return UniqueFd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
}

class EvdevPort final : public MousePort {
 public:
  explicit EvdevPort(std::string path) : path_(std::move(path)) {}

  Result<void> open() override { return path_.empty() ? openFirst() : openPath(); }
  void close() noexcept override { fd_.reset(); }

  Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT override {
    const ssize_t bytes = ::read(fd_.get(), events.data(), events.size_bytes());
    if (bytes > 0) return static_cast<std::size_t>(bytes) / sizeof(input_event);
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    return gone();
  }

  Result<std::uint8_t> buttonsDown() RELIEVO_RT override {
    std::array<std::uint8_t, KEY_MAX / 8 + 1> keys{};
    if (::ioctl(fd_.get(), EVIOCGKEY(sizeof keys), keys.data()) < 0) return gone();
    const auto down = [&keys](unsigned code, std::uint8_t button) -> std::uint8_t {
      return (keys[code / 8] >> (code % 8) & 1U) != 0 ? button : std::uint8_t{0};
    };
    return static_cast<std::uint8_t>(down(BTN_LEFT, kLeftButton) | down(BTN_RIGHT, kRightButton) |
                                     down(BTN_MIDDLE, kMiddleButton));
  }

 private:
  Result<void> openPath() {
    fd_ = openEvents(path_);
    const int error = errno;
    if (!fd_.valid() && error == EACCES) return fail(ErrorCode::PermissionDenied, kNoRight, error);
    if (!fd_.valid())
      return fail(ErrorCode::NotFound, "there is no such mouse; ls /dev/input lists the devices", error);
    const bool mouse = isMouse(fd_.get());
    if (mouse && takeNode(fd_.get())) return {};
    fd_.reset();
    if (mouse) return fail(ErrorCode::NotFound, kTaken);
    return fail(ErrorCode::Unsupported,
                "this input device is no mouse: it lacks relative axes or a left button; choose another");
  }

  Result<void> openFirst() {
    bool refused = false, taken = false;
    for (const EventNode& node : listEventNodes()) {
      fd_ = openEvents(node.path);
      refused = refused || (!fd_.valid() && errno == EACCES && mayBeMouse(node.path));
      if (!fd_.valid() || !isMouse(fd_.get())) continue;
      if (takeNode(fd_.get())) return {};
      taken = true;
    }
    fd_.reset();
    if (taken) return fail(ErrorCode::NotFound, kTaken);
    if (refused) return fail(ErrorCode::PermissionDenied, kNoRight, EACCES);
    return fail(ErrorCode::NotFound, "no mouse was found; plug one in, or give its path: pointer:/dev/input/eventN");
  }

  static std::unexpected<Error> gone() RELIEVO_RT {
    return fail(ErrorCode::Lost, "the mouse has gone away; plug it in again", errno);
  }

  std::string path_;
  UniqueFd fd_;
};

}  // namespace

std::unique_ptr<MousePort> makeEvdevPort(std::string path) {
  return std::make_unique<EvdevPort>(std::move(path));
}

}  // namespace relievo
