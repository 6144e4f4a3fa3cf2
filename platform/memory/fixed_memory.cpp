// SPDX-License-Identifier: Apache-2.0
// Locks and touches ranges of memory, including code; and the arena that holds real-time objects.
#include "platform/memory/fixed_memory.h"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <string_view>

namespace relievo {
namespace {

// To touch a page, any of its bytes may be read, even one that a sanitizer would report.
#define RELIEVO_TOUCHES_ANY_BYTE __attribute__((no_sanitize("address", "thread")))

std::uintptr_t pageSize() noexcept {
  static const auto size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  return size;
}

// The whole pages that cover a range.
struct Pages {
  std::uintptr_t begin;
  std::uintptr_t end;
};

Pages pagesOf(std::uintptr_t address, std::size_t bytes) noexcept {
  const std::uintptr_t mask = pageSize() - 1;
  return {address & ~mask, (address + bytes + mask) & ~mask};
}

Result<void> lock(Pages pages) noexcept {
  if (pages.begin == pages.end) return {};
  // mlock fails with EPERM, ENOMEM or EAGAIN depending on the limit; the remedy is the same.
  if (::mlock(reinterpret_cast<void*>(pages.begin), pages.end - pages.begin) == 0) return {};
  return fail(ErrorCode::PermissionDenied,
              "memory cannot be locked: raise LimitMEMLOCK (ulimit -l) or grant CAP_IPC_LOCK", errno);
}

RELIEVO_TOUCHES_ANY_BYTE void touchByReading(Pages pages) noexcept {
  for (std::uintptr_t page = pages.begin; page < pages.end; page += pageSize()) {
    static_cast<void>(*reinterpret_cast<const volatile unsigned char*>(page));
  }
}

// Reading would map the shared zero page, and the first write would still fault. One byte per page is written with
// its own value, by an atomic exchange, so that memory in use can be touched too. Bytes of the pages outside of the
// range are not written.
void touchByWriting(std::uintptr_t address, std::size_t bytes) noexcept {
  const std::uintptr_t end = address + bytes;
  while (address < end) {
    auto* const byte = reinterpret_cast<volatile unsigned char*>(address);
    unsigned char value = __atomic_load_n(byte, __ATOMIC_RELAXED);
    __atomic_compare_exchange_n(byte, &value, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
    address = (address & ~(pageSize() - 1)) + pageSize();
  }
}

// True for the objects whose code a real-time loop runs: the program (listed with an empty name), the libraries below
// and the loader. Locking all would be too much: a video player maps hundreds of megabytes of codecs and drivers.
bool holdsRealTimeCode(std::string_view path) noexcept {
  if (path.empty()) return true;
  constexpr std::array<std::string_view, 5> kNames = {"libc.so.", "libm.so.", "libstdc++.so.", "libgcc_s.so.", "ld-"};
  const std::string_view name = path.substr(path.rfind('/') + 1);
  for (const std::string_view wanted : kNames) {
    if (name.starts_with(wanted)) return true;
  }
  return false;
}

// Code and constants, and data that is constant once the loader has relocated it (RELRO): tables of virtual
// functions and of library calls.
bool isReadOnly(const ElfW(Phdr) & segment) noexcept {
  if (segment.p_type == PT_GNU_RELRO) return true;
  return segment.p_type == PT_LOAD && (segment.p_flags & PF_R) != 0 && (segment.p_flags & PF_W) == 0;
}

int lockAndTouchObject(dl_phdr_info* object, std::size_t, void* result) {
  if (!holdsRealTimeCode(object->dlpi_name == nullptr ? "" : object->dlpi_name)) return 0;
  auto& outcome = *static_cast<Result<void>*>(result);
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr) & segment = object->dlpi_phdr[i];
    if (!isReadOnly(segment) || segment.p_memsz == 0) continue;
    const Pages pages = pagesOf(object->dlpi_addr + segment.p_vaddr, segment.p_memsz);
    if (auto locked = lock(pages); !locked) outcome = locked;
    touchByReading(pages);
  }
  return 0;  // go on to the next object
}

}  // namespace

Result<void> lockAndTouch(void* address, std::size_t bytes) noexcept {
  if (bytes == 0) return {};
  const auto begin = reinterpret_cast<std::uintptr_t>(address);
  const Result<void> locked = lock(pagesOf(begin, bytes));
  touchByWriting(begin, bytes);
  return locked;
}

Result<void> lockAndTouchCode() noexcept {
  Result<void> outcome;
  ::dl_iterate_phdr(lockAndTouchObject, &outcome);
  return outcome;
}

Result<FixedArena> FixedArena::create(std::size_t bytes) noexcept {
  if (bytes == 0)
    return fail(ErrorCode::InvalidArgument, "the real-time arena has a size of 0; give the size that the set-up needs");
  void* const base = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (base == MAP_FAILED) {
    return fail(ErrorCode::Exhausted, "no memory for the real-time arena; free some or ask for less", errno);
  }
  const bool locked = lockAndTouch(base, bytes).has_value();
  return FixedArena(static_cast<std::byte*>(base), bytes, locked);
}

FixedArena::FixedArena(FixedArena&& other) noexcept
    : base_(std::exchange(other.base_, nullptr)),
      bytes_(std::exchange(other.bytes_, 0)),
      used_(std::exchange(other.used_, 0)),
      locked_(std::exchange(other.locked_, false)),
      last_(std::exchange(other.last_, nullptr)) {}

FixedArena::~FixedArena() {
  for (const Cleanup* cleanup = last_; cleanup != nullptr; cleanup = cleanup->next) cleanup->destroy(cleanup->object);
  if (base_ != nullptr) ::munmap(base_, bytes_);
}

void* FixedArena::allocate(std::size_t bytes, std::size_t alignment) noexcept {
  void* place = base_ + used_;
  std::size_t room = bytes_ - used_;
  if (std::align(alignment, bytes, place, room) == nullptr) return nullptr;
  used_ = bytes_ - room + bytes;
  return place;
}

}  // namespace relievo
