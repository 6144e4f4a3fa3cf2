// SPDX-License-Identifier: Apache-2.0
// What the camera's source tells the decoder of its raw pictures: behind StreamInfo::native.
#pragma once

#include <memory>

#include "drivers/v4l2/formats.h"
#include "hal/media_source.h"

namespace relievo::v4l2 {

struct RawStream {
  enum class View : std::uint8_t { AsItIs, Gray };  // Gray: depth to look at, near bright
  Format format;
  Layout layout;
  Duration period{0};
  View view = View::AsItIs;
};
// Its type tells this back end's streams from others.
struct RawStreamDeleter {
  void operator()(const RawStream* stream) const noexcept { delete stream; }
};

}  // namespace relievo::v4l2
