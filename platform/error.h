// SPDX-License-Identifier: Apache-2.0
// The one error type of the project: what failed, the system's own number, and one line that helps.
#pragma once

#include <cstdint>
#include <expected>

namespace relievo {

enum class ErrorCode : std::uint8_t {
  InvalidArgument,   // the caller's words are wrong
  InvalidState,      // the verb is not allowed in the object's present state
  NotFound,          // no such file, track, device, key
  Unsupported,       // known, but not by this back end
  PermissionDenied,  // the right is missing
  Io,                // reading or writing failed
  Corrupt,           // the data is not what it says it is
  Timeout,           // nothing came in time
  Lost,              // the device or the stream has gone away
  Exhausted,         // out of memory, buffers or space
  Cancelled,         // interrupted on request
};

// Trivially copyable, so that it crosses threads and rings. `message` is a string literal: it says what was wrong and
// what to do. The thing itself (a path, a device) is named by whoever prints the line, since that one knows it.
struct Error {
  ErrorCode code = ErrorCode::Io;
  int os_error = 0;  // errno at the failure, 0 where there is none
  const char* message = "";
};

template <class T>
using Result = std::expected<T, Error>;

[[nodiscard]] inline std::unexpected<Error> fail(ErrorCode code, const char* message, int os_error = 0) noexcept {
  return std::unexpected(Error{code, os_error, message});
}

}  // namespace relievo
