// SPDX-License-Identifier: Apache-2.0
// A remote control whose keys are pressed by a script.
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

// One key a line: seconds and a key's name as in linux/input-event-codes.h, with or without KEY_, in either
// case; and, of a key that is held down, for how many seconds:
//
//   # pause the film after two seconds
//   2.0  PLAYPAUSE
//   5.0  OK  1.5
//
// What follows a '#' is ignored, and so are empty lines; times do not decrease. InvalidArgument otherwise, and
// the failure names the script's line, and of a name that is not known the nearest one.
[[nodiscard]] Outcome<std::vector<ScriptedKey>> parseKeyScript(std::string_view text, const std::string& script_name);

// NotFound when the file cannot be read.
[[nodiscard]] Outcome<std::vector<ScriptedKey>> loadKeyScript(const std::string& path);

// Yields each key's Press and its Release when their times have come. `clock` tells when `open` was and must outlive
// the remote.
[[nodiscard]] std::unique_ptr<RemoteInput> makeScriptedRemote(const std::vector<ScriptedKey>& keys, const Clock& clock);

}  // namespace relievo
