// SPDX-License-Identifier: Apache-2.0
// An error together with the name of what it is about: a source, a file, a line of a file, an option.
#pragma once

#include <expected>
#include <string>
#include <utility>

#include "platform/error.h"

namespace relievo {

// For programs and code that works on files. Not for real-time code, since the name allocates.
struct Failure {
  std::string thing;
  Error error;
};

template <class T>
using Outcome = std::expected<T, Failure>;

[[nodiscard]] inline std::unexpected<Failure> failOn(std::string thing, const Error& error) {
  return std::unexpected(Failure{std::move(thing), error});
}

}  // namespace relievo
