// SPDX-License-Identifier: Apache-2.0
// Has the processor fetch memory before it is needed. Between two ticks a decoder has had the caches to itself, and a
// tick that waits for its own code and state, a line at a time, takes many times as long as its work.
#pragma once

#include <cstdint>

#include "platform/realtime.h"

// Before the definition of a function that a tick runs: its code lies beside that of the others so marked.
#define RELIEVO_TICK_CODE [[gnu::section("relievo_tick")]]

// The linker's, for a section whose name is an identifier.
// NOLINTNEXTLINE(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp,readability-identifier-naming)
extern "C" const char __start_relievo_tick[], __stop_relievo_tick[];

namespace relievo {

// Returns at once; what is asked for comes meanwhile.
inline void prefetch(const void* begin, const void* end) RELIEVO_RT {
  constexpr std::uintptr_t kLine = 64;
  for (auto line = reinterpret_cast<std::uintptr_t>(begin) & ~(kLine - 1); line < reinterpret_cast<std::uintptr_t>(end);
       line += kLine) {
    __builtin_prefetch(reinterpret_cast<const void*>(line), 0, 3);
  }
}

inline void prefetchTickCode() RELIEVO_RT {
  prefetch(__start_relievo_tick, __stop_relievo_tick);
}

}  // namespace relievo
