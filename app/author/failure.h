// SPDX-License-Identifier: Apache-2.0
// A failure of the author's program, with the thing that it is about: a source, a file, an option.
#pragma once

#include <expected>
#include <string>
#include <utility>

#include "platform/error.h"

namespace relievo {

struct AuthorFailure {
  std::string thing;
  Error error;
};

template <class T>
using AuthorResult = std::expected<T, AuthorFailure>;

[[nodiscard]] inline std::unexpected<AuthorFailure> authorFail(std::string thing, const Error& error) {
  return std::unexpected(AuthorFailure{std::move(thing), error});
}

}  // namespace relievo
