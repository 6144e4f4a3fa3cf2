// SPDX-License-Identifier: Apache-2.0
// Advises the small pages that a block touches, so that blocks mapped side by side share the huge page between them.
#include "platform/memory/huge_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

namespace relievo {

void askForHugePages(const void* begin, std::size_t bytes) noexcept {
  if (bytes < kHugePagesFrom) return;
  const int caller_errno = errno;
  static const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = first & ~(page - 1), to = (first + bytes + page - 1) & ~(page - 1);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): a page's address
  static_cast<void>(::madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE));
  errno = caller_errno;
}

}  // namespace relievo
