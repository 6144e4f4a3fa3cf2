// SPDX-License-Identifier: Apache-2.0
// Sound output on ALSA: a card, or what a sound server has put in its place.
#pragma once

#include <memory>
#include <string>

#include "hal/audio_output.h"
#include "platform/clock.h"

namespace relievo {

// `device` is a name of `aplay -L`: "default", "hdmi:CARD=vc4hdmi0", "plughw:1". Samples go as float, or as 16 bits
// where the device takes no other. It keeps half a second, where the device has room for that: longer than any picture
// takes to draw. After a suspend it goes on by itself. `clock` is the system's, but in tests.
[[nodiscard]] std::unique_ptr<AudioOutput> makeAlsaOutput(std::string device, const Clock& clock);

}  // namespace relievo
