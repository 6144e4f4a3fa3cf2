// SPDX-License-Identifier: Apache-2.0
// Sound output by ALSA, to a card or a sound server.
#pragma once

#include <memory>
#include <string>

#include "hal/audio_output.h"
#include "platform/clock.h"

namespace relievo {

// `device`: a name of `aplay -L`, such as "default", "hdmi:CARD=vc4hdmi0", "plughw:1". Samples are sent as float, or as
// 16 bits if the device does not take float. The buffer is half a second if the device allows it, longer than any
// picture takes to draw. Playback continues after a suspend. A sound server that does not answer costs a call 3 s:
// Timeout of `open`, Lost of the others. `clock`: the system's, except in tests.
[[nodiscard]] std::unique_ptr<AudioOutput> makeAlsaOutput(std::string device, const Clock& clock);

}  // namespace relievo
