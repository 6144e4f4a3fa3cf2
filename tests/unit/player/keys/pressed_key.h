// SPDX-License-Identifier: Apache-2.0
// What a key of a table means.
#pragma once

#include <cstdint>
#include <optional>

#include "app/player/control/key_table.h"

namespace relievo::test {

inline std::optional<PlayerCommand> pressed(const KeyTable& table, PlayerState state, int code) {
  const KeyTable::Binding* binding = table.find(state, static_cast<std::uint16_t>(code));
  return binding == nullptr ? std::nullopt : binding->press;
}

}  // namespace relievo::test
