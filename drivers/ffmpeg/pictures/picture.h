// SPDX-License-Identifier: Apache-2.0
// Makes a Frame of a decoded picture: a reference if hal/media/frame.h can describe its layout, else a converted copy.
#pragma once

#include <memory>
#include <optional>

#include "drivers/ffmpeg/library.h"
#include "hal/media/float_codes.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

struct SwsContext;

namespace relievo::ffmpeg {

// True if samples of this format (an AVPixelFormat) can be read in place through hal/media/frame.h.
[[nodiscard]] bool describable(int format) noexcept;

// True for gray in floating point.
[[nodiscard]] bool isGrayFloat(int format) noexcept;

// The format to convert an undescribable one to; it has the same bits if only the byte order differs.
[[nodiscard]] int nearestDescribable(int format) noexcept;

// Fills in size, layout, colour signalling and sample aspect; the frame owns a reference to the picture. The caller
// sets the times. `sample_aspect`: the container's, 0/1 if unspecified.
[[nodiscard]] Frame frameOf(FramePtr picture, AVRational sample_aspect);

// Fills in the same for a stream, as far as its parameters have it.
void describeSignals(StreamInfo& stream, const AVCodecParameters& parameters, AVRational sample_aspect);

// Converts pictures to describable formats; reuses FFmpeg's scaler between pictures.
class Converter {
 public:
  Converter() noexcept;
  ~Converter();
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;
  // Gray in floating point becomes codes on the scale of the first such picture with a number
  // (hal/media/float_codes.h). Unsupported if FFmpeg cannot read the format, Exhausted if out of memory.
  [[nodiscard]] Result<FramePtr> convert(const AVFrame& picture);
  // The scale of the last converted picture, a floating-point one.
  [[nodiscard]] FloatCodes scale() const noexcept { return codes_.value_or(FloatCodes::identity()); }
  // Call for another film: its first floating-point picture sets a new scale.
  void forgetScale() noexcept { codes_.reset(); }

 private:
  SwsContext* scaler_ = nullptr;
  std::optional<FloatCodes> codes_;
};

}  // namespace relievo::ffmpeg
