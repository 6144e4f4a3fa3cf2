// SPDX-License-Identifier: Apache-2.0
// The notice shown after a key that changes a value.
#pragma once

#include <optional>

#include "app/player/control/command.h"
#include "app/player/screen/screen_text.h"

namespace relievo {

// `facts`: as they are after the command. Nullopt for commands whose effect shows in other ways: on the bar, in the
// picture.
[[nodiscard]] std::optional<ScreenNotice> noticeOf(const PlayerCommand& command, const ScreenFacts& facts);

}  // namespace relievo
