// SPDX-License-Identifier: Apache-2.0
// What a real-time tick must not do and what nobody would see: take a lock that happens to be free, call the system.
#pragma once

#include <cstdint>

namespace relievo::test {

// Locks that the calling thread has taken since it began: POSIX mutexes and read-write locks, which those of the C++
// library are made of. Stands in for the C library's functions in a program that links this; the thread and the
// real-time sanitizer need these to themselves: 0 under them.
[[nodiscard]] std::uint64_t threadLocks() noexcept;

// From here on every system call but the process's end kills the process with SIGSYS: for a child process. False where
// the kernel does not do that.
[[nodiscard]] bool forbidSystemCalls() noexcept;

}  // namespace relievo::test
