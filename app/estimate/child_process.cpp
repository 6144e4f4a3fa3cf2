// SPDX-License-Identifier: Apache-2.0
// The shell is reaped last, since until then its process number cannot be given to another group. A second shell in the
// group waits at a pipe that tells it when this program has ended, for whatever reason.
#include "app/estimate/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <string_view>
#include <utility>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace relievo {
namespace {

constexpr int kTidyUpMs = 1000;
constexpr int kGuardsFile = 3;  // its end of the pipe
// Orphaned, so that no program of the command waits for it; `kill 0` is for the group.
constexpr const char* kGuardAndCommand =
    "({ trap '' HUP INT TERM; read -r end; kill -KILL 0; } <&3 3<&- >/dev/null 2>&1 &); exec 3<&-; exec /bin/sh -c "
    "\"$1\"";
constexpr int kPipeBytes = 1 << 20;  // if the system grants it

struct Pipe {
  UniqueFd from, to;
};
std::optional<Pipe> makePipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  return Pipe{UniqueFd(ends[0]), UniqueFd(ends[1])};
}

UniqueFd ours(UniqueFd fd) {
  ::fcntl(fd.get(), F_SETFL, O_NONBLOCK);
  ::fcntl(fd.get(), F_SETPIPE_SZ, kPipeBytes);
  return fd;
}

// This program's variables, except those that are replaced.
std::vector<std::string> environmentWith(const std::vector<std::string>& variables) {
  std::vector<std::string> all = variables;
  for (char** at = environ; *at != nullptr; ++at) {
    const std::string_view own = *at;
    const bool replaced = std::ranges::any_of(
        variables, [&](const std::string& v) { return own.starts_with(v.substr(0, v.find('=') + 1)); });
    if (!replaced) all.emplace_back(own);
  }
  return all;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

// `files`: 0, 1, 2 and the guard's.
int spawnShell(const std::string& command, const std::vector<std::string>& variables, const std::array<int, 4>& files,
               pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int i = 0; i <= kGuardsFile; ++i)
    posix_spawn_file_actions_adddup2(&actions, files[static_cast<std::size_t>(i)], i);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, usual;
  sigemptyset(&none);
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> words{"/bin/sh", "-c", kGuardAndCommand, "/bin/sh", command},
      environment = environmentWith(variables);
  const int error =
      ::posix_spawn(&pid, "/bin/sh", &actions, &attributes, pointersTo(words).data(), pointersTo(environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const std::string& command, const std::vector<std::string>& variables) {
  auto in = makePipe(), out = makePipe(), said = makePipe(), life = makePipe();
  if (!in || !out || !said || !life)
    return fail(ErrorCode::Exhausted, "no pipes can be made for the command; close other programs", errno);
  ChildProcess child;
  const int error =
      spawnShell(command, variables, {in->from.get(), out->to.get(), said->to.get(), life->from.get()}, child.pid_);
  if (error != 0) {
    child.pid_ = -1;
    return fail(ErrorCode::Io, "the command cannot be started", error);
  }
  child.input = ours(std::move(in->to));
  child.output = ours(std::move(out->from));
  child.messages = ours(std::move(said->from));
  child.life_ = std::move(life->to);
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : input(std::move(other.input)),
      output(std::move(other.output)),
      messages(std::move(other.messages)),
      life_(std::move(other.life_)),
      pid_(std::exchange(other.pid_, -1)) {}

ChildProcess::~ChildProcess() {
  if (pid_ < 0) return;
  input.reset();
  if (!end()) {
    ::kill(-pid_, SIGTERM);
    constexpr timespec kStep{0, 10'000'000};
    for (int waited_ms = 0; waited_ms < kTidyUpMs && !end(); waited_ms += 10) ::nanosleep(&kStep, nullptr);
  }
  ::kill(-pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::optional<ChildProcess::End> ChildProcess::end() const noexcept {
  siginfo_t info{};
  if (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0) return End{};
  if (info.si_pid == 0) return std::nullopt;
  return End{info.si_code != CLD_EXITED, info.si_status};
}

}  // namespace relievo
