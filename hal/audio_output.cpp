// SPDX-License-Identifier: Apache-2.0
// State guards of the sound output.
#include "hal/audio_output.h"

namespace relievo {
namespace {

constexpr const char* kNotOpen = "the sound output is not open; open it first";

}  // namespace

Result<AudioFormat> AudioOutput::open(const AudioFormat& wished) {
  if (state_ != State::Closed) return fail(ErrorCode::InvalidState, "the sound output is open already; close it first");
  if (wished.rate_hz < 1000 || wished.rate_hz > 768'000 || wished.channels < 1 || wished.channels > 8) {
    return fail(ErrorCode::InvalidArgument, "sound must have 1000 to 768000 frames a second and 1 to 8 channels");
  }
  const auto opened = openOutput(wished);
  if (!opened) {
    closeOutput();
    return opened;
  }
  format_ = *opened;
  state_ = State::Open;
  return opened;
}

Result<std::size_t> AudioOutput::write(std::span<const float> samples) {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, kNotOpen);
  const auto channels = static_cast<std::size_t>(format_.channels);
  if (samples.size() % channels != 0)
    return fail(ErrorCode::InvalidArgument, "samples must be written in whole frames");
  if (samples.empty()) return std::size_t{0};
  return noteLoss(writeFrames(samples.data(), samples.size() / channels));
}

Result<std::optional<AudioPosition>> AudioOutput::position() {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, kNotOpen);
  return noteLoss(samplePosition());
}

Result<void> AudioOutput::flush() {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, kNotOpen);
  return noteLoss(dropFrames());
}

void AudioOutput::close() noexcept {
  if (state_ == State::Closed) return;
  closeOutput();
  state_ = State::Closed;
}

}  // namespace relievo
