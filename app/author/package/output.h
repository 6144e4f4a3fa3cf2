// SPDX-License-Identifier: Apache-2.0
// Checks the output before work begins, and formats progress and summary.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/author/author.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// InvalidArgument for an unknown extension, Io if something is in the way; checked before any work is done.
[[nodiscard]] Result<void> checkOutput(const OutputOptions& output);
// The same for the preview, if one is wanted.
[[nodiscard]] Result<void> checkPreview(const OutputOptions& output);
// All files that will be created or replaced, older segments of a playlist included.
[[nodiscard]] std::vector<std::string> filesWrittenBy(const OutputOptions& output);

// "  123/360 frames, 41.5 frames/s, 0:06 left"; unknown parts are left out.
[[nodiscard]] std::string progressText(std::uint64_t done, std::optional<std::uint64_t> total, Duration elapsed);

// A short table: tracks, sizes, bit rates, depth codes and what was done to them. The touch error is the enhancement's
// estimate (see enhancer.h), as heights in a film 40 mm deep and as the force of a finger that presses with 0.5 N/mm on
// single samples. Coding errors are not included.
[[nodiscard]] std::string toText(const std::string& path, const AuthorSummary& summary);

}  // namespace relievo
