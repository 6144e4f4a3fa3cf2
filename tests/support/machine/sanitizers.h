// SPDX-License-Identifier: Apache-2.0
// Which sanitizers a test is built with: some counts differ under them.
#pragma once

#ifdef __has_feature
#define RELIEVO_HAS_FEATURE(x) __has_feature(x)
#else
#define RELIEVO_HAS_FEATURE(x) 0
#endif

namespace relievo {

#if defined(__SANITIZE_THREAD__) || RELIEVO_HAS_FEATURE(thread_sanitizer)
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif

// These have their own allocator, shadow memory that may fault at any time, and an mlock that does nothing.
#if defined(__SANITIZE_ADDRESS__) || RELIEVO_HAS_FEATURE(address_sanitizer) || RELIEVO_HAS_FEATURE(memory_sanitizer)
inline constexpr bool kMemorySanitizer = true;
#else
inline constexpr bool kMemorySanitizer = kThreadSanitizer;
#endif

// It ends the program when a real-time function allocates, instead of counting.
#if RELIEVO_HAS_FEATURE(realtime_sanitizer)
inline constexpr bool kRealtimeSanitizer = true;
#else
inline constexpr bool kRealtimeSanitizer = false;
#endif

}  // namespace relievo
