// SPDX-License-Identifier: Apache-2.0
// The taps of a law, added up by slot: frames that repeat each other share one.
#include "app/haptics/method/weighed_frames.h"

namespace relievo {

void WeighedFrames::weigh(TimeLaw by, const FrameSlots& slots, const FrameMoment& at,
                          const FrameMoment& at_later) RELIEVO_RT {
  moment = at;
  law = by;
  frames.window = slots.window;
  frames.frame_of_slot = slots.frame;
  frames.weight.fill(0);
  frames.wanted = 0;
  added.fill(0);
  later.fill(0);
  const FrameTaps taps(at, by), then(at_later, by);
  const FrameTaps more = by == TimeLaw::Adapted ? FrameTaps::addedByFitted(at) : FrameTaps{};
  for (std::size_t i = 0; i < FrameTaps::kCount; ++i) {
    if (taps.weight[i] == 0 && then.weight[i] == 0 && more.weight[i] == 0) continue;
    const std::uint8_t slot = slots.of_frame[FrameTaps::frame(at, static_cast<int>(i))];
    frames.weight[slot] += taps.weight[i];
    later[slot] += then.weight[i];
    added[slot] += more.weight[i];
    frames.wanted |= 1U << slot;
  }
}

}  // namespace relievo
