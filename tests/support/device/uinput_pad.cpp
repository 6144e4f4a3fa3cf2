// SPDX-License-Identifier: Apache-2.0
// Answers the kernel's requests of <linux/uinput.h> on a thread of its own: an upload waits for the answer.
#include "tests/support/device/uinput_pad.h"

#include <fcntl.h>
#include <linux/uinput.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace relievo::test {

bool UinputPad::canBeMade() {
  return std::getenv("RELIEVO_GUEST") != nullptr && ::access("/dev/uinput", W_OK) == 0;
}

UinputPad::UinputPad(const PadFacts& facts) : fd_(::open("/dev/uinput", O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
  const int fd = fd_.get();
  for (const int type : {EV_SYN, EV_KEY, EV_ABS}) ::ioctl(fd, UI_SET_EVBIT, type);
  if (facts.effects_at_once > 0) ::ioctl(fd, UI_SET_EVBIT, EV_FF);  // the kernel makes no device with it and no effects
  for (unsigned code = 0; code < KEY_CNT; ++code) {
    if (facts.keys.has(code)) ::ioctl(fd, UI_SET_KEYBIT, code);
  }
  for (unsigned code = 0; code < FF_CNT; ++code) {
    if (facts.forces.has(code)) ::ioctl(fd, UI_SET_FFBIT, code);
  }
  for (unsigned code = 0; code < ABS_CNT; ++code) {
    uinput_abs_setup axis{.code = static_cast<__u16>(code), .absinfo = facts.ranges[code]};
    if (facts.axes.has(code)) ::ioctl(fd, UI_ABS_SETUP, &axis);
  }
  uinput_setup setup{};
  setup.id = {.bustype = BUS_USB, .vendor = 0x1234, .product = 0x5678, .version = 1};
  setup.ff_effects_max = static_cast<__u32>(facts.effects_at_once);
  std::strncpy(setup.name, facts.name.c_str(), sizeof setup.name - 1);
  std::array<char, 64> name{};
  if (::ioctl(fd, UI_DEV_SETUP, &setup) < 0 || ::ioctl(fd, UI_DEV_CREATE) < 0 ||
      ::ioctl(fd, UI_GET_SYSNAME(name.size()), name.data()) < 0) {
    return;
  }
  std::error_code error;
  const std::string folder = std::string("/sys/devices/virtual/input/") + name.data();
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string file = entry.path().filename();
    if (file.starts_with("event")) node_ = "/dev/input/" + file;
  }
  thread_ = std::jthread([this](const std::stop_token& stopping) { serve(stopping); });
}

void UinputPad::turn(std::uint16_t axis, std::int32_t value) const {
  say(EV_ABS, axis, value);
  say(EV_SYN, SYN_REPORT, 0);
}

void UinputPad::press(std::uint16_t key, bool down) const {
  say(EV_KEY, key, down ? 1 : 0);
  say(EV_SYN, SYN_REPORT, 0);
}

UinputPad::Effect UinputPad::effect(std::uint16_t type) const {
  const std::lock_guard guard(lock_);
  const auto found = std::ranges::find_if(effects_, [&](const Effect& e) { return e.made && e.level.type == type; });
  return found == effects_.end() ? Effect{} : *found;
}

bool UinputPad::plays() const {
  const std::lock_guard guard(lock_);
  return std::ranges::any_of(effects_, [](const Effect& e) { return e.made && e.playing; });
}

bool UinputPad::hasEffects() const {
  const std::lock_guard guard(lock_);
  return std::ranges::any_of(effects_, &Effect::made);
}

int UinputPad::centring() const {
  const std::lock_guard guard(lock_);
  return centring_;
}

int UinputPad::gain() const {
  const std::lock_guard guard(lock_);
  return gain_;
}

void UinputPad::serve(const std::stop_token& stopping) {
  while (!stopping.stop_requested()) {
    pollfd waits{.fd = fd_.get(), .events = POLLIN, .revents = 0};
    if (::poll(&waits, 1, 10) <= 0) continue;
    input_event event{};
    while (::read(fd_.get(), &event, sizeof event) == static_cast<ssize_t>(sizeof event)) obey(event);
  }
}

void UinputPad::obey(const input_event& event) {
  const std::lock_guard guard(lock_);
  if (event.type == EV_UINPUT && event.code == UI_FF_UPLOAD) {
    uinput_ff_upload upload{};
    upload.request_id = static_cast<__u32>(event.value);
    ::ioctl(fd_.get(), UI_BEGIN_FF_UPLOAD, &upload);
    Effect& effect = effects_.at(static_cast<std::size_t>(upload.effect.id));
    effect.made = true;
    effect.level = upload.effect;
    upload.retval = 0;
    ::ioctl(fd_.get(), UI_END_FF_UPLOAD, &upload);
  } else if (event.type == EV_UINPUT && event.code == UI_FF_ERASE) {
    uinput_ff_erase erase{};
    erase.request_id = static_cast<__u32>(event.value);
    ::ioctl(fd_.get(), UI_BEGIN_FF_ERASE, &erase);
    effects_.at(erase.effect_id) = {};
    erase.retval = 0;
    ::ioctl(fd_.get(), UI_END_FF_ERASE, &erase);
  } else if (event.type == EV_FF && event.code == FF_GAIN) {
    gain_ = event.value;
  } else if (event.type == EV_FF && event.code == FF_AUTOCENTER) {
    centring_ = event.value;
  } else if (event.type == EV_FF && event.code < effects_.size()) {
    effects_[event.code].playing = event.value != 0;
  }
}

void UinputPad::say(std::uint16_t type, std::uint16_t code, std::int32_t value) const {
  const input_event event{.time = {}, .type = type, .code = code, .value = value};
  if (::write(fd_.get(), &event, sizeof event) < 0) return;  // the test then does not see what it expects
}

}  // namespace relievo::test
