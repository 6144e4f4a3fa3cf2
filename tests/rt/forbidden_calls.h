// SPDX-License-Identifier: Apache-2.0
// Detects what a real-time tick must not do and what would go unnoticed: taking an uncontended lock, and system calls.
#pragma once

#include <cstdint>

namespace relievo::test {

// The number of locks that the calling thread has taken: POSIX mutexes and read-write locks, on which those of the C++
// library are built. Overrides the C library's functions in a program that links this. 0 under the thread and real-time
// sanitizers, which need these functions themselves.
[[nodiscard]] std::uint64_t threadLocks() noexcept;

// From here on every system call except process exit kills the process with SIGSYS: use it in a child process. False if
// the kernel does not support it.
[[nodiscard]] bool forbidSystemCalls() noexcept;

}  // namespace relievo::test
