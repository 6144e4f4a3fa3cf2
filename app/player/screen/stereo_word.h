// SPDX-License-Identifier: Apache-2.0
// Parses the command line's word for a stereo layout, and a picture's shape.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/render/relief/stereo.h"

namespace relievo {

// "sbs", "tab:full", "anaglyph:gray", "quilt:5x9": sets only the layout and its variant in `settings`. False, without a
// change, for an unknown word.
[[nodiscard]] bool parseStereo(std::string_view word, StereoSettings& settings);
// The inverse of parseStereo.
[[nodiscard]] std::string stereoWord(const StereoSettings& settings);
// For a viewer: "side by side", "red-cyan glasses", "off" for one picture.
[[nodiscard]] std::string stereoTitle(const StereoSettings& settings);

// "16:9", "2.35:1": the width over the height, 0.1 to 10. "film": 0, the picture's own shape. Nullopt for another word.
[[nodiscard]] std::optional<double> parseAspect(std::string_view word);

}  // namespace relievo
