// SPDX-License-Identifier: Apache-2.0
// Answers the requests of <linux/input.h> that libevdev and the driver make.
#include "tests/support/device/umockdev_mouse.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace relievo::test {

UmockdevMouse::Codes UmockdevMouse::mouse() {
  return {{EV_SYN, {SYN_REPORT}}, {EV_KEY, {BTN_LEFT, BTN_RIGHT, BTN_MIDDLE}}, {EV_REL, {REL_X, REL_Y, REL_WHEEL}}};
}
UmockdevMouse::Codes UmockdevMouse::keyboard() {
  return {{EV_SYN, {SYN_REPORT}}, {EV_KEY, {KEY_A, KEY_B, KEY_ENTER}}};
}
UmockdevMouse::Codes UmockdevMouse::remote() {
  return {{EV_SYN, {SYN_REPORT}}, {EV_KEY, {KEY_OK, KEY_LEFT, KEY_RIGHT, KEY_PLAYPAUSE}}};
}
UmockdevMouse::Codes UmockdevMouse::pad() {
  return {{EV_SYN, {SYN_REPORT}},
          {EV_KEY,
           {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_TL, BTN_TR, BTN_SELECT, BTN_START, BTN_MODE, BTN_THUMBL,
            BTN_THUMBR}},
          {EV_ABS, {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ, ABS_HAT0X, ABS_HAT0Y}}};
}

UmockdevMouse::UmockdevMouse(UMockdevTestbed* bed, int number, Codes codes)
    : bed_(bed),
      node_("/dev/input/event" + std::to_string(number)),
      device_("/sys/devices/platform/mouse/input/event" + std::to_string(number)),
      codes_(std::move(codes)),
      requests_([this](UMockdevIoctlClient* client) {
        const std::lock_guard guard(lock_);
        return answer(client);
      }) {
  const std::string name = "event" + std::to_string(number);
  const std::string description = "P: /devices/platform/mouse/input/" + name + "\nN: input/" + name +
                                  "\nE: DEVNAME=/dev/input/" + name +
                                  "\nE: MAJOR=13\nE: MINOR=" + std::to_string(64 + number) + "\nE: SUBSYSTEM=input\n\n";
  umockdev_testbed_add_from_string(bed_, description.c_str(), nullptr);
  umockdev_testbed_attach_ioctl(bed_, node_.c_str(), requests_.handler(), nullptr);
}

void UmockdevMouse::say(std::uint16_t type, std::uint16_t code, std::int32_t value) {
  const input_event event{.type = type, .code = code, .value = value};
  const int fd = umockdev_testbed_get_dev_fd(bed_, node_.c_str());
  if (::write(fd, &event, sizeof event) != static_cast<ssize_t>(sizeof event)) ++unknown_;
}

void UmockdevMouse::unplug() {
  umockdev_testbed_detach_ioctl(bed_, node_.c_str(), nullptr);
  // The node is a terminal: when its other end closes, a read fails. The test bed keeps a descriptor to close.
  const int end = umockdev_testbed_get_dev_fd(bed_, node_.c_str()), nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, end);
  ::close(nothing);
  umockdev_testbed_remove_device(bed_, device_.c_str());
}

void UmockdevMouse::hold(std::uint16_t key, bool down) {
  const std::lock_guard guard(lock_);
  std::erase(held_, key);
  if (down) held_.push_back(key);
}

input_absinfo UmockdevMouse::rangeOf(std::size_t axis) const {
  if (const auto own = ranges_.find(axis); own != ranges_.end()) return own->second;
  const bool is_hat = axis == ABS_HAT0X || axis == ABS_HAT0Y, is_trigger = axis == ABS_Z || axis == ABS_RZ;
  const int most = is_hat ? 1 : is_trigger ? 255 : 32767;
  return {.minimum = is_trigger ? 0 : -most, .maximum = most};
}

bool UmockdevMouse::grab(UMockdevIoctlClient* client) {
  std::uintptr_t wanted = 0;  // a number for an argument, not a pointer
  std::memcpy(&wanted, umockdev_ioctl_client_get_arg(client)->data, sizeof wanted);
  const bool refused = others_grab_ && wanted != 0;
  if (!refused) grabbed_ = wanted != 0;
  umockdev_ioctl_client_complete(client, refused ? -1 : 0, refused ? EBUSY : 0);
  return true;
}

bool UmockdevMouse::answer(UMockdevIoctlClient* client) {
  const auto request = umockdev_ioctl_client_get_request(client);
  const std::size_t size = _IOC_SIZE(request);
  const unsigned number = _IOC_NR(request);
  if (request == EVIOCGRAB) return grab(client);
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, size, nullptr);
  const auto complete = [client](long result, int error = 0) {
    umockdev_ioctl_client_complete(client, result, error);
    return true;
  };
  // A set of bits, in the requested number of bytes.
  const auto bits = [&](const std::vector<std::uint16_t>& set) {
    std::memset(data->data, 0, size);
    for (const std::uint16_t bit : set) {
      if (bit / 8U < size) data->data[bit / 8U] = static_cast<std::uint8_t>(data->data[bit / 8U] | 1U << bit % 8U);
    }
    return complete(static_cast<long>(size));
  };
  const auto text = [&](const char* words) {
    std::strncpy(reinterpret_cast<char*>(data->data), words, size);
    return complete(static_cast<long>(std::strlen(words) + 1));
  };
  if (_IOC_TYPE(request) != 'E' || _IOC_DIR(request) != _IOC_READ) {
    ++unknown_;
    return complete(-1, ENOTTY);
  }
  if (number == _IOC_NR(EVIOCGVERSION)) {
    const int version = EV_VERSION;
    std::memcpy(data->data, &version, sizeof version);
    return complete(0);
  }
  if (number == _IOC_NR(EVIOCGID)) {
    const input_id id{BUS_USB, 0x1234, 0x5678, 1};
    std::memcpy(data->data, &id, sizeof id);
    return complete(0);
  }
  if (number == _IOC_NR(EVIOCGNAME(0))) return text("A mouse that is not there");
  if (number == _IOC_NR(EVIOCGPHYS(0)) || number == _IOC_NR(EVIOCGUNIQ(0))) return complete(-1, ENOENT);
  if (number == _IOC_NR(EVIOCGKEY(0))) return bits(held_);
  if (number == _IOC_NR(EVIOCGPROP(0)) || number == _IOC_NR(EVIOCGLED(0)) || number == _IOC_NR(EVIOCGSW(0))) {
    return bits({});
  }
  if (number == _IOC_NR(EVIOCGBIT(0, 0))) {
    std::vector<std::uint16_t> types;
    for (const auto& [type, codes] : codes_) types.push_back(type);
    return bits(types);
  }
  if (number > _IOC_NR(EVIOCGBIT(0, 0)) && number <= _IOC_NR(EVIOCGBIT(EV_MAX, 0))) {
    const auto found = codes_.find(static_cast<std::uint16_t>(number - _IOC_NR(EVIOCGBIT(0, 0))));
    return bits(found == codes_.end() ? std::vector<std::uint16_t>{} : found->second);
  }
  if (number >= _IOC_NR(EVIOCGABS(0)) && number <= _IOC_NR(EVIOCGABS(ABS_MAX))) {
    const input_absinfo range = rangeOf(number - _IOC_NR(EVIOCGABS(0)));
    std::memcpy(data->data, &range, sizeof range);
    return complete(0);
  }
  ++unknown_;
  return complete(-1, ENOTTY);
}

}  // namespace relievo::test
