// SPDX-License-Identifier: Apache-2.0
// Reads an input device's events on a real-time thread: without waiting, and without reports of which the kernel's
// queue has lost a part.
#pragma once

#include <linux/input.h>

#include <array>
#include <cstddef>

#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

// After SYN_DROPPED the rest of the report is invalid, and the device has to be asked for its state (kernel,
// Documentation/input/event-codes.rst).
class EventReports {
 public:
  // Reads what is pending, up to a quantity that no device sends within a tick. `port.take` fills a span of events and
  // returns their number. `each` gets every valid event; `ask`, a Result<void>, is called after a report that lost
  // some. Real-time if the three are.
  template <class Port, class Each, class Ask>
  [[nodiscard]] Result<void> follow(Port& port, const Each& each, const Ask& ask) RELIEVO_RT {
    std::array<input_event, kEventsARead> events;
    for (int i = 0; i < kReads; ++i) {
      const auto taken = port.take(events);
      if (!taken) return std::unexpected(taken.error());
      for (std::size_t e = 0; e < *taken; ++e) {
        if (auto followed = judge(events[e], each, ask); !followed) return followed;
      }
      if (*taken < kEventsARead) break;
    }
    return {};
  }

 private:
  static constexpr std::size_t kEventsARead = 64;
  static constexpr int kReads = 4;

  template <class Each, class Ask>
  Result<void> judge(const input_event& event, const Each& each, const Ask& ask) RELIEVO_RT {
    if (event.type == EV_SYN && event.code == SYN_DROPPED) dropped_ = true;
    if (dropped_ && event.type == EV_SYN && event.code == SYN_REPORT) {
      dropped_ = false;
      return ask();
    }
    if (!dropped_) each(event);
    return {};
  }

  bool dropped_ = false;  // within a report that lost events
};

}  // namespace relievo
