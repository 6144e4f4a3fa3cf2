// SPDX-License-Identifier: Apache-2.0
// A failure of the laboratory, with the thing that it is about: a file, a line of a file.
#pragma once

#include <expected>
#include <string>

#include "platform/error.h"

namespace relievo {

struct LabFailure {
  std::string thing;
  Error error;
};

template <class T>
using LabResult = std::expected<T, LabFailure>;

[[nodiscard]] inline std::unexpected<LabFailure> labFail(std::string thing, const Error& error) {
  return std::unexpected(LabFailure{std::move(thing), error});
}
[[nodiscard]] inline std::unexpected<LabFailure> labFail(std::string thing, const char* message) {
  return std::unexpected(LabFailure{std::move(thing), Error{ErrorCode::InvalidArgument, 0, message}});
}

}  // namespace relievo
