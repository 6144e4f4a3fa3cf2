// SPDX-License-Identifier: Apache-2.0
// Uses libusb to find, open, claim and set up the device, and usbfs on libusb's descriptor for each tick's exchange.
//
// libusb allocates an array of URBs for every submitted transfer and takes mutexes at submit and completion (its
// linux_usbfs.c), which a real-time tick must not do. Its transfers are therefore used for set-up only. For the
// exchange the URBs are allocated once and passed to the kernel directly, with the ioctls USBDEVFS_SUBMITURB and
// USBDEVFS_REAPURBNDELAY. No thread handles libusb's events meanwhile, so libusb never reaps these URBs.
#include <fcntl.h>
#include <libusb.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "drivers/usb/quiet_list.h"
#include "drivers/usb/usb_port.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr const char* kGone = "the USB device has gone away; plug it in again";
constexpr std::size_t kQueuedReads = 2;  // one is always with the kernel while the other is read

std::unexpected<Error> failUsb(int code) {
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return fail(ErrorCode::Lost, kGone);
    case LIBUSB_ERROR_TIMEOUT:
      return fail(ErrorCode::Timeout, "the USB device did not answer in time; check its power adaptor");
    case LIBUSB_ERROR_ACCESS:
      return fail(ErrorCode::PermissionDenied,
                  "no permission to use the USB device; copy toolchain/udev/70-relievo.rules to "
                  "/etc/udev/rules.d and plug it in again");
    default:
      return fail(ErrorCode::Io, "a USB transfer failed; try another port or cable");
  }
}

class LibusbPort final : public UsbPort {
 public:
  explicit LibusbPort(std::vector<UsbDeviceId> ids) : ids_(std::move(ids)) {}
  ~LibusbPort() override { close(); }
  LibusbPort(const LibusbPort&) = delete;
  LibusbPort& operator=(const LibusbPort&) = delete;

  Result<void> open() override {
    if (libusb_init(&context_) != 0) {
      context_ = nullptr;
      return fail(ErrorCode::Unsupported, "libusb cannot use this machine's USB; check /dev/bus/usb");
    }
    auto opened = openDevice();
    if (!opened) close();
    return opened;
  }

  void close() noexcept override {
    stopExchange();
    if (handle_ != nullptr) {
      libusb_release_interface(handle_, 0);
      libusb_close(handle_);
    }
    if (context_ != nullptr) libusb_exit(context_);
    handle_ = nullptr;
    context_ = nullptr;
    fd_.reset();
  }

  Result<void> control(std::uint8_t request, std::uint16_t value) override {
    constexpr std::uint8_t kVendorToDevice = 0x40;
    constexpr unsigned kTimeoutMs = 100;
    const int done = libusb_control_transfer(handle_, kVendorToDevice, request, value, 0, nullptr, 0, kTimeoutMs);
    if (done < 0) return failUsb(done);
    return {};
  }

  Result<void> send(UsbBytes bytes, Duration timeout) override {
    const auto sent = transfer(id_.out_endpoint, const_cast<std::uint8_t*>(bytes.data()), bytes.size(), timeout);
    if (!sent) return std::unexpected(sent.error());
    if (*sent != bytes.size())
      return fail(ErrorCode::Timeout,
                  "the USB device accepted only a part of what was sent; unplug it and plug it in again");
    return {};
  }

  Result<UsbPacket> receive(Duration timeout) override {
    UsbPacket packet;
    const auto received = transfer(id_.in_endpoint, packet.data.data(), packet.data.size(), timeout);
    if (!received) return std::unexpected(received.error());
    packet.bytes = *received;
    return packet;
  }

  Result<void> startExchange(UsbBytes quiet) override {
    quiet_.fd = fd_.get();
    quiet_.endpoint = id_.out_endpoint;
    quiet_.bytes = std::min(quiet.size(), kUsbPacketBytes);
    quiet_.command = out_.urb.get();
    quiet_.silenced = false;
    std::copy_n(quiet.begin(), quiet_.bytes, quiet_.packet.begin());
    exchanging_ = true;
    next_ = 0;
    for (Transfer& in : in_) {
      if (auto queued = submit(in, id_.in_endpoint, kUsbPacketBytes); !queued) {
        stopExchange();
        return queued;
      }
    }
    listing_.emplace(quiet_);
    return {};
  }

  Result<UsbPacket> take() RELIEVO_RT override {
    if (auto reaped = reap(); !reaped) return std::unexpected(reaped.error());
    Transfer& in = in_[next_];
    if (in.busy) return UsbPacket{};
    UsbPacket packet;
    if (in.urb->status == 0 || in.urb->status == -EREMOTEIO) {
      packet.data = in.data;
      packet.bytes = static_cast<std::size_t>(in.urb->actual_length);
    } else if (in.urb->status == -ENODEV || in.urb->status == -ESHUTDOWN) {
      return fail(ErrorCode::Lost, kGone);
    }
    next_ = (next_ + 1) % kQueuedReads;
    if (auto queued = submit(in, id_.in_endpoint, kUsbPacketBytes); !queued) return std::unexpected(queued.error());
    return packet;
  }

  Result<bool> post(UsbBytes bytes) RELIEVO_RT override {
    if (auto reaped = reap(); !reaped) return std::unexpected(reaped.error());
    if (out_.busy || quiet_.silenced || bytes.size() > kUsbPacketBytes) return false;
    std::copy(bytes.begin(), bytes.end(), out_.data.begin());
    if (auto sent = submit(out_, id_.out_endpoint, bytes.size()); !sent) return std::unexpected(sent.error());
    return true;
  }

  void stopExchange() noexcept override {
    if (!exchanging_) return;
    listing_.reset();
    for (Transfer* each : {&in_[0], &in_[1], &out_}) {
      if (each->busy) ::ioctl(fd_.get(), USBDEVFS_DISCARDURB, each->urb.get());
    }
    // A discarded URB must still be reaped; until then the kernel owns its memory.
    while (in_[0].busy || in_[1].busy || out_.busy) {
      void* done = nullptr;
      if (::ioctl(fd_.get(), USBDEVFS_REAPURB, &done) == 0) finished(done);
      else if (errno != EINTR) break;
    }
    exchanging_ = false;
  }

  bool quieten() noexcept override { return !exchanging_ || sendQuiet(quiet_); }

 private:
  struct Transfer {
    // By pointer: usbdevfs_urb ends in a flexible array member, so no other structure may contain it.
    std::unique_ptr<usbdevfs_urb> urb = std::make_unique<usbdevfs_urb>();
    std::array<std::uint8_t, kUsbPacketBytes> data{};
    bool busy = false;  // the kernel owns it
  };

  Result<void> openDevice() {
    libusb_device** list = nullptr;
    const ssize_t count = libusb_get_device_list(context_, &list);
    if (count < 0) return failUsb(static_cast<int>(count));
    Result<void> result = fail(ErrorCode::NotFound, "no such device was found; check its cable and its power");
    for (ssize_t i = 0; i < count; ++i) {
      libusb_device_descriptor descriptor{};
      libusb_get_device_descriptor(list[i], &descriptor);
      const auto id = std::ranges::find_if(ids_, [&](const UsbDeviceId& each) {
        return descriptor.idVendor == each.vendor && descriptor.idProduct == each.product;
      });
      if (id == ids_.end()) continue;
      id_ = *id;
      result = claim(list[i]);
      if (result) break;
    }
    libusb_free_device_list(list, 1);
    return result;
  }

  // The node is opened here and passed to libusb, so that both use one descriptor.
  Result<void> claim(libusb_device* device) {
    char node[32];
    std::snprintf(node, sizeof node, "/dev/bus/usb/%03u/%03u", unsigned{libusb_get_bus_number(device)},
                  unsigned{libusb_get_device_address(device)});
    const int opened = ::open(node, O_RDWR | O_CLOEXEC);
    if (opened < 0) {
      const int why = errno;
      if (why == EACCES || why == EPERM) return failUsb(LIBUSB_ERROR_ACCESS);
      return fail(ErrorCode::NotFound, "the USB device's node in /dev cannot be opened; plug the device in again", why);
    }
    fd_.reset(opened);
    if (const int wrapped = libusb_wrap_sys_device(context_, fd_.get(), &handle_); wrapped != 0) {
      handle_ = nullptr;
      return failUsb(wrapped);
    }
    libusb_set_auto_detach_kernel_driver(handle_, 1);
    const int claimed = libusb_claim_interface(handle_, 0);
    if (claimed == 0) return {};
    libusb_close(handle_);
    handle_ = nullptr;
    if (claimed == LIBUSB_ERROR_BUSY)
      return fail(
          ErrorCode::Unsupported,
          "the device is already a finger, or another program uses it; plug in another one, or end that program");
    return failUsb(claimed);
  }

  Result<std::size_t> transfer(std::uint8_t endpoint, std::uint8_t* data, std::size_t bytes, Duration timeout) {
    const auto milliseconds = static_cast<unsigned>(
        std::max<Duration::rep>(1, std::chrono::ceil<std::chrono::milliseconds>(timeout).count()));
    int moved = 0;
    const auto verb = id_.interrupt ? libusb_interrupt_transfer : libusb_bulk_transfer;
    const int done = verb(handle_, endpoint, data, static_cast<int>(bytes), &moved, milliseconds);
    if (done != 0) return failUsb(done);
    return static_cast<std::size_t>(moved);
  }

  Result<void> submit(Transfer& transfer, std::uint8_t endpoint, std::size_t bytes) RELIEVO_RT {
    std::memset(transfer.urb.get(), 0, sizeof(usbdevfs_urb));
    transfer.urb->type = id_.interrupt ? USBDEVFS_URB_TYPE_INTERRUPT : USBDEVFS_URB_TYPE_BULK;
    transfer.urb->endpoint = endpoint;
    transfer.urb->buffer = transfer.data.data();
    transfer.urb->buffer_length = static_cast<int>(bytes);
    if (::ioctl(fd_.get(), USBDEVFS_SUBMITURB, transfer.urb.get()) != 0) return failSystem(errno);
    transfer.busy = true;
    return {};
  }

  Result<void> reap() RELIEVO_RT {
    for (;;) {
      void* done = nullptr;
      if (::ioctl(fd_.get(), USBDEVFS_REAPURBNDELAY, &done) != 0) {
        if (errno == EAGAIN) return {};
        return failSystem(errno);
      }
      finished(done);
    }
  }

  void finished(const void* urb) RELIEVO_RT {
    for (Transfer* each : {&in_[0], &in_[1], &out_}) {
      if (urb == each->urb.get()) each->busy = false;
    }
  }

  static std::unexpected<Error> failSystem(int number) RELIEVO_RT {
    if (number == ENODEV || number == ESHUTDOWN) return fail(ErrorCode::Lost, kGone, number);
    return fail(ErrorCode::Io, "a USB transfer failed; try another port or cable", number);
  }

  std::vector<UsbDeviceId> ids_;
  UsbDeviceId id_;  // of the open device
  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  UniqueFd fd_;
  bool exchanging_ = false;
  std::array<Transfer, kQueuedReads> in_;
  Transfer out_;
  std::size_t next_ = 0;  // index of the read that was queued first
  QuietEntry quiet_;
  std::optional<QuietListing> listing_;
};

}  // namespace

bool usbDeviceIsThere(std::span<const UsbDeviceId> ids) {
  libusb_context* context = nullptr;
  if (libusb_init(&context) != 0) return false;
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  bool there = false;
  for (ssize_t i = 0; i < count && !there; ++i) {
    libusb_device_descriptor descriptor{};
    libusb_get_device_descriptor(list[i], &descriptor);
    there = std::ranges::any_of(ids, [&](const UsbDeviceId& id) {
      return descriptor.idVendor == id.vendor && descriptor.idProduct == id.product;
    });
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  libusb_exit(context);
  return there;
}

std::unique_ptr<UsbPort> makeLibusbPort(std::vector<UsbDeviceId> ids) {
  return std::make_unique<LibusbPort>(std::move(ids));
}

}  // namespace relievo
