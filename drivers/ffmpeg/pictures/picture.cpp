// SPDX-License-Identifier: Apache-2.0
// Describes FFmpeg's pixel formats in the types of hal/media/frame.h.
#include "drivers/ffmpeg/pictures/picture.h"

#include <algorithm>
#include <bit>
#include <cerrno>

extern "C" {
#include <libavutil/error.h>
#include <libavutil/pixdesc.h>
#include <libavutil/stereo3d.h>
#include <libswscale/swscale.h>
}

namespace relievo::ffmpeg {
namespace {

static_assert(std::endian::native == std::endian::little, "hal/media/frame.h describes little-endian samples");

constexpr std::uint64_t kOtherLayouts = AV_PIX_FMT_FLAG_BE | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM |
                                        AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_FLOAT | AV_PIX_FMT_FLAG_BAYER;

// Without alpha, which comes last.
int componentCount(const AVPixFmtDescriptor& format) noexcept {
  return format.nb_components <= 2 ? 1 : 3;
}

bool isXyz(int format) noexcept {
  return format == AV_PIX_FMT_XYZ12LE || format == AV_PIX_FMT_XYZ12BE;
}

ColorModel modelOf(const AVPixFmtDescriptor& format) noexcept {
  if ((format.flags & AV_PIX_FMT_FLAG_RGB) != 0) return ColorModel::Rgb;
  return componentCount(format) == 1 ? ColorModel::Gray : ColorModel::Yuv;
}

// True for 8 bits in a byte, or up to 16 in an aligned two-byte word. Fewer bits occur only in obsolete formats, which
// are converted.
bool readableInPlace(const AVComponentDescriptor& c) noexcept {
  if (c.depth <= 8) return c.depth == 8 && c.shift == 0;
  return c.shift + c.depth <= 16 && c.offset % 2 == 0 && c.step % 2 == 0;
}

Component componentOf(const AVComponentDescriptor& c) noexcept {
  return {.plane = static_cast<std::uint8_t>(c.plane),
          .offset_bytes = static_cast<std::uint8_t>(c.offset),
          .step_bytes = static_cast<std::uint8_t>(c.step),
          .shift = static_cast<std::uint8_t>(c.shift),
          .bits = static_cast<std::uint8_t>(c.depth)};
}

// Frame packing SEI of H.264 and HEVC, and the stereo header of a JPEG picture.
ViewLayout viewsOf(const AVFrame& picture) noexcept {
  const AVFrameSideData* const data = av_frame_get_side_data(&picture, AV_FRAME_DATA_STEREO3D);
  if (data == nullptr || data->size < sizeof(AVStereo3D)) return {};
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(61, 19, 100)  // FFmpeg 7.1: one of several views (views/view_pairs.h)
  if (av_frame_get_side_data(&picture, AV_FRAME_DATA_VIEW_ID) != nullptr) return {};
#endif
  const auto& stereo = *reinterpret_cast<const AVStereo3D*>(data->data);
  ViewLayout views{.right_first = (stereo.flags & AV_STEREO3D_FLAG_INVERT) != 0};
  switch (stereo.type) {
    case AV_STEREO3D_2D:
      return {};
    case AV_STEREO3D_SIDEBYSIDE:
      views.way = ViewLayout::Way::SideBySide;
      return views;
    case AV_STEREO3D_TOPBOTTOM:
      views.way = ViewLayout::Way::TopBottom;
      return views;
    default:
      views.way = ViewLayout::Way::Other;
      return views;
  }
}

bool isFullRangeYuv(int format) noexcept {
  switch (format) {
    case AV_PIX_FMT_YUVJ411P:
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ440P:
    case AV_PIX_FMT_YUVJ444P:
      return true;
    default:
      return false;
  }
}

// Gray and RGB are full range unless specified otherwise; unspecified YUV stays unspecified.
ColorRange rangeOf(int format, AVColorRange range, ColorModel model) noexcept {
  if (isFullRangeYuv(format) || range == AVCOL_RANGE_JPEG) return ColorRange::Full;
  if (range == AVCOL_RANGE_MPEG) return ColorRange::Limited;
  return model == ColorModel::Yuv ? ColorRange::Unspecified : ColorRange::Full;
}

bool isInterlaced(const AVFrame& picture) noexcept {
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(58, 7, 100)  // FFmpeg 6.1
  return (picture.flags & AV_FRAME_FLAG_INTERLACED) != 0;
#else
  return picture.interlaced_frame != 0;
#endif
}

bool isTopFieldFirst(const AVFrame& picture) noexcept {
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(58, 7, 100)  // FFmpeg 6.1
  return (picture.flags & AV_FRAME_FLAG_TOP_FIELD_FIRST) != 0;
#else
  return picture.top_field_first != 0;
#endif
}

// FFmpeg numbers primaries and transfers as ITU-T H.273 does.
std::uint8_t h273(int code) noexcept {
  return code > 0 && code <= 255 ? static_cast<std::uint8_t>(code) : kUnspecifiedColor;
}

ColorMatrix matrixOf(AVColorSpace space) noexcept {
  switch (space) {
    case AVCOL_SPC_BT709:
      return ColorMatrix::Bt709;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
      return ColorMatrix::Bt601;
    case AVCOL_SPC_BT2020_NCL:
    case AVCOL_SPC_BT2020_CL:
      return ColorMatrix::Bt2020;
    default:
      return ColorMatrix::Unspecified;
  }
}

FieldOrder fieldsOf(AVFieldOrder order) noexcept {
  switch (order) {
    case AV_FIELD_PROGRESSIVE:
      return FieldOrder::Progressive;
    case AV_FIELD_TT:
      return FieldOrder::TopTop;
    case AV_FIELD_BB:
      return FieldOrder::BottomBottom;
    case AV_FIELD_TB:
      return FieldOrder::TopBottom;
    case AV_FIELD_BT:
      return FieldOrder::BottomTop;
    default:
      return FieldOrder::Unknown;
  }
}

double sampleAspectOf(AVRational container, AVRational own) noexcept {
  for (const AVRational aspect : {container, own}) {
    if (aspect.num > 0 && aspect.den > 0) return av_q2d(aspect);
  }
  return 1.0;
}

const float* floatsOf(const AVFrame& picture, int row) noexcept {
  return reinterpret_cast<const float*>(picture.data[0] + std::ptrdiff_t{row} * picture.linesize[0]);
}

std::optional<FloatCodes> scaleFor(const AVFrame& picture) {
  const auto cols = static_cast<std::size_t>(picture.width);
  const auto sample = [&](std::size_t i) { return floatsOf(picture, static_cast<int>(i / cols))[i % cols]; };
  return FloatCodes::chosenFor(sample, cols * static_cast<std::size_t>(picture.height));
}

void toCodes(const AVFrame& picture, const FloatCodes& scale, const AVFrame& codes) noexcept {
  for (int r = 0; r < picture.height; ++r) {
    const float* const from = floatsOf(picture, r);
    auto* const to = reinterpret_cast<std::uint16_t*>(codes.data[0] + std::ptrdiff_t{r} * codes.linesize[0]);
    std::transform(from, from + picture.width, to, [&](float value) { return scale.codeOf(value); });
  }
}

}  // namespace

bool isGrayFloat(int format) noexcept {
  return format == AV_PIX_FMT_GRAYF32LE;
}

bool describable(int format) noexcept {
  const AVPixFmtDescriptor* const description = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format));
  if (description == nullptr || (description->flags & kOtherLayouts) != 0) return false;
  // Frame has no XYZ model, and UYYVYY411's luma samples are at uneven steps, which FFmpeg's description does not show.
  if (isXyz(format) || format == AV_PIX_FMT_UYYVYY411) return false;
  for (int i = 0; i < componentCount(*description); ++i) {
    if (!readableInPlace(description->comp[i])) return false;
  }
  return true;
}

int nearestDescribable(int format) noexcept {
  const AVPixFmtDescriptor* const description = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format));
  if (description == nullptr) return AV_PIX_FMT_RGB24;
  const AVPixelFormat swapped = av_pix_fmt_swap_endianness(static_cast<AVPixelFormat>(format));
  if (swapped != AV_PIX_FMT_NONE && describable(swapped) && sws_isSupportedOutput(swapped) != 0) return swapped;
  if ((description->flags & AV_PIX_FMT_FLAG_PAL) != 0 || isXyz(format)) return AV_PIX_FMT_RGB24;
  const bool fine = description->comp[0].depth > 8;
  switch (modelOf(*description)) {
    case ColorModel::Gray:
      return fine ? AV_PIX_FMT_GRAY16LE : AV_PIX_FMT_GRAY8;
    case ColorModel::Rgb:
      return fine ? AV_PIX_FMT_RGB48LE : AV_PIX_FMT_RGB24;
    case ColorModel::Yuv:
      return AV_PIX_FMT_YUV420P;
  }
  return AV_PIX_FMT_RGB24;
}

Frame frameOf(FramePtr picture, AVRational sample_aspect) {
  const AVPixFmtDescriptor& format = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture->format));
  Frame frame;
  frame.width = picture->width;
  frame.height = picture->height;
  frame.model = modelOf(format);
  frame.range = rangeOf(picture->format, picture->color_range, frame.model);
  frame.matrix = matrixOf(picture->colorspace);
  frame.interlaced = isInterlaced(*picture);
  frame.top_field_first = isTopFieldFirst(*picture);
  frame.primaries = h273(picture->color_primaries);
  frame.transfer = h273(picture->color_trc);
  frame.sample_aspect = sampleAspectOf(sample_aspect, picture->sample_aspect_ratio);
  if (frame.model == ColorModel::Yuv) {
    frame.chroma_shift_x = format.log2_chroma_w;
    frame.chroma_shift_y = format.log2_chroma_h;
  }
  for (int i = 0; i < componentCount(format); ++i) {
    frame.components[static_cast<std::size_t>(i)] = componentOf(format.comp[i]);
  }
  const AVComponentDescriptor& last = format.comp[format.nb_components - 1];
  if ((format.flags & AV_PIX_FMT_FLAG_ALPHA) != 0 && readableInPlace(last)) frame.alpha = componentOf(last);
  frame.views = viewsOf(*picture);
  for (std::size_t i = 0; i < frame.planes.size() && picture->data[i] != nullptr; ++i) {
    frame.planes[i] = {picture->data[i], picture->linesize[i]};
    ++frame.plane_count;
  }
  frame.owner = std::shared_ptr<AVFrame>(std::move(picture));
  return frame;
}

void describeSignals(StreamInfo& stream, const AVCodecParameters& parameters, AVRational sample_aspect) {
  const AVPixFmtDescriptor* const format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(parameters.format));
  const ColorModel model = format == nullptr ? ColorModel::Yuv : modelOf(*format);
  stream.range = rangeOf(parameters.format, parameters.color_range, model);
  stream.matrix = matrixOf(parameters.color_space);
  stream.sample_aspect = sampleAspectOf(sample_aspect, parameters.sample_aspect_ratio);
  stream.primaries = h273(parameters.color_primaries);
  stream.transfer = h273(parameters.color_trc);
  stream.fields = fieldsOf(parameters.field_order);
  if (format == nullptr) return;
  stream.pixel_format = av_get_pix_fmt_name(static_cast<AVPixelFormat>(parameters.format));
  stream.bits = parameters.bits_per_raw_sample > 0 ? parameters.bits_per_raw_sample : format->comp[0].depth;
}

Converter::Converter() noexcept = default;
Converter::~Converter() {
  sws_freeContext(scaler_);
}

Result<FramePtr> Converter::convert(const AVFrame& picture) {
  const bool floats = isGrayFloat(picture.format);
  const auto from = static_cast<AVPixelFormat>(picture.format);
  const auto to = static_cast<AVPixelFormat>(nearestDescribable(picture.format));
  if (!floats) {
    scaler_ = sws_getCachedContext(scaler_, picture.width, picture.height, from, picture.width, picture.height, to,
                                   SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP, nullptr, nullptr, nullptr);
    if (scaler_ == nullptr) {
      return fail(ErrorCode::Unsupported, "its pixel format is not supported; convert the film");
    }
  }
  FramePtr converted(av_frame_alloc());
  if (!converted) return fail(ErrorCode::Exhausted, "out of memory for a picture", ENOMEM);
  converted->format = to;
  converted->width = picture.width;
  converted->height = picture.height;
  if (av_frame_get_buffer(converted.get(), 0) < 0 || av_frame_copy_props(converted.get(), &picture) < 0) {
    return fail(ErrorCode::Exhausted, "out of memory for a picture", ENOMEM);
  }
  if (floats) {
    if (!codes_) codes_ = scaleFor(picture);
    toCodes(picture, scale(), *converted);
    return converted;
  }
  if (sws_scale(scaler_, picture.data, picture.linesize, 0, picture.height, converted->data, converted->linesize) < 0) {
    return fail(ErrorCode::Unsupported, "its pixel format is not supported; convert the film");
  }
  return converted;
}

}  // namespace relievo::ffmpeg
