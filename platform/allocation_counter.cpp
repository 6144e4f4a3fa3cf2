// SPDX-License-Identifier: Apache-2.0
// The counting allocator: counts per thread, then calls the C library's allocator.
//
// The C library lets a program define malloc and its relatives; every library of the process then calls these.
// They forward to the C library's allocator by its other names (__libc_malloc and so on), so the heap and free
// are unchanged. operator new is not replaced: the C++ library's version calls malloc or aligned_alloc and is
// counted there, once. The definitions are in the same object file as threadAllocations, so linking one links
// all of them.
#include "platform/allocation_counter.h"

#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__SANITIZE_HWADDRESS__)
#define RELIEVO_SANITIZER_HEAP 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer) || \
    __has_feature(hwaddress_sanitizer)
#define RELIEVO_SANITIZER_HEAP 1
#elif __has_feature(realtime_sanitizer)
#define RELIEVO_WATCHED_HEAP 1  // RealtimeSanitizer reports allocations itself and must keep its own malloc
#endif
#endif

namespace relievo {
namespace {

// initial-exec: the variable lies in the thread's static TLS block, so that reading it never allocates and a
// real-time function may do so. The compiler cannot know this and rejects thread_local variables there; hence
// the pragma below.
[[gnu::tls_model("initial-exec")]] constinit thread_local std::uint64_t allocations = 0;

}  // namespace

#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
std::uint64_t threadAllocations() RELIEVO_RT {
  return allocations;
}

}  // namespace relievo

#ifdef RELIEVO_SANITIZER_HEAP

// Declared here: not every compiler ships sanitizer/allocator_interface.h. The names are the sanitizer's.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming,bugprone-throwing-static-initialization)
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                                         void (*)(const volatile void*));

namespace {

[[maybe_unused]] const int hooks = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++relievo::allocations; }, [](const volatile void*) {});

}  // namespace
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming,bugprone-throwing-static-initialization)

#elif !defined(RELIEVO_WATCHED_HEAP)

#ifndef __GLIBC__
#error "the counting allocator forwards to the GNU C library's allocator: build for a -gnu target"
#endif

extern "C" {

// The C library's own names. NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void* __libc_valloc(std::size_t bytes);
void* __libc_pvalloc(std::size_t bytes);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

void* malloc(std::size_t bytes) noexcept {
  ++relievo::allocations;
  return __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) noexcept {
  ++relievo::allocations;
  return __libc_calloc(count, bytes);
}

void* realloc(void* block, std::size_t bytes) noexcept {
  ++relievo::allocations;
  return __libc_realloc(block, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) noexcept {
  ++relievo::allocations;
  return __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  if (!std::has_single_bit(alignment)) {
    errno = EINVAL;
    return nullptr;
  }
  return memalign(alignment, bytes);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) noexcept {
  if (alignment % sizeof(void*) != 0 || !std::has_single_bit(alignment)) return EINVAL;
  void* const made = memalign(alignment, bytes);
  if (made == nullptr) return ENOMEM;
  *block = made;
  return 0;
}

void* valloc(std::size_t bytes) noexcept {
  ++relievo::allocations;
  return __libc_valloc(bytes);
}

void* pvalloc(std::size_t bytes) noexcept {
  ++relievo::allocations;
  return __libc_pvalloc(bytes);
}

}  // extern "C"

#endif
