// SPDX-License-Identifier: Apache-2.0
// The object behind StreamInfo::native, from a camera's source to the decoder of its raw pictures.
#pragma once

#include <memory>

#include "drivers/v4l2/formats.h"
#include "hal/media/media_source.h"

namespace relievo::v4l2 {

struct RawStream {
  enum class View : std::uint8_t { AsItIs, Gray };  // Gray: depth as a visible picture, near is bright
  Format format;
  Layout layout;
  Duration period{0};
  View view = View::AsItIs;
};
// The deleter's type identifies this back end's streams.
struct RawStreamDeleter {
  void operator()(const RawStream* stream) const noexcept { delete stream; }
};

}  // namespace relievo::v4l2
