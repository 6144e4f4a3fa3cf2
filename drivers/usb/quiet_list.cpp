// SPDX-License-Identifier: Apache-2.0
// Uses only atomics and ioctl, since a crashed thread may hold any lock.
#include "drivers/usb/quiet_list.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <atomic>
#include <cerrno>

namespace relievo {
namespace {

std::array<std::atomic<QuietEntry*>, 4> listed;
static_assert(std::atomic<QuietEntry*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

}  // namespace

bool sendQuiet(const QuietEntry& entry) noexcept {
  constexpr unsigned kTimeoutMs = 20;
  const int saved = errno;
  usbdevfs_bulktransfer transfer{};
  transfer.ep = entry.endpoint;
  transfer.len = static_cast<unsigned>(entry.bytes);
  transfer.timeout = kTimeoutMs;
  transfer.data = const_cast<std::uint8_t*>(entry.packet.data());            // only read, since this is an OUT endpoint
  static_cast<void>(::ioctl(entry.fd, USBDEVFS_DISCARDURB, entry.command));  // fails if there is none
  const bool taken = ::ioctl(entry.fd, USBDEVFS_BULK, &transfer) >= 0;
  errno = saved;
  return taken;
}

QuietListing::QuietListing(QuietEntry& entry) noexcept : entry_(&entry) {
  for (auto& place : listed) {
    QuietEntry* none = nullptr;
    if (place.compare_exchange_strong(none, entry_)) return;
  }
}

QuietListing::~QuietListing() {
  for (auto& place : listed) {
    QuietEntry* mine = entry_;
    if (place.compare_exchange_strong(mine, nullptr)) return;
  }
}

void quietenAllUsbDevices() noexcept {
  // Twice: a tick that had already checked `silenced` may have sent its force after the first round.
  for (int round = 0; round < 2; ++round) {
    for (const auto& place : listed) {
      QuietEntry* entry = place.load();
      if (entry == nullptr) continue;
      entry->silenced = true;
      static_cast<void>(sendQuiet(*entry));  // nothing more can be done for a device that does not answer
    }
  }
}

}  // namespace relievo
