// SPDX-License-Identifier: Apache-2.0
// Uses only atomics and write, since a crashed thread may hold any lock.
#include "drivers/gamepad/pad_list.h"

#include <linux/input.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>

namespace relievo {
namespace {

// `listed` holds descriptors fd; -fd - 1 for a device without a centring spring.
constexpr int kFree = 0x7fffffff;
constexpr std::uint16_t kMostEffects = 16;  // more than this driver makes
std::array<std::atomic<int>, 4> listed{kFree, kFree, kFree, kFree};
static_assert(std::atomic<int>::is_always_lock_free);

void say(int fd, std::uint16_t code, std::int32_t value) noexcept {
  const input_event event{.time = {}, .type = EV_FF, .code = code, .value = value};
  if (::write(fd, &event, sizeof event) < 0) return;  // nothing more can be done
}

}  // namespace

void PadListing::put(int fd, bool centring) noexcept {
  remove();
  for (std::size_t i = 0; i < listed.size(); ++i) {
    int none = kFree;
    if (!listed[i].compare_exchange_strong(none, centring ? fd : -fd - 1)) continue;
    place_ = static_cast<int>(i);
    return;
  }
}

void PadListing::remove() noexcept {
  if (place_ >= 0) listed[static_cast<std::size_t>(place_)] = kFree;
  place_ = -1;
}

void quietenAllPads() noexcept {
  const int saved = errno;
  for (const auto& place : listed) {
    const int entry = place.load();
    if (entry == kFree) continue;
    const int fd = entry >= 0 ? entry : -entry - 1;
    for (std::uint16_t id = 0; id < kMostEffects; ++id) say(fd, id, 0);  // one that was not made is ignored
    if (entry >= 0) say(fd, FF_AUTOCENTER, 0xffff);
  }
  errno = saved;
}

}  // namespace relievo
