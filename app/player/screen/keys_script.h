// SPDX-License-Identifier: Apache-2.0
// The page of keys as a part of the screen's script. Pure.
#pragma once

#include <cstddef>
#include <string>

#include "app/player/screen/screen_text.h"
#include "app/player/screen/script.h"

namespace relievo {

// In the largest letters that find room for every word; the line at the top is free for a notice beside its heading. In
// a view of few pixels the rows are parted into pages, so that the letters stay legible.
struct KeysView {
  const ScreenRows& rows;
  std::size_t page = 0;  // from 0 on; the last one for what is beyond it
  std::string help_key;  // turns the page
  int view_height = 0;   // pixels; 0: not known
};
void addKeys(Script& script, const KeysView& view);
// How many pages they are.
[[nodiscard]] std::size_t keyPages(const ScreenRows& rows, double aspect, int view_height);

}  // namespace relievo
