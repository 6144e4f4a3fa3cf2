// SPDX-License-Identifier: Apache-2.0
// Runs one of the built programs as a process, as a shell would, so that a test can send it signals.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace relievo::test {

class Process {
 public:
  // Both output streams go to the file `said`.
  Process(const std::vector<std::string>& arguments, const std::string& said) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int fd = ::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(fd, STDERR_FILENO);
    ::dup2(fd, STDOUT_FILENO);
    ::signal(SIGHUP, SIG_DFL);  // also where nohup(1) runs the test
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~Process() {
    if (isRunning()) send(SIGKILL);
    (void)wait();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int number) const { ::kill(pid_, number); }
  // True if it has installed a handler for the signal.
  [[nodiscard]] bool catches(int number) const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (!line.starts_with("SigCgt:")) continue;
      return (std::stoull(line.substr(7), nullptr, 16) >> (number - 1) & 1) != 0;
    }
    return false;
  }
  // True while it has that file open.
  [[nodiscard]] bool holds(const std::string& path) const {
    std::error_code failed;
    for (const auto& fd : std::filesystem::directory_iterator("/proc/" + std::to_string(pid_) + "/fd", failed)) {
      if (std::filesystem::read_symlink(fd.path(), failed) == path) return true;
    }
    return false;
  }
  // Sends two signals while the process is stopped, so that it gets both at once.
  void sendBoth(int first, int second) const {
    send(SIGSTOP);
    int status = 0;
    ::waitpid(pid_, &status, WUNTRACED);
    for (const int number : {first, second, SIGCONT}) send(number);
  }
  [[nodiscard]] bool isRunning() {
    if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
    return !ended_;
  }
  // Its exit code, or minus the number of the signal that ended it.
  int wait() {
    if (!ended_) ::waitpid(pid_, &status_, 0);
    ended_ = true;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  }

 private:
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace relievo::test
