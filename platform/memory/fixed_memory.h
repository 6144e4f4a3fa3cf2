// SPDX-License-Identifier: Apache-2.0
// Memory that a real-time thread can rely on: mapped, touched and locked before the thread starts.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "platform/error.h"

namespace relievo {

// Locks the pages of [address, address + bytes), which must be writable, and touches each of them. mlockall is not
// used, since it would pin a GL driver's hundreds of megabytes. PermissionDenied if RLIMIT_MEMLOCK is too low and
// CAP_IPC_LOCK is missing; the range is touched nevertheless.
[[nodiscard]] Result<void> lockAndTouch(void* address, std::size_t bytes) noexcept;

// Does the same for the code and read-only data of this program, the C, C++ and maths libraries and the loader.
[[nodiscard]] Result<void> lockAndTouchCode() noexcept;

// A block of fixed size in which objects are made before a real-time thread starts. The arena's destructor destroys
// them in reverse order. For set-up only: not thread-safe, not real-time safe.
class FixedArena {
 public:
  // Maps and touches `bytes`. `locked()` says whether they could be locked as well.
  [[nodiscard]] static Result<FixedArena> create(std::size_t bytes) noexcept;
  FixedArena(FixedArena&& other) noexcept;
  FixedArena& operator=(FixedArena&&) = delete;
  ~FixedArena();

  // Null when the arena is full.
  template <class T, class... Args>
  [[nodiscard]] T* make(Args&&... args) {
    void* place = allocate(sizeof(T), alignof(T));
    if (place == nullptr) return nullptr;
    Cleanup* cleanup = nullptr;
    if constexpr (!std::is_trivially_destructible_v<T>) {
      cleanup = static_cast<Cleanup*>(allocate(sizeof(Cleanup), alignof(Cleanup)));
      if (cleanup == nullptr) return nullptr;
    }
    T* object = ::new (place) T(std::forward<Args>(args)...);
    if (cleanup != nullptr) {
      last_ = ::new (cleanup) Cleanup{object, [](void* o) noexcept { static_cast<T*>(o)->~T(); }, last_};
    }
    return object;
  }

  [[nodiscard]] std::size_t used() const noexcept { return used_; }
  [[nodiscard]] std::size_t capacity() const noexcept { return bytes_; }
  [[nodiscard]] bool locked() const noexcept { return locked_; }

 private:
  struct Cleanup {
    void* object;
    void (*destroy)(void*) noexcept;
    Cleanup* next;
  };
  FixedArena(std::byte* base, std::size_t bytes, bool locked) noexcept : base_(base), bytes_(bytes), locked_(locked) {}
  [[nodiscard]] void* allocate(std::size_t bytes, std::size_t alignment) noexcept;

  std::byte* base_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t used_ = 0;
  bool locked_ = false;
  Cleanup* last_ = nullptr;
};

}  // namespace relievo
