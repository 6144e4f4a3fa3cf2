// SPDX-License-Identifier: Apache-2.0
// Runs the author's encoder and libavcodec's decoder back to back. Pictures keep their order; timestamps bypass the
// codec.
#include "app/lab/film/coded_depth.h"

#include <memory>
#include <optional>
#include <utility>

#include "app/coding/packet_decoder.h"

namespace relievo {
namespace {

using Picture = PacketDecoder::Picture;

Result<void> check(std::span<const Frame> frames, int bits) {
  if (frames.empty()) return fail(ErrorCode::InvalidArgument, "no frames to encode");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& f = frames[i];
    if (f.empty() || f.model != frames[0].model || f.model == ColorModel::Rgb || f.components[0].bits != bits ||
        f.components[0].step_bytes != (bits > 8 ? 2 : 1) || f.width != frames[0].width ||
        f.height != frames[0].height) {
      return fail(ErrorCode::InvalidArgument,
                  "depth to encode must be gray or 4:2:0 frames of one size and the encoder's bit depth");
    }
    if (i > 0 && f.pts <= frames[i - 1].pts) {
      return fail(ErrorCode::InvalidArgument, "the timestamps of frames to encode must increase");
    }
  }
  return {};
}

// 4:0:0 may be decoded as 4:2:0 with flat chroma: only the first plane carries data then.
Frame frameOf(Picture picture, const Frame& original) {
  Frame frame;
  frame.pts = original.pts;
  frame.duration = original.duration;
  frame.width = picture->width;
  frame.height = picture->height;
  frame.model = original.model;
  frame.range = picture->color_range == AVCOL_RANGE_JPEG ? ColorRange::Full : ColorRange::Unspecified;
  frame.matrix = original.matrix;
  frame.chroma_shift_x = original.chroma_shift_x;
  frame.chroma_shift_y = original.chroma_shift_y;
  frame.sample_aspect = original.sample_aspect;
  frame.plane_count = original.plane_count;
  for (std::size_t i = 0; i < original.plane_count; ++i) {
    frame.components[i] = original.components[i];
    frame.planes[i] = {picture->data[i], picture->linesize[i]};
  }
  frame.owner = std::shared_ptr<AVFrame>(std::move(picture));
  return frame;
}

class RoundTrip {
 public:
  explicit RoundTrip(std::span<const Frame> originals) : originals_(originals) {}

  Result<CodedDepth> run(const VideoEncoder::Settings& settings) {
    if (auto opened = encoder_.open(settings, false); !opened) return std::unexpected(opened.error());
    if (auto opened = decoder_.open(encoder_.context()); !opened) return std::unexpected(opened.error());
    const PacketDecoder::Sink pictures = [this](Picture picture) { return take(std::move(picture)); };
    const VideoEncoder::Sink sink = [&](AVPacket& packet) {
      coded_.bytes += static_cast<std::uint64_t>(packet.size);
      return decoder_.decode(&packet, pictures);
    };
    std::optional<MediaTime> last_key;
    for (const Frame& original : originals_) {
      const bool key = !last_key || original.pts - *last_key >= std::chrono::seconds(1);
      if (key) last_key = original.pts;
      std::array<std::vector<std::uint8_t>, 3> planes;
      for (std::size_t i = 0; i < original.plane_count; ++i) planes.at(i) = packed(original, i);
      const VideoEncoder::Planes data{planes[0].data(), planes[1].data(), planes[2].data()};
      if (auto sent = encoder_.encode(data, original.pts, key, sink); !sent) {
        return std::unexpected(sent.error());
      }
    }
    if (auto drained = encoder_.drain(sink); !drained) return std::unexpected(drained.error());
    if (auto last = decoder_.decode(nullptr, pictures); !last) return std::unexpected(last.error());
    if (coded_.frames.size() != originals_.size()) {
      return fail(ErrorCode::Io, "encoding or decoding depth in memory failed");
    }
    return std::move(coded_);
  }

 private:
  // Removes the gaps between rows.
  static std::vector<std::uint8_t> packed(const Frame& frame, std::size_t component) {
    const int width = component == 0 ? frame.width : frame.width >> frame.chroma_shift_x;
    const int height = component == 0 ? frame.height : frame.height >> frame.chroma_shift_y;
    const std::size_t row = static_cast<std::size_t>(width) * frame.components.at(component).step_bytes;
    std::vector<std::uint8_t> plane;
    for (int r = 0; r < height; ++r) {
      const std::uint8_t* const first = frame.planes.at(component).data + r * frame.planes.at(component).stride_bytes;
      plane.insert(plane.end(), first, first + row);
    }
    return plane;
  }

  bool take(Picture picture) {
    const std::size_t index = coded_.frames.size();
    if (index >= originals_.size()) return false;
    coded_.frames.push_back(frameOf(std::move(picture), originals_[index]));
    return true;
  }

  std::span<const Frame> originals_;
  VideoEncoder encoder_;
  PacketDecoder decoder_;
  CodedDepth coded_;
};

}  // namespace

Result<CodedDepth> codeDepth(std::span<const Frame> frames, VideoEncoder::Settings settings) {
  if (const auto checked = check(frames, settings.bits); !checked) return std::unexpected(checked.error());
  settings.width = frames[0].width;
  settings.height = frames[0].height;
  settings.gray = frames[0].model == ColorModel::Gray;
  settings.range = settings.gray ? ColorRange::Full : frames[0].range;
  settings.matrix = frames[0].matrix;
  if (frames.size() > 1) settings.frame_period = (frames.back().pts - frames.front().pts) / (frames.size() - 1);
  return RoundTrip(frames).run(settings);
}

Result<CodedDepth> codeDepth(std::span<const Frame> frames, int crf) {
  return codeDepth(frames, {.crf = crf});
}

}  // namespace relievo
