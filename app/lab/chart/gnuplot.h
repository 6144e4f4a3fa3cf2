// SPDX-License-Identifier: Apache-2.0
// gnuplot as a child process.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/failure.h"

namespace relievo {

// Runs a script, which sees `arguments` as ARG1, ARG2, .., and returns its output. NotFound if gnuplot is not on the
// PATH; other failures quote gnuplot's last line.
[[nodiscard]] Outcome<std::string> runGnuplot(std::string_view script, const std::vector<std::string>& arguments);

}  // namespace relievo
