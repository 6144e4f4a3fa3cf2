// SPDX-License-Identifier: Apache-2.0
// The open devices, for a handler of fatal signals.
#pragma once

#include <cstdint>

namespace relievo {

// Lists an open device while this object lives; at most four are listed.
class PadListing {
 public:
  PadListing() = default;
  ~PadListing() { remove(); }
  PadListing(const PadListing&) = delete;
  PadListing& operator=(const PadListing&) = delete;
  // `centring`: the device has a centring of its own, which is set to full strength at the end.
  void put(int fd, bool centring) noexcept;
  void remove() noexcept;

 private:
  int place_ = -1;
};

// Stops the effects of every listed device. Async-signal-safe; does not wait.
void quietenAllPads() noexcept;

}  // namespace relievo
