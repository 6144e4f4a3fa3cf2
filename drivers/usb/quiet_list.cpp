// SPDX-License-Identifier: Apache-2.0
// Plain atomics and one system call: nothing here may need a lock that the dying thread holds.
#include "drivers/usb/quiet_list.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <atomic>
#include <cerrno>

namespace relievo {
namespace {

std::array<std::atomic<const QuietEntry*>, 4> listed;
static_assert(std::atomic<const QuietEntry*>::is_always_lock_free);

}  // namespace

void sendQuiet(const QuietEntry& entry) noexcept {
  constexpr unsigned kTimeoutMs = 20;
  const int saved = errno;
  usbdevfs_bulktransfer transfer{};
  transfer.ep = entry.endpoint;
  transfer.len = static_cast<unsigned>(entry.bytes);
  transfer.timeout = kTimeoutMs;
  transfer.data = const_cast<std::uint8_t*>(entry.packet.data());  // read only: the endpoint is an OUT one
  static_cast<void>(::ioctl(entry.fd, USBDEVFS_BULK, &transfer));  // a device that does not answer has no motors
  errno = saved;
}

QuietListing::QuietListing(const QuietEntry& entry) noexcept : entry_(&entry) {
  for (auto& place : listed) {
    const QuietEntry* none = nullptr;
    if (place.compare_exchange_strong(none, entry_)) return;
  }
}

QuietListing::~QuietListing() {
  for (auto& place : listed) {
    const QuietEntry* mine = entry_;
    if (place.compare_exchange_strong(mine, nullptr)) return;
  }
}

void quietenAllUsbDevices() noexcept {
  for (const auto& place : listed) {
    if (const QuietEntry* entry = place.load()) sendQuiet(*entry);
  }
}

}  // namespace relievo
