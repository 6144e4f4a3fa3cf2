// SPDX-License-Identifier: Apache-2.0
// Answers the requests of <linux/usbdevice_fs.h> that libusb and the driver make, by the model.
#include "tests/support/device/usb/umockdev_usb.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "platform/clock.h"

namespace relievo::test {
namespace {

constexpr long kFullSpeed = 2;  // <linux/usb/ch9.h>
constexpr const char* kDevice = "/sys/devices/pci0000:00/usb1/1-1";
constexpr const char* kNode = "/dev/bus/usb/001/002";

std::vector<std::uint8_t> descriptorsOf(const UsbDeviceId& id) {
  std::vector<std::uint8_t> all = deviceDescriptor(id);
  const std::vector<std::uint8_t> configuration = configurationDescriptor(id);
  all.insert(all.end(), configuration.begin(), configuration.end());
  return all;
}

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  char two[3];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(two, sizeof two, "%02X", unsigned{byte});
    text += two;
  }
  return text;
}

std::string describe(const UsbDeviceId& id) {
  char ids[160];
  std::snprintf(ids, sizeof ids, "A: idVendor=%04x\\n\nA: idProduct=%04x\\n\n", unsigned{id.vendor},
                unsigned{id.product});
  const std::string descriptors = hex(descriptorsOf(id));
  return "P: /devices/pci0000:00/usb1/1-1\nN: bus/usb/001/002=" + descriptors +
         "\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/bus/usb/001/002\nE: BUSNUM=001\nE: DEVNUM=002\nE: MAJOR=189\n"
         "E: MINOR=1\nE: SUBSYSTEM=usb\nA: busnum=1\\n\nA: devnum=2\\n\nA: devpath=1\\n\n" +
         ids +
         "A: bConfigurationValue=1\\n\nA: bNumConfigurations=1\\n\nA: speed=12\\n\nH: descriptors=" + descriptors +
         "\n\n";
}

usbdevfs_urb& urbOf(UMockdevIoctlData* data) {
  return *reinterpret_cast<usbdevfs_urb*>(data->data);
}

// Writes the answer into the memory that the request's argument points to.
template <class Value>
void fill(UMockdevIoctlData* argument, const Value& value) {
  std::memcpy(umockdev_ioctl_data_resolve(argument, 0, sizeof value, nullptr)->data, &value, sizeof value);
}

// libusb asks a device that was opened by descriptor for its configuration. False for any other control transfer.
bool answerConfiguration(UMockdevIoctlData* argument) {
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_ctrltransfer), nullptr);
  const auto& transfer = *reinterpret_cast<const usbdevfs_ctrltransfer*>(data->data);
  constexpr std::uint8_t kGetConfiguration = 8;
  if (transfer.bRequest != kGetConfiguration) return false;
  umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_ctrltransfer, data), transfer.wLength, nullptr)->data[0] = 1;
  return true;
}

}  // namespace

bool machineIsMocked() {
  const char* preloaded = std::getenv("LD_PRELOAD");
  return preloaded != nullptr && std::strstr(preloaded, "umockdev") != nullptr;
}

UmockdevUsb::UmockdevUsb(UsbModel& model, const UsbDeviceId& id)
    : model_(model), id_(id), requests_([this](UMockdevIoctlClient* client) {
        const std::lock_guard guard(lock_);
        return answer(client);
      }) {
  bed_ = umockdev_testbed_new();
  plug();
}

UmockdevUsb::~UmockdevUsb() {
  requests_.end();
  g_object_unref(bed_);
}

void UmockdevUsb::plug() {
  umockdev_testbed_add_from_string(bed_, describe(id_).c_str(), nullptr);
  umockdev_testbed_attach_ioctl(bed_, kNode, requests_.handler(), nullptr);
  {
    const std::lock_guard guard(lock_);
    plugged_ = true;
  }
  umockdev_testbed_uevent(bed_, kDevice, "add");
}

void UmockdevUsb::unplug() {
  {
    const std::lock_guard guard(lock_);
    plugged_ = false;
  }
  umockdev_testbed_uevent(bed_, kDevice, "remove");
  umockdev_testbed_detach_ioctl(bed_, kNode, nullptr);
  umockdev_testbed_remove_device(bed_, kDevice);
}

void UmockdevUsb::unplugAfter(int requests) {
  const std::lock_guard guard(lock_);
  requests_left_ = requests;
}

void UmockdevUsb::refuseSubmit(int number) {
  const std::lock_guard guard(lock_);
  submits_left_ = number;
}

std::size_t UmockdevUsb::waiting() {
  const std::lock_guard guard(lock_);
  return waiting_.size();
}

void UmockdevUsb::takesNothing() {
  const std::lock_guard guard(lock_);
  deaf_ = true;
}

void UmockdevUsb::takesAgain() {
  const std::lock_guard guard(lock_);
  deaf_ = false;
  for (const Urb& urb : untaken_) take(urb);
  untaken_.clear();
}

bool UmockdevUsb::answer(UMockdevIoctlClient* client) {
  const auto request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  const auto complete = [client](long result, int error = 0) {
    umockdev_ioctl_client_complete(client, result, error);
    return true;
  };
  if (requests_left_ > 0 && --requests_left_ == 0) plugged_ = false;
  const bool reaps = request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY;
  if (!plugged_) {
    // Each URB that the kernel still has is returned once; after that there is nothing to reap.
    for (std::deque<Urb>* queue : {&waiting_, &untaken_}) {
      for (const Urb& urb : *queue) finish(urb, -ESHUTDOWN, 0);
      queue->clear();
    }
    if (!reaps || done_.empty()) return complete(-1, ENODEV);
  }
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
      fill(argument, std::uint32_t{USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
                                   USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT});
      return complete(0);
    case USBDEVFS_CONNECTINFO:
      fill(argument, usbdevfs_connectinfo{.devnum = 2, .slow = 0});
      return complete(0);
    case USBDEVFS_GET_SPEED:
      return complete(kFullSpeed);
    case USBDEVFS_CONTROL:
      return answerConfiguration(argument) ? complete(1) : complete(-1, EPIPE);
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_RESET:
    case USBDEVFS_CLEAR_HALT:
      return complete(0);
    case USBDEVFS_GETDRIVER:
    case USBDEVFS_IOCTL:  // to give the interface back to a kernel driver: there is none
      return complete(-1, ENODATA);
    case USBDEVFS_SUBMITURB:
      if (submits_left_ > 0 && --submits_left_ == 0) return complete(-1, ENOMEM);
      return submit(argument) ? complete(0) : complete(-1, ENOENT);
    case USBDEVFS_BULK:
      bulk(argument, client);
      return true;
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY: {
      pump();
      if (done_.empty()) return complete(-1, EAGAIN);
      const Urb urb = done_.front();
      done_.pop_front();
      umockdev_ioctl_data_set_ptr(umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr), 0, urb.urb);
      return complete(0);
    }
    case USBDEVFS_DISCARDURB:
      return discard(argument) ? complete(0) : complete(-1, EINVAL);
    default:
      ++unknown_;
      return complete(-1, ENOTTY);
  }
}

bool UmockdevUsb::submit(UMockdevIoctlData* argument) {
  const MonotonicTime now = MonotonicClock().now();
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
  usbdevfs_urb& urb = urbOf(data);
  const bool control = urb.type == USBDEVFS_URB_TYPE_CONTROL;
  if (!control && urb.endpoint != id_.in_endpoint && urb.endpoint != id_.out_endpoint) return false;
  const auto length = static_cast<std::size_t>(urb.buffer_length);
  UMockdevIoctlData* buffer =
      length == 0 ? nullptr : umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_urb, buffer), length, nullptr);
  Urb pending{static_cast<UMockdevIoctlData*>(g_object_ref(data)),
              buffer == nullptr ? nullptr : static_cast<UMockdevIoctlData*>(g_object_ref(buffer))};
  if (control) {
    const std::uint8_t* setup = buffer->data;
    const bool vendor_out = setup[0] == 0x40;
    if (vendor_out) model_.control(setup[1], static_cast<std::uint16_t>(setup[2] | setup[3] << 8), now);
    finish(pending, vendor_out ? 0 : -EPIPE, 0);
  } else if ((urb.endpoint & 0x80) != 0) {
    waiting_.push_back(pending);
  } else if (deaf_) {
    untaken_.push_back(pending);
  } else {
    take(pending);
  }
  return true;
}

void UmockdevUsb::take(const Urb& urb) {
  const auto length = static_cast<std::size_t>(urbOf(urb.urb).buffer_length);
  model_.write({urb.buffer->data, length}, MonotonicClock().now());
  finish(urb, 0, length);
}

void UmockdevUsb::bulk(UMockdevIoctlData* argument, UMockdevIoctlClient* client) {
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_bulktransfer), nullptr);
  const auto& transfer = *reinterpret_cast<const usbdevfs_bulktransfer*>(data->data);
  UMockdevIoctlData* buffer =
      umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_bulktransfer, data), transfer.len, nullptr);
  if (deaf_ || transfer.ep != id_.out_endpoint) {
    umockdev_ioctl_client_complete(client, -1, deaf_ ? ETIMEDOUT : ENOENT);
    return;
  }
  model_.write({buffer->data, transfer.len}, MonotonicClock().now());
  umockdev_ioctl_client_complete(client, static_cast<long>(transfer.len), 0);
}

bool UmockdevUsb::discard(UMockdevIoctlData* argument) {
  const auto address = *reinterpret_cast<const gulong*>(argument->data);
  for (std::deque<Urb>* queue : {&waiting_, &untaken_}) {
    const auto found = std::ranges::find_if(*queue, [&](const Urb& u) { return u.urb->client_addr == address; });
    if (found == queue->end()) continue;
    finish(*found, -ENOENT, 0);
    queue->erase(found);
    return true;
  }
  return false;
}

void UmockdevUsb::pump() {
  while (!waiting_.empty()) {
    const auto packet = model_.read(MonotonicClock().now());
    if (!packet) return;
    const Urb urb = waiting_.front();
    waiting_.pop_front();
    const std::size_t bytes = std::min(packet->bytes, static_cast<std::size_t>(urbOf(urb.urb).buffer_length));
    std::memcpy(urb.buffer->data, packet->data.data(), bytes);
    finish(urb, 0, bytes);
  }
}

void UmockdevUsb::finish(const Urb& urb, int status, std::size_t bytes) {
  urbOf(urb.urb).status = status;
  urbOf(urb.urb).actual_length = static_cast<int>(bytes);
  done_.push_back(urb);
}

}  // namespace relievo::test
