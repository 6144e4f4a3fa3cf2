// SPDX-License-Identifier: Apache-2.0
// A remote control whose keys a script presses.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/remote_input.h"
#include "platform/clock.h"
#include "platform/failure.h"

namespace relievo {

struct ScriptedKey {
  Duration at{0};  // since `open`
  std::uint16_t code = 0;
  Duration held = std::chrono::milliseconds(50);
};

// One key per line: seconds and a key's name as in linux/input-event-codes.h, with or without KEY_, in upper or lower
// case; then, optionally, for how many seconds it is held:
//
//   # pause the film after two seconds
//   2.0  PLAYPAUSE
//   5.0  OK  1.5
//
// Text after a '#' and empty lines are ignored; times must not decrease. Otherwise InvalidArgument; the failure names
// the script's line and, for an unknown key, the nearest known name.
[[nodiscard]] Outcome<std::vector<ScriptedKey>> parseKeyScript(std::string_view text, const std::string& script_name);

// NotFound if the file cannot be read.
[[nodiscard]] Outcome<std::vector<ScriptedKey>> loadKeyScript(const std::string& path);

// Yields each key's Press and Release at their times. `clock` gives the time of `open` and must outlive the
// remote.
[[nodiscard]] std::unique_ptr<RemoteInput> makeScriptedRemote(const std::vector<ScriptedKey>& keys, const Clock& clock);

}  // namespace relievo
