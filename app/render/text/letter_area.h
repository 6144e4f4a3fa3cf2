// SPDX-License-Identifier: Apache-2.0
// Estimates how large the letters of a subtitle line are, before libass draws them: it does so in full, wherever they
// are.
#pragma once

#include <ass/ass.h>

namespace relievo {

// What the letters, drawings and clips of a line cover with their outlines, beside one another, in squares as high as
// the screen. Transforms count with their end; the perspective of \frx and \fry does not count.
[[nodiscard]] double letterArea(const ASS_Event& line, const ASS_Track& script);

}  // namespace relievo
