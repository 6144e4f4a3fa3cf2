// SPDX-License-Identifier: Apache-2.0
// RELIEVO_RT marks functions that the real-time thread runs: no allocation, no lock, no system call, no exception.
#pragma once

#if defined(__clang__) && __clang_major__ >= 20
#define RELIEVO_RT noexcept [[clang::nonblocking]]
#else
#define RELIEVO_RT noexcept
#endif
