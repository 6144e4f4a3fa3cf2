// SPDX-License-Identifier: Apache-2.0
// The explicit list of back ends, by the names of the command line: real ones first, mock last. For the mains only.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/audio_decoder.h"
#include "hal/audio_output.h"
#include "hal/back_end_name.h"
#include "hal/display.h"
#include "hal/haptic_device.h"
#include "hal/media_source.h"
#include "hal/remote_input.h"
#include "hal/video_decoder.h"
#include "platform/clock.h"
#include "platform/failure.h"

namespace relievo::drivers {

// The names that each option takes, for --help and for the message of a wrong one: "kms .. mock".
extern const char* const kDisplayNames;
extern const char* const kHapticNames;
extern const char* const kRemoteNames;
extern const char* const kAudioNames;

extern const char* const kMockFilm;  // the url of a film of three seconds that is in no file

extern const double kFalconCountsPerNm;  // where the configuration does not tell

// What the haptic back ends are told besides their names; from the configuration.
struct HapticSettings {
  std::string falcon_firmware;  // empty: only one that runs already will do
  std::optional<double> falcon_counts_per_nm;
};

// A null pointer means "none". The failure names the option when its word is not known (InvalidArgument), the script
// when that is not there (NotFound), or its line when that is wrong (InvalidArgument).
// `clock` must outlive what is made. The names with "window" in them are about the one window of the process: its
// display, its keys and its mouse.
[[nodiscard]] Outcome<std::unique_ptr<Display>> makeDisplay(const BackEndName& name);
[[nodiscard]] Outcome<std::unique_ptr<HapticDevice>> makeHapticDevice(const BackEndName& name, Clock& clock,
                                                                      const HapticSettings& settings = {});
[[nodiscard]] Outcome<std::unique_ptr<RemoteInput>> makeRemoteInput(const BackEndName& name, Clock& clock);
[[nodiscard]] Outcome<std::unique_ptr<AudioOutput>> makeAudioOutput(const BackEndName& name, const Clock& clock);
// The files that a back end reads or writes because its name says so, empty where it does not; devices are no files.
struct NamedFiles {
  std::string read, written;
};
[[nodiscard]] NamedFiles filesNamedBy(const BackEndName& name);
[[nodiscard]] std::unique_ptr<MediaSource> makeMediaSource(const std::string& url);
// In software, exactly the same everywhere; or by hardware that takes the stream, with the software behind it in case
// that it fails.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeSoftwareDecoder(const StreamInfo& stream);
[[nodiscard]] std::unique_ptr<VideoDecoder> makeVideoDecoder(const StreamInfo& stream);
[[nodiscard]] std::unique_ptr<AudioDecoder> makeAudioDecoder();
// The text at a path or an address, as makeMediaSource would open it.
[[nodiscard]] Result<std::string> readText(const std::string& url, std::size_t most_bytes,
                                           const std::atomic<bool>& cancelled);

// A fault of a mock that this process has made, or its end, while it runs: "haptic" "unplug", "display" "plug". The
// failure of a wrong word says which there are; InvalidState where that device is no mock.
[[nodiscard]] Result<void> switchFault(std::string_view device, std::string_view fault);

// What is there of each kind of hardware, found out by opening it: takes seconds where a device must be started up.
struct DeviceState {
  const char* kind = "";  // display, decoder, audio, haptic
  std::string name;       // as on the command line
  bool there = false;
  std::string state;  // what it is; why not, and what to do
};
[[nodiscard]] std::vector<DeviceState> lookAtDevices(const HapticSettings& settings, Clock& clock);

// Takes the force from every haptic device of the process; for a handler of a fatal signal.
void stopAllMotors() noexcept;

}  // namespace relievo::drivers
