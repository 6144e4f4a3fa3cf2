// SPDX-License-Identifier: Apache-2.0
// The on-screen display as a script for libass. Pure.
#pragma once

#include <string>
#include <vector>

#include "app/player/screen/screen_text.h"

namespace relievo {

// The script's units: the view is 720 of them high, whatever its pixels, and as wide as the viewer sees it. Over a film
// in a portrait view they are smaller: 720 are its width.
constexpr double kScreenRows = 720;

// For a view that is `aspect` times as wide as it is high.
[[nodiscard]] std::string screenHead(double aspect);
// Lines for AssText. For the list of films: what lies under its posters.
[[nodiscard]] std::vector<std::string> screenLines(const ScreenContent& content, double aspect, int view_height = 720);
// What lies over the posters of the list of films; empty without a list.
[[nodiscard]] std::vector<std::string> linesOverPosters(const ScreenContent& content, double aspect);

}  // namespace relievo
