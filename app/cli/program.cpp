// SPDX-License-Identifier: Apache-2.0
// The failure's line goes the way of every other line: whole, in one piece, without control characters.
#include "app/cli/program.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "platform/log.h"

namespace relievo {
namespace {

std::atomic<bool> stop_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

std::atomic<void (*)() noexcept> last_act{nullptr};

void endNow(int number) {
  if (auto* const act = last_act.load()) act();
  std::signal(number, SIG_DFL);
  std::raise(number);  // it comes when this returns
}

void onSignal(int number) {
  if (stop_wanted.exchange(true, std::memory_order_relaxed)) endNow(number);
}

// What was printed may still lie in the buffer.
int afterOutput(int exit_code) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || exit_code != kExitDone) return exit_code;
  return tell({"standard output", {ErrorCode::Io, 0, "it cannot be written; is the disk full, or the reader gone?"}});
}

}  // namespace

const std::atomic<bool>& stopOnSignals(void (*last)() noexcept) noexcept {
  last_act = last;
  struct sigaction action{};
  action.sa_handler = onSignal;
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) ::sigaction(number, &action, nullptr);
  if (last == nullptr) return stop_wanted;
  std::atexit([] { last_act.load()(); });
  action.sa_handler = endNow;
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP, SIGXCPU, SIGALRM, SIGVTALRM,
                           SIGPROF, SIGUSR1, SIGUSR2}) {
    struct sigaction old{};
    ::sigaction(number, nullptr, &old);
    if (old.sa_handler == SIG_DFL) ::sigaction(number, &action, nullptr);  // a sanitizer has its own
  }
  return stop_wanted;
}

int tell(const Failure& failure, int exit_code) {
  const auto& [thing, error] = failure;
  if (error.os_error != 0) {
    log(LogLevel::Error, thing.c_str(), "%s (%s)", error.message, std::strerror(error.os_error));
  } else {
    log(LogLevel::Error, thing.c_str(), "%s", error.message);
  }
  return exit_code;
}

int runProgram(const char* name, const std::function<int()>& body) noexcept {
  setLogProgram(name);
  std::signal(SIGPIPE, SIG_IGN);  // who no longer listens ends nothing
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of the write, told like any other
  try {
    return afterOutput(body());
  } catch (const std::exception& error) {
    log(LogLevel::Error, error.what(), "the system gives no more; close other programs and try again");
    return kExitFailed;
  }
}

}  // namespace relievo
