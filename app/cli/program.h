// SPDX-License-Identifier: Apache-2.0
// How every program of the project ends: its exit codes, and the one line on stderr that says what went wrong.
#pragma once

#include <atomic>
#include <functional>

#include "platform/failure.h"

namespace relievo {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;    // at run time
inline constexpr int kExitWrongUse = 2;  // by its words alone

[[nodiscard]] constexpr int exitCodeOf(const Error& error) noexcept {
  return error.code == ErrorCode::InvalidArgument ? kExitWrongUse : kExitFailed;
}

// Prints "PROGRAM: THING: what was wrong; what to do (the system's word for it)" and answers the exit code.
int tell(const Failure& failure, int exit_code);
inline int tell(const Failure& failure) {
  return tell(failure, exitCodeOf(failure.error));
}

// From now on SIGINT, SIGTERM and SIGHUP set what is returned: the work is to end in good order. A second signal, of
// either kind, ends the program at once, as a fault of the program does (SIGSEGV, SIGABRT and their like); `last`, if
// given, is called first, and also when a library ends the program by `exit`, as Xlib does without its server:
// async-signal-safe. Once.
[[nodiscard]] const std::atomic<bool>& stopOnSignals(void (*last)() noexcept = nullptr) noexcept;

// The body of a main, which answers its exit code. `name` (a literal) goes before each line on stderr. What is thrown
// (out of memory, out of threads) becomes a failure like any other, and so
// does standard output that could not be written. Writes to closed pipes and beyond the file size limit fail instead of
// ending the program.
[[nodiscard]] int runProgram(const char* name, const std::function<int()>& body) noexcept;

}  // namespace relievo
