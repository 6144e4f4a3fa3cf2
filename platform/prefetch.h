// SPDX-License-Identifier: Apache-2.0
// Prefetches memory into the caches. Between two ticks a decoder evicts the tick's code and state; a tick that then
// fetches them one cache line at a time takes many times as long as its work.
#pragma once

#include <cstdint>

#include "platform/realtime.h"

// Marks a function that a tick runs: the linker puts all marked functions side by side.
#define RELIEVO_TICK_CODE [[gnu::section("relievo_tick")]]

// The linker defines these bounds for a section whose name is a C identifier.
// NOLINTNEXTLINE(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp,readability-identifier-naming)
extern "C" const char __start_relievo_tick[], __stop_relievo_tick[];

namespace relievo {

// Returns at once; the memory, and up to three cache lines after it, are fetched in the background.
inline void prefetch(const void* begin, const void* end) RELIEVO_RT {
  constexpr std::uintptr_t kLine = 64;
  for (auto line = reinterpret_cast<std::uintptr_t>(begin) & ~(kLine - 1); line < reinterpret_cast<std::uintptr_t>(end);
       line += 4 * kLine) {
    for (std::uintptr_t k = 0; k < 4; ++k) __builtin_prefetch(reinterpret_cast<const void*>(line + k * kLine), 0, 3);
  }
}

inline void prefetchTickCode() RELIEVO_RT {
  prefetch(__start_relievo_tick, __stop_relievo_tick);
}

}  // namespace relievo
