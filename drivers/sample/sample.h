// SPDX-License-Identifier: Apache-2.0
// A minimal back end for each interface of the HAL, to be copied (see README.md). Programs use a back end only through
// functions like these.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "hal/audio_output.h"
#include "hal/display.h"
#include "hal/haptic_device.h"
#include "hal/media/audio_decoder.h"
#include "hal/media/media_source.h"
#include "hal/media/video_decoder.h"
#include "hal/remote_input.h"
#include "platform/clock.h"

namespace relievo {

// Reads sample films (sample_film.h) from files.
[[nodiscard]] std::unique_ptr<MediaSource> makeSampleSource();
// Decode the pictures and the sound of sample films; Unsupported for any other stream.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeSampleDecoder();
[[nodiscard]] std::unique_ptr<AudioDecoder> makeSampleAudioDecoder();

// An invisible screen without GL that shows a picture at once.
[[nodiscard]] std::unique_ptr<Display> makeSampleDisplay();

// A virtual sound card that plays in real time by `clock`, which must outlive it.
struct SampleCard {
  bool there = true;
};
[[nodiscard]] std::unique_ptr<AudioOutput> makeSampleAudio(std::shared_ptr<const SampleCard> card, const Clock& clock);

// The wire to a haptic device. Only what needs real hardware is behind it, so that a test can replace it by a fake and
// test the driver itself.
class SamplePort {
 public:
  virtual ~SamplePort() = default;
  virtual Result<void> open() = 0;  // NotFound, PermissionDenied
  virtual void close() noexcept = 0;
  // One exchange each; Lost if the device has gone away.
  virtual Result<glm::dvec3> readPosition() RELIEVO_RT = 0;
  virtual Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT = 0;
};
// `clock` must outlive the device.
[[nodiscard]] std::unique_ptr<HapticDevice> makeSampleHaptic(std::unique_ptr<SamplePort> port, const Clock& clock);

// A receiver that sends a byte for each key press through `fd`, which the caller keeps open.
[[nodiscard]] std::unique_ptr<RemoteInput> makeSampleRemote(int fd);

}  // namespace relievo
