// SPDX-License-Identifier: Apache-2.0
// Pairs the two views of a moment, which FFmpeg's decoder of MV-HEVC returns as two pictures.
#pragma once

#include <optional>

#include "drivers/ffmpeg/library.h"

namespace relievo::ffmpeg {

// Makes a decoder that is not open yet return all views. False, without effect, if it always returns one.
bool askForViews(AVCodecContext& context) noexcept;

class ViewPairs {
 public:
  // One moment; `base` is null if none is whole yet.
  struct Moment {
    FramePtr base, second;
    bool base_is_right = false;
  };
  // A picture with one view is whole at once. The base view waits for the picture after it, which is its second view
  // or, if that is missing, another moment's. A second view whose base was lost or left out is dropped.
  [[nodiscard]] Moment add(FramePtr picture);
  // At the end: the picture that still waits for a second view.
  [[nodiscard]] Moment rest();
  // For a seek.
  void dropWaiting() noexcept { waiting_.reset(); }

 private:
  FramePtr waiting_;
  std::optional<int> base_view_;  // its number, once a pair was seen
};

}  // namespace relievo::ffmpeg
