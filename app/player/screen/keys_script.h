// SPDX-License-Identifier: Apache-2.0
// The page of keys as a part of the screen's script. Pure.
#pragma once

#include "app/player/screen/screen_text.h"
#include "app/player/screen/script.h"

namespace relievo {

// In the largest letters that find room for every word; the line at the top is free for a notice beside its heading.
void addKeys(Script& script, const ScreenRows& rows);

}  // namespace relievo
