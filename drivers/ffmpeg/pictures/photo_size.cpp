// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/pictures/photo_size.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "hal/media/halved.h"

namespace relievo::ffmpeg {
namespace {

constexpr std::array kOfPhotos{AV_CODEC_ID_MJPEG, AV_CODEC_ID_PNG, AV_CODEC_ID_WEBP};

bool exceeds(int width, int height) noexcept {
  return std::int64_t{width} * height > VideoDecoder::kMostSamples;
}

}  // namespace

bool isOfPhotos(const AVInputFormat& format) noexcept {
  const std::string_view name = format.name;
  return name == "image2" || name.ends_with("_pipe");
}

std::int64_t mostSamples(AVCodecID codec, bool photo) noexcept {
  const bool of_photos = std::ranges::find(kOfPhotos, codec) != kOfPhotos.end();
  return photo && of_photos ? kMostOfPhoto : VideoDecoder::kMostSamples;
}

std::optional<std::string> halveSize(StreamInfo& stream) {
  const auto is_codec = [&stream](AVCodecID id) { return stream.codec == avcodec_get_name(id); };
  if (!exceeds(stream.width, stream.height) || !std::ranges::any_of(kOfPhotos, is_codec)) return std::nullopt;
  std::string line = halvedLine(stream.width, stream.height);
  stream.width = (stream.width + 1) / 2;
  stream.height = (stream.height + 1) / 2;
  return line;
}

Result<Frame> withinLimit(Frame frame) {
  if (!exceeds(frame.width, frame.height)) return frame;
  return halved(frame);
}

}  // namespace relievo::ffmpeg
