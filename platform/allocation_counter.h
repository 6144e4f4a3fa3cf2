// SPDX-License-Identifier: Apache-2.0
// Counts the calling thread's allocations, to prove that a real-time loop makes none.
#pragma once

#include <cstdint>

#include "platform/realtime.h"

namespace relievo {

// Calls of malloc, calloc, realloc, aligned_alloc and operator new by this thread since it began, from any library.
// Every program that links this gets the counting allocator in place of the C library's; under a sanitizer, the
// sanitizer's hooks count instead.
[[nodiscard]] std::uint64_t threadAllocations() RELIEVO_RT;

}  // namespace relievo
