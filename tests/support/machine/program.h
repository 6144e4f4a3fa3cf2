// SPDX-License-Identifier: Apache-2.0
// Runs one of the built programs as a user would, and keeps its output.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace relievo::test {

struct ProgramResult {
  int exit_code = -1;  // -1: ended by a signal
  std::string out, err;
};

// `command_line`: as in a shell, such as "relievo-lab trace ..". `folder`: for the two output files.
inline ProgramResult runProgram(const std::string& command_line, const std::string& folder) {
  const std::string out = folder + "/stdout.txt", err = folder + "/stderr.txt";
  const std::string command =
      std::string(RELIEVO_BIN_DIR) + "/" + command_line + " >" + out + " 2>" + err + " </dev/null";
  const int status = std::system(command.c_str());  // NOLINT(bugprone-command-processor): the test's command
  const auto text = [](const std::string& path) {
    std::ifstream file(path);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(out), text(err)};
}

}  // namespace relievo::test
