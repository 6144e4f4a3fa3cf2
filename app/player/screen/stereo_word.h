// SPDX-License-Identifier: Apache-2.0
// A stereo layout by its word on the command line.
#pragma once

#include <string>
#include <string_view>

#include "app/render/relief/stereo.h"

namespace relievo {

// "sbs", "tab:full", "anaglyph:gray", "quilt:5x9": sets the layout and its variant in `settings`, and nothing else.
// False, and nothing is set, for a word that is none.
[[nodiscard]] bool parseStereo(std::string_view word, StereoSettings& settings);
// The other way.
[[nodiscard]] std::string stereoWord(const StereoSettings& settings);

}  // namespace relievo
