// SPDX-License-Identifier: Apache-2.0
// Finds the devices and reads them through libevdev, which resynchronises after dropped events.
#include <fcntl.h>
#include <libevdev/libevdev.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <utility>
#include <vector>

#include "drivers/evdev/evdev.h"
#include "drivers/evdev/event_nodes.h"
#include "drivers/evdev/key_hold.h"
#include "drivers/evdev/pad_keys.h"
#include "platform/log.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr Duration kLookEvery = std::chrono::seconds(1);

struct FreeDevice {
  void operator()(libevdev* device) const noexcept { libevdev_free(device); }
};
using Device = std::unique_ptr<libevdev, FreeDevice>;

bool isRemote(const libevdev* device) {
  const auto has = [device](unsigned key) { return libevdev_has_event_code(device, EV_KEY, key) != 0; };
  const bool arrows = has(KEY_LEFT) && has(KEY_RIGHT);
  const bool confirms = has(KEY_OK) || has(KEY_ENTER) || has(KEY_SELECT);
  const bool plays = has(KEY_PLAYPAUSE) || has(KEY_PLAY) || has(KEY_PLAYCD) || has(KEY_PAUSE);
  return (arrows && confirms) || plays;
}

// A keyboard for typing, whose keys other programs need as well.
bool isKeyboard(const libevdev* device) {
  return libevdev_has_event_code(device, EV_KEY, KEY_Q) != 0 && libevdev_has_event_code(device, EV_KEY, KEY_M) != 0;
}

// Of a mouse, a joystick or a gamepad: no key of a remote control.
bool isButton(std::uint16_t code) noexcept {
  return (code >= BTN_MISC && code < KEY_OK) || code >= BTN_DPAD_UP;
}

struct Remote {
  std::string path;
  UniqueFd fd;  // declared first, to be closed after the device is freed
  Device device;
  KeyHold keys;
  std::optional<PadKeys> pad;
  bool has_keys = true;  // besides a gamepad's
  bool there = true;
};

class EvdevRemote final : public RemoteInput {
 public:
  EvdevRemote() = default;
  explicit EvdevRemote(std::function<bool()> heard) : heard_(std::move(heard)), pads_only_(true) {}
  ~EvdevRemote() override { close(); }
  EvdevRemote(const EvdevRemote&) = delete;
  EvdevRemote& operator=(const EvdevRemote&) = delete;

  [[nodiscard]] bool hasPad() const noexcept override {
    return std::ranges::any_of(remotes_, [](const auto& remote) { return remote->pad.has_value(); });
  }

 private:
  Result<void> openRemote() override {
    looked_.reset();
    if (!look() && remotes_.empty() && !pads_only_) {
      return fail(ErrorCode::PermissionDenied,
                  "no permission to read remote controls; add the user to the group input (sudo usermod -aG input "
                  "$USER) and log in again",
                  EACCES);
    }
    return {};
  }

  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    if (!looked_) looked_ = now;
    if (now - *looked_ >= kLookEvery) {
      (void)look();
      looked_ = now;
    }
    for (std::size_t i = 0; i < remotes_.size(); ++i) {
      Remote& remote = *remotes_[i];
      remote.there = remote.there && read(remote, now);
      if (!remote.there) remote.keys.letGo(now);
      while (const auto event = remote.keys.poll(now)) {
        if (event->action == KeyEvent::Action::Release || heard_()) return event;
      }
      if (remote.there) continue;
      log(LogLevel::Info, "remote", "%s was unplugged", libevdev_get_name(remote.device.get()));
      remotes_.erase(remotes_.begin() + static_cast<std::ptrdiff_t>(i--));
    }
    return std::nullopt;
  }

  void closeRemote() noexcept override {
    remotes_.clear();
    looked_at_.clear();
  }

  // False if a device may not be read.
  bool look() {
    bool allowed = true;
    std::vector<EventNode> nodes = listEventNodes();
    for (const auto& remote : remotes_) {
      const auto isIts = [&](const EventNode& node) { return node.path == remote->path; };
      remote->there = remote->there && std::ranges::any_of(nodes, isIts);
    }
    // A new node, or another device of the same number, or one whose permissions have changed.
    for (const EventNode& node : nodes) {
      const bool known = std::ranges::any_of(remotes_, [&](const auto& r) { return r->path == node.path; }) ||
                         std::ranges::find(looked_at_, node) != looked_at_.end();
      if (!known) allowed = take(node.path) && allowed;
    }
    looked_at_ = std::move(nodes);
    return allowed;
  }

  bool take(const std::string& path) {
    if (pads_only_ && !mayHaveKey(path, BTN_GAMEPAD)) return true;  // a desktop has many nodes
    auto remote = std::make_unique<Remote>();
    remote->path = path;
    remote->fd = UniqueFd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    if (!remote->fd.valid()) return errno != EACCES;
    libevdev* device = nullptr;
    if (libevdev_new_from_fd(remote->fd.get(), &device) != 0) return true;
    remote->device.reset(device);
    const bool is_pad = isGamepad(device);
    if (!is_pad && (pads_only_ || !isRemote(device))) return true;
    if (is_pad) {
      remote->pad.emplace(device);
      remote->has_keys = !pads_only_ && isRemote(device);
      remote->keys = KeyHold(true);
    }
    if (!is_pad && !isKeyboard(device))
      (void)libevdev_grab(device, LIBEVDEV_GRAB);  // if another program has it, both get its keys
    log(LogLevel::Info, "remote", "%s (%s)", libevdev_get_name(device), path.c_str());
    remotes_.push_back(std::move(remote));
    return true;
  }

  // False if the device was unplugged.
  static bool read(Remote& remote, MonotonicTime now) {
    unsigned how = LIBEVDEV_READ_FLAG_NORMAL;
    for (;;) {
      input_event event{};
      const int read = libevdev_next_event(remote.device.get(), how, &event);
      if (read == -EAGAIN && how == LIBEVDEV_READ_FLAG_NORMAL) return true;
      if (read == -EAGAIN) {
        how = LIBEVDEV_READ_FLAG_NORMAL;  // resynchronised
        continue;
      }
      if (read < 0) return false;
      if (read == LIBEVDEV_READ_STATUS_SYNC) how = LIBEVDEV_READ_FLAG_SYNC;
      if (remote.pad) remote.pad->take(event, remote.keys, now);
      const bool is_key = event.type == EV_KEY && (!remote.pad || !isButton(event.code));
      if (is_key && remote.has_keys) remote.keys.take(event.code, event.value, now);
    }
  }

  std::function<bool()> heard_ = [] { return true; };
  bool pads_only_ = false;
  std::vector<std::unique_ptr<Remote>> remotes_;
  std::vector<EventNode> looked_at_;
  std::optional<MonotonicTime> looked_;
};

}  // namespace

std::unique_ptr<RemoteInput> makeEvdevRemote() {
  return std::make_unique<EvdevRemote>();
}

std::unique_ptr<RemoteInput> makePadRemote(std::function<bool()> heard) {
  return std::make_unique<EvdevRemote>(std::move(heard));
}

}  // namespace relievo
