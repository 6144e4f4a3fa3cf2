// SPDX-License-Identifier: Apache-2.0
// One back end of each interface of the HAL, as small as its contract allows: made to be copied (see README.md). A
// program knows a back end by such functions alone.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "hal/audio_decoder.h"
#include "hal/audio_output.h"
#include "hal/display.h"
#include "hal/haptic_device.h"
#include "hal/media_source.h"
#include "hal/remote_input.h"
#include "hal/video_decoder.h"
#include "platform/clock.h"

namespace relievo {

// Reads sample films (sample_film.h) from files.
[[nodiscard]] std::unique_ptr<MediaSource> makeSampleSource();
// Their pictures and their sound; Unsupported for any other stream.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeSampleDecoder();
[[nodiscard]] std::unique_ptr<AudioDecoder> makeSampleAudioDecoder();

// A screen without GL that shows a picture at once.
[[nodiscard]] std::unique_ptr<Display> makeSampleDisplay();

// A sound card that runs at the pace of the clock, which must outlive it.
struct SampleCard {
  bool there = true;
};
[[nodiscard]] std::unique_ptr<AudioOutput> makeSampleAudio(std::shared_ptr<const SampleCard> card, const Clock& clock);

// The wire to a haptic device. All that only real hardware can do is behind it, and no more than that: a test puts a
// fake in its place and runs the driver itself.
class SamplePort {
 public:
  virtual ~SamplePort() = default;
  virtual Result<void> open() = 0;  // NotFound, PermissionDenied
  virtual void close() noexcept = 0;
  // One exchange each; Lost when the device has gone away.
  virtual Result<glm::dvec3> readPosition() RELIEVO_RT = 0;
  virtual Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT = 0;
};
// `clock` must outlive it.
[[nodiscard]] std::unique_ptr<HapticDevice> makeSampleHaptic(std::unique_ptr<SamplePort> port, const Clock& clock);

// A receiver that sends a byte for each key that is pressed, through a file descriptor that the caller keeps open.
[[nodiscard]] std::unique_ptr<RemoteInput> makeSampleRemote(int fd);

}  // namespace relievo
