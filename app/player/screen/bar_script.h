// SPDX-License-Identifier: Apache-2.0
// The bar under a film as part of the screen's script, and where it lies. Pure.
#pragma once

#include <optional>

#include "app/player/screen/script.h"

namespace relievo {

// Over a film the view's shorter side is kScreenRows long, so that a portrait view has room for a line of words. The
// bar lies in its lowest kScreenRows.
[[nodiscard]] double filmRows(double aspect) noexcept;
void addBar(Script& script, const ScreenBar& bar);

// How far down the view is free for subtitles, as a share of its height: to where the bar begins.
[[nodiscard]] double roomForWords(const ScreenContent& content, double aspect);

// The position in the bar of a point of the view, 0 to 1; nullopt beside the bar. `across` and `down` in shares of the
// view.
[[nodiscard]] std::optional<double> barShareAt(double across, double down, double aspect) noexcept;
// The button at a point of the view.
[[nodiscard]] std::optional<PlayerVerb> barButtonAt(const ScreenBar& bar, double across, double down, double aspect);
// The share at any distance above or below the bar.
[[nodiscard]] double barShareAlong(double across, double aspect) noexcept;

}  // namespace relievo
