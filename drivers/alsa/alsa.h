// SPDX-License-Identifier: Apache-2.0
// Sound output by ALSA, to a card or a sound server.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "hal/audio_output.h"
#include "platform/clock.h"

namespace relievo {

// How long a call of the output waits for ALSA, which goes on without it.
struct AlsaPatience {
  Duration open = std::chrono::milliseconds(500);  // the first one
  Duration call = std::chrono::milliseconds(20);   // any other
};

// `device`: a name of `aplay -L`, such as "default", "hdmi:CARD=vc4hdmi0", "plughw:1". Samples are sent as float, or as
// 16 bits if the device does not take float. The buffer is half a second if the device allows it, longer than any
// picture takes to draw. Playback continues after a suspend. A sound server that does not answer costs no call more
// than the patience: `open` fails with Timeout, and with what was opened meanwhile if it is called again; the others
// take nothing, and are Lost after 3 s. `clock`: the system's, except in tests.
[[nodiscard]] std::unique_ptr<AudioOutput> makeAlsaOutput(std::string device, const Clock& clock,
                                                          AlsaPatience patience = {});

}  // namespace relievo
