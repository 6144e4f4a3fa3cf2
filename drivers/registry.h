// SPDX-License-Identifier: Apache-2.0
// The list of back ends by their names on the command line: real ones first, mock last. Only for the main programs.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/audio_output.h"
#include "hal/back_end_name.h"
#include "hal/display.h"
#include "hal/haptic_device.h"
#include "hal/media/audio_decoder.h"
#include "hal/media/media_source.h"
#include "hal/media/subtitle_decoder.h"
#include "hal/media/video_decoder.h"
#include "hal/remote_input.h"
#include "platform/clock.h"
#include "platform/failure.h"

namespace relievo::drivers {

// The names that each option takes, for --help and error messages: "kms .. mock".
extern const char* const kDisplayNames;
extern const char* const kHapticNames;
extern const char* const kRemoteNames;
extern const char* const kAudioNames;
extern const char* const kDecoderNames;  // without GStreamer in the build, its name too

extern const char* const kMockFilm;  // the URL of a built-in film of three seconds

extern const double kFalconCountsPerNm;  // the default if not configured

// Settings of the haptic back ends from the configuration.
struct HapticSettings {
  std::string falcon_firmware;  // path; empty: the device must already run its firmware
  std::optional<double> falcon_counts_per_nm;
};

// Returns a null pointer for "none". The failure names the option if the name is unknown (InvalidArgument), the script
// if it does not exist (NotFound), or the script's line if that is wrong (InvalidArgument).
// `clock` must outlive the result. Names with "window" refer to the process's single window: its display, its keys and
// its mouse.
[[nodiscard]] Outcome<std::unique_ptr<Display>> makeDisplay(const BackEndName& name);
[[nodiscard]] Outcome<std::unique_ptr<HapticDevice>> makeHapticDevice(const BackEndName& name, Clock& clock,
                                                                      const HapticSettings& settings = {});
[[nodiscard]] Outcome<std::unique_ptr<RemoteInput>> makeRemoteInput(const BackEndName& name, Clock& clock);
[[nodiscard]] Outcome<std::unique_ptr<AudioOutput>> makeAudioOutput(const BackEndName& name, const Clock& clock);
// The files that a back end's name makes it read or write; empty if none. Devices do not count as files.
struct NamedFiles {
  std::string read, written;
};
[[nodiscard]] NamedFiles filesNamedBy(const BackEndName& name);
[[nodiscard]] std::unique_ptr<MediaSource> makeMediaSource(const std::string& url);
// makeSoftwareDecoder decodes the same to the bit on every machine. makeVideoDecoder uses hardware that takes the
// stream, a stateful V4L2 device before GStreamer's elements, and falls back to software if that fails.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeSoftwareDecoder(const StreamInfo& stream);
[[nodiscard]] std::unique_ptr<VideoDecoder> makeVideoDecoder(const StreamInfo& stream);
// Makes decoders of that name ("gstreamer:ELEMENT"), with software to fall back to; makeVideoDecoder if none is named.
using DecoderMaker = std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)>;
[[nodiscard]] Outcome<DecoderMaker> decoderMaker(const BackEndName& name);
[[nodiscard]] std::unique_ptr<AudioDecoder> makeAudioDecoder();
[[nodiscard]] std::unique_ptr<SubtitleDecoder> makeSubtitleDecoder();
// Reads the text at a path or an address that makeMediaSource could open.
[[nodiscard]] Result<std::string> readText(const std::string& url, std::size_t most_bytes,
                                           const std::atomic<bool>& cancelled);

// Begins or ends a fault of a running mock of this process: "haptic" "unplug", "display" "plug". InvalidArgument, with
// a list of the faults, for an unknown one; InvalidState if the device is no mock.
[[nodiscard]] Result<void> switchFault(std::string_view device, std::string_view fault);

// What this machine offers for options that are not given; opens nothing but the connection to the desktop.
[[nodiscard]] bool desktopIsThere();
void tellOnDesktop(const std::string& message);  // waits until the viewer closes it
[[nodiscard]] bool screenIsThere();
[[nodiscard]] std::string pluggedHaptic();  // "falcon", "polhem"; empty without one
[[nodiscard]] bool terminalIsThere();       // standard input is one

// The state of every device of each kind, determined by opening it; takes seconds for a device that must start up.
struct DeviceState {
  const char* kind = "";  // display, decoder, audio, haptic
  std::string name;       // as on the command line
  bool there = false;
  std::string state;  // a description; or why it cannot be used, and what to do
};
[[nodiscard]] std::vector<DeviceState> lookAtDevices(const HapticSettings& settings, Clock& clock);

// Bounds the memory that a damaged film makes a reader or a decoder ask for, until a film is written.
void boundDecoderMemory() noexcept;

// Stops the motors of every haptic device of the process; for handlers of fatal signals.
void stopAllMotors() noexcept;

}  // namespace relievo::drivers
