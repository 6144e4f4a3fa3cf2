// SPDX-License-Identifier: Apache-2.0
// How every program ends: exit codes, and the one line on stderr that says what went wrong.
#pragma once

#include <atomic>
#include <functional>

#include "platform/failure.h"

namespace relievo {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;    // at run time
inline constexpr int kExitWrongUse = 2;  // usage error

[[nodiscard]] constexpr int exitCodeOf(const Error& error) noexcept {
  return error.code == ErrorCode::InvalidArgument ? kExitWrongUse : kExitFailed;
}

// Prints "PROGRAM: THING: what was wrong; what to do (the system's error)" and returns the exit code.
int tell(const Failure& failure, int exit_code);
inline int tell(const Failure& failure) {
  return tell(failure, exitCodeOf(failure.error));
}

// From now on SIGINT, SIGTERM, SIGHUP, and others that would end the program without being a crash, such as SIGUSR1 or
// SIGXCPU, set the returned flag, asking for a clean exit; a line says so if that takes long. A second one ends
// the program at once, as does a crash (SIGSEGV, SIGABRT and the like). `last`, if given, is called just before such an
// end, and also if a driver calls `exit` or `quick_exit`, as that of the window does when it loses its X server; it
// must be async-signal-safe. SIGTSTP (Ctrl-Z) is then ignored, because it would stop all threads without that call.
// SIGHUP that is ignored, as nohup(1) does, stays so. Call once.
[[nodiscard]] const std::atomic<bool>& stopOnSignals(void (*last)() noexcept = nullptr) noexcept;

// After `stopOnSignals`: SIGINT, SIGTERM and SIGHUP end the program at once again, without `last`. SIGHUP that is
// ignored stays so.
void endOnSignals() noexcept;

// Runs the body of a main, which returns the exit code. `name` (a literal) starts each line on stderr. Exceptions (out
// of memory, out of threads), on other threads too, and a failed write to standard output become ordinary failures; it
// is no failure that the reader of a pipe leaves early, as `head` does. Writes to closed pipes or beyond the file size
// limit fail instead of ending the program. Streams that are closed stay so for everybody: no file that is opened later
// takes their place. At most 1024 files are open at once.
[[nodiscard]] int runProgram(const char* name, const std::function<int()>& body) noexcept;

}  // namespace relievo
