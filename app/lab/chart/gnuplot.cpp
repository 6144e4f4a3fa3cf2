// SPDX-License-Identifier: Apache-2.0
// The script goes in through a file without a name, the drawing comes out through another: no pipe can fill up.
#include "app/lab/chart/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "platform/unique_fd.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace relievo {
namespace {

std::string readAll(const UniqueFd& file) {
  std::string text;
  char block[65536];
  off_t at = 0;
  for (ssize_t n = 0; (n = ::pread(file.get(), block, sizeof block, at)) > 0; at += n) {
    text.append(block, static_cast<std::size_t>(n));
  }
  return text;
}

bool writeAll(const UniqueFd& file, std::string_view text) {
  off_t at = 0;
  while (!text.empty()) {
    const ssize_t n = ::pwrite(file.get(), text.data(), text.size(), at);
    if (n <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(n));
    at += n;
  }
  return true;
}

std::string lastLine(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

Outcome<std::string> runGnuplot(std::string_view script, const std::vector<std::string>& arguments) {
  const UniqueFd in(::memfd_create("script", MFD_CLOEXEC)), out(::memfd_create("drawing", MFD_CLOEXEC)),
      said(::memfd_create("messages", MFD_CLOEXEC));
  if (!in.valid() || !out.valid() || !said.valid() || !writeAll(in, script)) {
    return failOn("gnuplot", {ErrorCode::Exhausted, errno, "cannot be given its script"});
  }
  std::vector<std::string> words{"gnuplot", "-c", "/dev/stdin"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in.get(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out.get(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, said.get(), STDERR_FILENO);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, "gnuplot", &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT) {
    return failOn("gnuplot", {ErrorCode::NotFound, 0, "not on the PATH; install the package gnuplot-nox"});
  }
  if (error != 0) return failOn("gnuplot", {ErrorCode::Io, error, "cannot be started"});
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  std::string drawing = readAll(out);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || drawing.empty()) {
    return failOn("gnuplot: " + lastLine(readAll(said)), {ErrorCode::Io, 0, "the chart could not be drawn"});
  }
  return drawing;
}

}  // namespace relievo
