// SPDX-License-Identifier: Apache-2.0
// Recognises pictures that a shell has listed as one film.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace relievo {

// The pattern ("a/frame-*.png") that names exactly these pictures, all of one folder, as a shell has expanded it.
// nullopt if they are fewer than two, or no such series.
[[nodiscard]] std::optional<std::string> seriesOf(const std::vector<std::string>& sources);

}  // namespace relievo
