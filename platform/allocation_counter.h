// SPDX-License-Identifier: Apache-2.0
// How often the calling thread has allocated: the proof that a real-time loop does not.
#pragma once

#include <cstdint>

#include "platform/realtime.h"

namespace relievo {

// Calls of malloc, calloc, realloc, aligned_alloc and operator new by this thread since it began, from whatever
// library. The counting allocator stands in for the C library's in every program that links this; under a sanitizer its
// hooks are used instead.
[[nodiscard]] std::uint64_t threadAllocations() RELIEVO_RT;

}  // namespace relievo
