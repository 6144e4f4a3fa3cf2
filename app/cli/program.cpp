// SPDX-License-Identifier: Apache-2.0
// The failure's line goes the way of every other line: whole, in one piece, without control characters.
#include "app/cli/program.h"

#include <cstring>
#include <exception>

#include "platform/log.h"

namespace relievo {

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
  try {
    return body();
  } catch (const std::exception& error) {
    log(LogLevel::Error, error.what(), "the system gives no more; close other programs and try again");
    return kExitFailed;
  }
}

}  // namespace relievo
