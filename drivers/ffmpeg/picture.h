// SPDX-License-Identifier: Apache-2.0
// A decoder's picture as a Frame: by reference where hal/frame.h can describe its layout, converted where not.
#pragma once

#include <memory>

#include "drivers/ffmpeg/library.h"
#include "hal/frame.h"
#include "hal/media_source.h"
#include "platform/error.h"

struct SwsContext;

namespace relievo::ffmpeg {

// True when samples of this format (an AVPixelFormat) can be read in place through hal/frame.h.
[[nodiscard]] bool describable(int format) noexcept;

// A renderer's distances: gray in floating point, taken for metres along the camera's axis.
[[nodiscard]] bool isDistance(int format) noexcept;

// The format to convert one to that is not: the same bits in native byte order where that is the only difference.
[[nodiscard]] int nearestDescribable(int format) noexcept;

// Size, layout, colour signalling and sample aspect; the owner is a reference of the picture. Times are the caller's.
// `sample_aspect` is the container's word, 0/1 where it has none.
[[nodiscard]] Frame frameOf(FramePtr picture, AVRational sample_aspect);

// The same of a stream, as far as its parameters tell it.
void describeSignals(StreamInfo& stream, const AVCodecParameters& parameters, AVRational sample_aspect) noexcept;

// Converts pictures into describable ones; keeps the library's scaler between them.
class Converter {
 public:
  Converter() noexcept;
  ~Converter();
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;
  // Distances become whole mm, 0 where there is none or it is beyond 65 m. Unsupported where the library cannot read
  // the format, Exhausted without memory.
  [[nodiscard]] Result<FramePtr> convert(const AVFrame& picture);

 private:
  SwsContext* scaler_ = nullptr;
};

}  // namespace relievo::ffmpeg
