// SPDX-License-Identifier: Apache-2.0
// The page of keys as part of the screen's script. Pure.
#pragma once

#include <cstddef>
#include <string>

#include "app/player/screen/screen_text.h"
#include "app/player/screen/script.h"

namespace relievo {

// Uses the largest letters in which every word fits; the line at the top is left free for a notice beside its heading.
// In a view of few pixels the rows are divided into pages, so that the letters stay legible.
struct KeysView {
  const ScreenRows& rows;
  std::size_t page = 0;  // from 0 on; if too large, the last page is shown
  std::string help_key;  // key that shows the next page
  int view_height = 0;   // pixels; 0: not known
};
void addKeys(Script& script, const KeysView& view);
// The number of pages.
[[nodiscard]] std::size_t keyPages(const ScreenRows& rows, double aspect, int view_height);

}  // namespace relievo
