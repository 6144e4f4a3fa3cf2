// SPDX-License-Identifier: Apache-2.0
// Pairs pictures by their time and their view's number, which FFmpeg has as side data since version 7.1.
#include "drivers/ffmpeg/views/view_pairs.h"

#include <utility>

extern "C" {
#include <libavutil/opt.h>
#include <libavutil/stereo3d.h>
}

namespace relievo::ffmpeg {
namespace {

// Whether the base view is the right eye's.
struct SaidEye {
  std::optional<bool> coded_right;
  bool container_right = false;
};

#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(61, 19, 100)  // FFmpeg 7.1

std::optional<int> viewOf(const AVFrame& picture) noexcept {
  const AVFrameSideData* const data = av_frame_get_side_data(&picture, AV_FRAME_DATA_VIEW_ID);
  if (data == nullptr || data->size < sizeof(int)) return std::nullopt;
  return *reinterpret_cast<const int*>(data->data);
}

// Two sources: an SEI message in each view's coded picture (3D reference displays; H.265, G.14.2.3), or mp4's box
// `eyes`, which is about both views and which FFmpeg adds to each picture.
SaidEye saidEye(const AVFrame& base) noexcept {
  SaidEye said;
  for (int i = 0; i < base.nb_side_data; ++i) {
    const AVFrameSideData& data = *base.side_data[i];
    if (data.type != AV_FRAME_DATA_STEREO3D || data.size < sizeof(AVStereo3D)) continue;
    const auto& stereo = *reinterpret_cast<const AVStereo3D*>(data.data);
    if (stereo.view == AV_STEREO3D_VIEW_LEFT || stereo.view == AV_STEREO3D_VIEW_RIGHT)
      said.coded_right = stereo.view == AV_STEREO3D_VIEW_RIGHT;
    else if ((stereo.flags & AV_STEREO3D_FLAG_INVERT) != 0 || stereo.primary_eye == AV_PRIMARY_EYE_RIGHT)
      said.container_right = true;
  }
  return said;
}

#else

std::optional<int> viewOf(const AVFrame& /*picture*/) noexcept {
  return std::nullopt;
}
SaidEye saidEye(const AVFrame& /*base*/) noexcept {
  return {};
}

#endif

}  // namespace

bool askForViews(AVCodecContext& context) noexcept {
  return av_opt_set(&context, "view_ids", "-1", AV_OPT_SEARCH_CHILDREN) >= 0;
}

ViewPairs::Moment ViewPairs::add(FramePtr picture) {
  const auto view = viewOf(*picture);
  if (!waiting_ && !view) return {.base = std::move(picture), .second = nullptr};
  const auto first = waiting_ ? viewOf(*waiting_) : std::nullopt;
  if (first && view && first != view && waiting_->pts == picture->pts) {
    base_view_ = first;
    const SaidEye said = saidEye(*waiting_);
    return {.base = std::move(waiting_),
            .second = std::move(picture),
            .base_is_right = said.coded_right.value_or(said.container_right)};
  }
  if (view && base_view_ && view != base_view_) return {};
  return {.base = std::exchange(waiting_, std::move(picture)), .second = nullptr};
}

ViewPairs::Moment ViewPairs::rest() {
  return {.base = std::move(waiting_), .second = nullptr};
}

}  // namespace relievo::ffmpeg
