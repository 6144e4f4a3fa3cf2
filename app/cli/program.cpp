// SPDX-License-Identifier: Apache-2.0
// Error messages are printed through the log: as one write, without control characters.
#include "app/cli/program.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "platform/log.h"

namespace relievo {
namespace {

std::atomic<bool> stop_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

std::atomic<void (*)() noexcept> last_act{nullptr};

void endNow(int number) {
  if (auto* const act = last_act.load()) act();
  std::signal(number, SIG_DFL);
  std::raise(number);  // delivered when this handler returns
}

constexpr unsigned kEndsSoonS = 3;
std::array<char, 128> still_ending{};

// A display or a device that does not answer can hold up the end: then SIGALRM brings a word.
void onSignal(int number) {
  if (!stop_wanted.exchange(true, std::memory_order_relaxed)) {
    ::alarm(kEndsSoonS);
    return;
  }
  if (number != SIGALRM) return endNow(number);
  const int interrupted = errno;
  static_cast<void>(::write(STDERR_FILENO, still_ending.data(), std::strlen(still_ending.data())));
  errno = interrupted;
}

bool isIgnored(int number) noexcept {
  struct sigaction now{};
  return ::sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

int tellExhausted(const std::exception& error) {
  log(LogLevel::Error, error.what(), "the system is out of resources; close other programs and try again");
  return kExitFailed;
}

// What a thread other than the first has not caught. All but a lack of memory or threads is a fault of the program.
[[noreturn]] void onUncaught() noexcept {
  std::set_terminate(std::abort);
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc& error) {
    if (auto* const act = last_act.load()) act();
    std::_Exit(tellExhausted(error));
  } catch (const std::system_error& error) {
    const bool no_room =
        error.code() == std::errc::resource_unavailable_try_again || error.code() == std::errc::not_enough_memory;
    if (!no_room) std::abort();
    if (auto* const act = last_act.load()) act();
    std::_Exit(tellExhausted(error));
  } catch (...) {
    std::abort();
  }
  std::abort();
}

// Otherwise a file that is opened later would get the number of a closed stream, and its messages.
void fillClosedStreams() noexcept {
  for (int fd = 0; fd <= 2; ++fd) {
    if (::fcntl(fd, F_GETFD) >= 0) continue;
    static_cast<void>(::open("/dev/null", fd == 2 ? O_WRONLY : O_RDONLY));  // the lowest number; output still fails
  }
}

// Within FFmpeg a list that names itself is opened again until no descriptor is left. The usual limit bounds the memory
// for that: containers set a thousand times as many.
void boundDescriptors() noexcept {
  constexpr rlim_t kMost = 1024;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur <= kMost) return;
  limit.rlim_cur = kMost;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

// A pipe or socket whose other end is closed: `relievo --help | head` has read enough.
bool isReaderGone() noexcept {
  pollfd out{.fd = STDOUT_FILENO, .events = 0, .revents = 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & (POLLERR | POLLHUP)) != 0;
}

// Output may still be buffered, so flush it and check for errors.
int afterOutput(int exit_code) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || exit_code != kExitDone || isReaderGone()) return exit_code;
  return tell({"standard output", {ErrorCode::Io, 0, "it cannot be written; is the disk full?"}});
}

}  // namespace

const std::atomic<bool>& stopOnSignals(void (*last)() noexcept) noexcept {
  last_act = last;
  struct sigaction action{};
  action.sa_handler = onSignal;
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU, SIGIO, SIGPWR}) {
    if (number == SIGHUP && isIgnored(SIGHUP)) continue;  // by nohup(1): it outlives its terminal
    action.sa_flags = number == SIGALRM ? SA_RESTART : 0;
    ::sigaction(number, &action, nullptr);
  }
  action.sa_flags = 0;
  if (last == nullptr) return stop_wanted;
  std::atexit([] { last_act.load()(); });
  std::at_quick_exit([] { last_act.load()(); });
  std::signal(SIGTSTP, SIG_IGN);  // it would stop the watchdogs as well, and the last force would stand
  action.sa_handler = endNow;
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP, SIGVTALRM, SIGPROF}) {
    struct sigaction old{};
    ::sigaction(number, nullptr, &old);
    if (old.sa_handler == SIG_DFL) ::sigaction(number, &action, nullptr);  // a sanitizer installs its own handlers
  }
  return stop_wanted;
}

void endOnSignals() noexcept {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    if (number != SIGHUP || !isIgnored(SIGHUP)) std::signal(number, SIG_DFL);
  }
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
  fillClosedStreams();
  boundDescriptors();
  setLogProgram(name);
  std::snprintf(still_ending.data(), still_ending.size(), "%s: is still ending; a second signal ends it at once\n",
                name);
  std::set_terminate(onUncaught);
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is a write error, not the end of the program
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit is a write error too
  try {
    return afterOutput(body());
  } catch (const std::exception& error) {
    return tellExhausted(error);
  }
}

}  // namespace relievo
