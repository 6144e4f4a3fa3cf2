// SPDX-License-Identifier: Apache-2.0
// The project's only error type: a code, errno, and one line that says what was wrong and what to do.
#pragma once

#include <cstdint>
#include <expected>

namespace relievo {

enum class ErrorCode : std::uint8_t {
  InvalidArgument,   // the caller's arguments are wrong
  InvalidState,      // the call is not allowed in the object's current state
  NotFound,          // no such file, track, device, key
  Unsupported,       // this back end cannot do it
  PermissionDenied,  // the permission is missing
  Io,                // reading or writing failed
  Corrupt,           // the data is not what it says it is
  Timeout,           // no answer in time
  Lost,              // the device or the stream has gone away
  Exhausted,         // out of memory, buffers or space
  Cancelled,         // interrupted on request
};

// Trivially copyable, so that it can pass between threads and through rings. `message` is a string literal: it says
// what was wrong and what to do. The code that prints the line adds the name of the thing (a path, a device).
struct Error {
  ErrorCode code = ErrorCode::Io;
  int os_error = 0;  // errno at the failure, or 0
  const char* message = "";
};

template <class T>
using Result = std::expected<T, Error>;

[[nodiscard]] inline std::unexpected<Error> fail(ErrorCode code, const char* message, int os_error = 0) noexcept {
  return std::unexpected(Error{code, os_error, message});
}

}  // namespace relievo
