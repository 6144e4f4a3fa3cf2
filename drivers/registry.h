// SPDX-License-Identifier: Apache-2.0
// The explicit list of back ends, by the names of the command line: real ones first, mock last. For the mains only.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hal/display.h"
#include "hal/haptic_device.h"
#include "hal/media_source.h"
#include "hal/remote_input.h"
#include "hal/video_decoder.h"
#include "platform/clock.h"
#include "platform/failure.h"

namespace relievo::drivers {

// The names that each option takes, for --help and for the message of a wrong one: "offscreen[:FILE.y4m] mock".
extern const char* const kDisplayNames;
extern const char* const kHapticNames;
extern const char* const kRemoteNames;

// A null pointer means "none". The failure names the option when its word is not known (InvalidArgument), the script
// when that is not there (NotFound), or its line when that is wrong (InvalidArgument).
// `clock` must outlive what is made.
[[nodiscard]] Outcome<std::unique_ptr<Display>> makeDisplay(std::string_view spec);
[[nodiscard]] Outcome<std::unique_ptr<HapticDevice>> makeHapticDevice(std::string_view spec, Clock& clock);
[[nodiscard]] Outcome<std::unique_ptr<RemoteInput>> makeRemoteInput(std::string_view spec, Clock& clock);
[[nodiscard]] std::unique_ptr<MediaSource> makeMediaSource(std::string_view url);
[[nodiscard]] std::unique_ptr<VideoDecoder> makeVideoDecoder();

}  // namespace relievo::drivers
