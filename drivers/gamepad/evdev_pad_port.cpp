// SPDX-License-Identifier: Apache-2.0
// Requests of <linux/input.h>. Not libevdev: after dropped events it asks for every axis and key, and it has no force
// feedback.
#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <utility>

#include "drivers/evdev/event_nodes.h"
#include "drivers/gamepad/gamepad.h"
#include "drivers/gamepad/pad_list.h"
#include "drivers/gamepad/pad_port.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr const char* kNoRight =
    "no permission to use the gamepad; add the user to the group input (sudo usermod -aG input $USER) and log in again";
constexpr const char* kNoPad =
    "no gamepad, joystick or wheel with force feedback was found; plug one in, or give its path: "
    "gamepad:/dev/input/eventN";

constexpr const char* kNoForce =
    "the gamepad here has no force feedback that its driver knows of; plug it in by USB, or switch it to XInput (X "
    "instead of D), or take another";

constexpr const char* kTaken =
    "the gamepad is already a finger, or another program has it for itself; plug in another one, or end that program";

// By its buttons, which sysfs shows to everybody; of other devices it does not matter that they may not be opened.
bool mayBePad(const std::string& path) {
  return mayHaveKey(path, BTN_GAMEPAD) || mayHaveKey(path, BTN_JOYSTICK) || mayHaveKey(path, BTN_WHEEL);
}

struct Opened {
  UniqueFd fd;
  int error = 0;  // errno, if it is not open
};
Opened openNode(const std::string& path) {
  UniqueFd fd(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  const int error = fd.valid() ? 0 : errno;
  return {std::move(fd), error};
}

// The codes that the device reports for an event type; none on failure.
template <std::size_t Codes>
InputCodes<Codes> codesOf(int fd, unsigned type) {
  InputCodes<Codes> codes;
  if (::ioctl(fd, EVIOCGBIT(type, sizeof codes.bytes), codes.bytes.data()) < 0) return {};
  return codes;
}

// Nullopt if the node is not an input device.
std::optional<PadFacts> ask(int fd) {
  std::array<char, 256> name{};
  if (::ioctl(fd, EVIOCGNAME(name.size() - 1), name.data()) < 0) return std::nullopt;
  PadFacts facts;
  facts.name = name.data();
  const auto types = codesOf<EV_CNT>(fd, 0);
  if (types.has(EV_KEY)) facts.keys = codesOf<KEY_CNT>(fd, EV_KEY);
  if (types.has(EV_ABS)) facts.axes = codesOf<ABS_CNT>(fd, EV_ABS);
  for (unsigned code = 0; code < ABS_CNT; ++code) {
    if (facts.axes.has(code)) static_cast<void>(::ioctl(fd, EVIOCGABS(code), &facts.ranges[code]));
  }
  if (!types.has(EV_FF)) return facts;
  facts.forces = codesOf<FF_CNT>(fd, EV_FF);
  static_cast<void>(::ioctl(fd, EVIOCGEFFECTS, &facts.effects_at_once));
  return facts;
}

class EvdevPadPort final : public PadPort {
 public:
  explicit EvdevPadPort(std::string path) : path_(std::move(path)) {}

  Result<PadFacts> open() override {
    taken_ = forceless_ = false;
    auto facts = path_.empty() ? openFirst() : openPath();
    if (facts) listing_.put(fd_.get(), facts->forces.has(FF_AUTOCENTER));
    return facts;
  }
  void close() noexcept override {
    listing_.remove();
    fd_.reset();
  }

  Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT override {
    const ssize_t bytes = ::read(fd_.get(), events.data(), events.size_bytes());
    if (bytes > 0) return static_cast<std::size_t>(bytes) / sizeof(input_event);
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    return gone();
  }
  Result<InputKeys> keysDown() RELIEVO_RT override {
    InputKeys keys;
    if (::ioctl(fd_.get(), EVIOCGKEY(sizeof keys.bytes), keys.bytes.data()) < 0) return gone();
    return keys;
  }
  Result<std::int32_t> axis(unsigned code) RELIEVO_RT override {
    input_absinfo info{};
    if (::ioctl(fd_.get(), EVIOCGABS(code), &info) < 0) return gone();
    return info.value;
  }

  Result<std::int16_t> upload(const ff_effect& effect) noexcept override {
    ff_effect sent = effect;
    if (::ioctl(fd_.get(), EVIOCSFF, &sent) < 0) return failed("the gamepad accepted no effect; plug it in again");
    return sent.id;
  }
  Result<void> erase(std::int16_t id) noexcept override {
    if (::ioctl(fd_.get(), EVIOCRMFF, static_cast<int>(id)) < 0) return failed("the gamepad kept an effect");
    return {};
  }
  Result<void> send(std::uint16_t code, std::int32_t value) noexcept override {
    const input_event event{.time = {}, .type = EV_FF, .code = code, .value = value};
    if (::write(fd_.get(), &event, sizeof event) < 0)
      return failed("the gamepad does not accept commands; unplug it and plug it in again");
    return {};
  }

 private:
  Result<PadFacts> openPath() {
    Opened node = openNode(path_);
    if (node.error == EACCES) return fail(ErrorCode::PermissionDenied, kNoRight, EACCES);
    if (node.error != 0)
      return fail(ErrorCode::NotFound, "there is no such gamepad; relievo devices lists those that are there",
                  node.error);
    if (auto facts = take(node)) return std::move(*facts);
    if (taken_) return fail(ErrorCode::NotFound, kTaken);
    if (forceless_) return fail(ErrorCode::Unsupported, kNoForce);
    return fail(ErrorCode::Unsupported,
                "this input device is no gamepad with a stick; relievo devices lists those that are");
  }

  Result<PadFacts> openFirst() {
    bool refused = false;
    for (const EventNode& node : listEventNodes()) {
      Opened opened = openNode(node.path);
      refused = refused || (opened.error == EACCES && mayBePad(node.path));
      if (auto facts = take(opened)) return std::move(*facts);
    }
    if (taken_) return fail(ErrorCode::NotFound, kTaken);
    if (refused) return fail(ErrorCode::PermissionDenied, kNoRight, EACCES);
    return fail(ErrorCode::NotFound, forceless_ ? kNoForce : kNoPad);
  }

  // Keeps it open if it is a pad that is free.
  std::optional<PadFacts> take(Opened& node) {
    auto facts = node.fd.valid() ? ask(node.fd.get()) : std::nullopt;
    forceless_ = forceless_ || (facts && isPadWithoutForce(*facts));
    if (!facts || !isPad(*facts)) return std::nullopt;
    taken_ = !takeNode(node.fd.get());
    if (taken_) return std::nullopt;
    fd_ = std::move(node.fd);
    return facts;
  }

  static std::unexpected<Error> gone() RELIEVO_RT {
    return fail(ErrorCode::Lost, "the gamepad has gone away; plug it in again", errno);
  }
  static std::unexpected<Error> failed(const char* message) noexcept {
    return errno == ENODEV ? gone() : fail(ErrorCode::Io, message, errno);
  }

  std::string path_;
  UniqueFd fd_;
  PadListing listing_;
  // What `open` has found:
  bool taken_ = false;      // a pad that is another finger's
  bool forceless_ = false;  // a pad without force feedback
};

std::string stateOf(const PadFacts& facts) {
  std::string can;
  const auto add = [&](unsigned code, const char* word) {
    if (facts.forces.has(code)) can += (can.empty() ? "" : ", ") + std::string(word);
  };
  add(FF_RUMBLE, "rumble");
  add(FF_CONSTANT, "constant force");
  add(FF_SPRING, "spring");
  add(FF_AUTOCENTER, "centring");
  return facts.name + ": " + can;
}

}  // namespace

std::unique_ptr<PadPort> makeEvdevPadPort(std::string path) {
  return std::make_unique<EvdevPadPort>(std::move(path));
}

std::vector<PadSeen> lookAtGamepads() {
  std::vector<PadSeen> seen;
  for (const EventNode& node : listEventNodes()) {
    const Opened opened = openNode(node.path);
    if (opened.error == EACCES && mayBePad(node.path)) seen.push_back({node.path, false, kNoRight});
    const auto facts = opened.fd.valid() ? ask(opened.fd.get()) : std::nullopt;
    if (!facts) continue;
    if (isPad(*facts)) seen.push_back({node.path, true, stateOf(*facts)});
    else if (isPadWithoutForce(*facts)) seen.push_back({node.path, false, facts->name + ": " + kNoForce});
  }
  if (seen.empty()) seen.push_back({"", false, kNoPad});
  return seen;
}

}  // namespace relievo
