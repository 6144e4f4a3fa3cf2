// SPDX-License-Identifier: Apache-2.0
// What is shown after a key that changes a value.
#pragma once

#include <optional>

#include "app/player/control/command.h"
#include "app/player/screen/screen_text.h"

namespace relievo {

// `facts`: as they are after the command. Nothing for commands that show in other ways: on the bar, in the picture.
[[nodiscard]] std::optional<ScreenNotice> noticeOf(const PlayerCommand& command, const ScreenFacts& facts);

}  // namespace relievo
