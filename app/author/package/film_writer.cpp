// SPDX-License-Identifier: Apache-2.0
// Two or three encoders, and the destination of their packets.
#include "app/author/package/film_writer.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

extern "C" {
#include <libavutil/log.h>
}

#include "app/author/package/film_place.h"
#include "app/scene/material.h"

namespace relievo {
namespace {

constexpr std::int64_t kLongestHeldUs = 500'000;  // of a live film: pictures that wait for a subtitle

void setTag(AVDictionary** tags, const std::string& key, const std::string& value) {
  av_dict_set(tags, key.c_str(), value.c_str(), 0);
}

// One track of the film.
struct Track {
  Result<void> open(AVFormatContext& muxer, const VideoEncoder::Settings& settings, const char* title);
  Result<void> encode(const VideoEncoder::Planes& planes, MediaTime time, bool key);
  Result<void> drain() { return encoder.drain(sink()); }
  VideoEncoder::Sink sink() {
    return [this](AVPacket& packet) { return write(packet); };
  }
  Result<void> write(AVPacket& packet);

  VideoEncoder encoder;
  AVFormatContext* muxer = nullptr;
  AVStream* stream = nullptr;
  TrackTotals totals;
};

Result<void> Track::open(AVFormatContext& film, const VideoEncoder::Settings& settings, const char* title) {
  muxer = &film;
  if (auto opened = encoder.open(settings, (film.oformat->flags & AVFMT_GLOBALHEADER) != 0); !opened) return opened;
  stream = avformat_new_stream(&film, nullptr);
  if (stream == nullptr || avcodec_parameters_from_context(stream->codecpar, &encoder.context()) < 0) {
    return fail(ErrorCode::Exhausted, "out of memory for a track", ENOMEM);
  }
  stream->time_base = encoder.context().time_base;
  stream->avg_frame_rate = encoder.context().framerate;
  stream->sample_aspect_ratio = encoder.context().sample_aspect_ratio;
  setTag(&stream->metadata, "title", title);
  setTag(&stream->metadata, "handler_name", title);
  return {};
}

Result<void> Track::encode(const VideoEncoder::Planes& planes, MediaTime time, bool key) {
  if (auto encoded = encoder.encode(planes, time, key, sink()); !encoded) return encoded;
  if (totals.frames == 0) totals.first = time;
  totals.last = time;
  ++totals.frames;
  return {};
}

Result<void> Track::write(AVPacket& packet) {
  totals.bytes += static_cast<std::uint64_t>(packet.size);
  packet.stream_index = stream->index;
  av_packet_rescale_ts(&packet, VideoEncoder::kTimeBase, stream->time_base);
  const int code = av_interleaved_write_frame(muxer, &packet);
  if (code < 0) return fail(ErrorCode::Io, kCannotWrite, osErrorOf(code));
  return {};
}

}  // namespace

struct FilmWriter::Impl {
  Result<void> begin(const std::string& path, const FilmFormat& format, Existing existing);
  Result<void> openTracks(const FilmFormat& format);
  Result<void> openMaterial(const FilmFormat& format);
  [[nodiscard]] VideoEncoder::Planes depthPlanes(const DepthPicture& picture);

  FilmKind kind = FilmKind::Matroska;
  std::unique_ptr<FilmPlace> place;
  std::unique_ptr<KeptTracks> kept;
  Track color, depth, material;
  DepthCoding coding;
  std::vector<std::uint8_t> bytes;    // of an 8-bit depth picture
  std::vector<std::uint16_t> chroma;  // of a depth picture with flat chroma
};

Result<void> FilmWriter::Impl::begin(const std::string& path, const FilmFormat& format, Existing existing) {
  const auto known = filmKindOf(path);
  if (!known) return fail(ErrorCode::InvalidArgument, kUnknownKind);
  if (!holds(*known, format.depth.codec)) return fail(ErrorCode::InvalidArgument, kNotHeld);
  kind = *known;
  coding = format.depth;
  auto made = FilmPlace::create(path, kind, existing);
  if (!made) return std::unexpected(made.error());
  place = std::move(*made);
  if (auto opened = openTracks(format); !opened) return opened;
  if (format.material_width > 0) {
    if (auto opened = openMaterial(format); !opened) return opened;
  }
  if (kind == FilmKind::Live) place->muxer().max_interleave_delta = kLongestHeldUs;
  if (kept) {
    if (auto added = kept->addTo(place->muxer(), kind); !added) return added;
  }
  return place->begin();
}

Result<void> FilmWriter::Impl::openTracks(const FilmFormat& format) {
  AVFormatContext& muxer = place->muxer();
  const bool live = kind == FilmKind::Live;
  auto opened = color.open(muxer,
                           {.width = format.color_width,
                            .height = format.color_height,
                            .live = live,
                            .range = format.color_range,
                            .matrix = format.color_matrix,
                            .primaries = format.color_primaries,
                            .transfer = format.color_transfer,
                            .sample_aspect = format.color_aspect,
                            .frame_period = format.frame_period,
                            .crf = format.color_crf},
                           "color");
  if (!opened) return opened;
  std::string lines;
  for (const auto& [key, value] : format.depth_tags) lines.append(key).append("=").append(value).append("\n");
  opened = depth.open(muxer,
                      {.codec = coding.codec,
                       .width = format.depth_width,
                       .height = format.depth_height,
                       .bits = coding.bits,
                       .gray = !coding.flat_chroma,
                       .to_touch = true,
                       .live = live,
                       .range = ColorRange::Full,
                       .sample_aspect = format.depth_aspect,
                       .frame_period = format.frame_period,
                       .crf = coding.crf,
                       .stream_tags = lines},
                      "depth");
  if (!opened) return opened;
  color.stream->disposition = AV_DISPOSITION_DEFAULT;
  const bool of_file = kind == FilmKind::Mp4 || kind == FilmKind::Mov;
  AVDictionary** const where = of_file ? &muxer.metadata : &depth.stream->metadata;
  for (const auto& [key, value] : format.depth_tags) setTag(where, key, value);
  // Apple's players need the parameter sets in the container only.
  const bool mp4 = of_file || kind == FilmKind::Hls;
  if (mp4 && coding.codec == VideoCodec::Hevc) depth.stream->codecpar->codec_tag = MKTAG('h', 'v', 'c', '1');
  return {};
}

Result<void> FilmWriter::Impl::openMaterial(const FilmFormat& format) {
  AVFormatContext& muxer = place->muxer();
  const std::string line = std::string(kMaterialScaleTag) + "=" + format.material_scale + "\n";
  auto opened = material.open(muxer,
                              {.width = format.material_width,
                               .height = format.material_height,
                               .to_touch = true,
                               .live = kind == FilmKind::Live,
                               .range = ColorRange::Full,
                               .frame_period = format.frame_period,
                               .crf = format.material_crf,
                               .stream_tags = line},
                              "material");
  if (!opened) return opened;
  const bool of_file = kind == FilmKind::Mp4 || kind == FilmKind::Mov;
  setTag(of_file ? &muxer.metadata : &material.stream->metadata, kMaterialScaleTag, format.material_scale);
  return {};
}

VideoEncoder::Planes FilmWriter::Impl::depthPlanes(const DepthPicture& picture) {
  const std::uint8_t* luma = reinterpret_cast<const std::uint8_t*>(picture.codes.data());
  if (coding.bits == 8) {
    bytes.resize(picture.codes.size());
    std::transform(picture.codes.begin(), picture.codes.end(), bytes.begin(),
                   [](std::uint16_t code) { return static_cast<std::uint8_t>(code); });
    luma = bytes.data();
  }
  if (!coding.flat_chroma) return {luma, nullptr, nullptr};
  // The middle value, in one byte or two.
  chroma.assign(picture.codes.size() / 4,
                static_cast<std::uint16_t>(coding.bits == 8 ? 0x8080 : 1 << (coding.bits - 1)));
  const auto* const flat = reinterpret_cast<const std::uint8_t*>(chroma.data());
  return {luma, flat, flat};
}

FilmWriter::FilmWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FilmWriter::~FilmWriter() = default;

Result<std::unique_ptr<FilmWriter>> FilmWriter::create(const std::string& path, const FilmFormat& format,
                                                       Existing existing, std::unique_ptr<KeptTracks> kept) {
  av_log_set_level(AV_LOG_QUIET);  // the program prints its own error line
  auto impl = std::make_unique<Impl>();
  impl->kept = std::move(kept);
  if (auto begun = impl->begin(path, format, existing); !begun) return std::unexpected(begun.error());
  return std::unique_ptr<FilmWriter>(new FilmWriter(std::move(impl)));
}

Result<void> FilmWriter::writeColor(const ColorPicture420& picture, MediaTime time, bool key) {
  if (auto coded = impl_->color.encode({picture.y.data(), picture.u.data(), picture.v.data()}, time, key); !coded) {
    return coded;
  }
  return impl_->kept ? impl_->kept->writeUntil(time) : Result<void>{};
}

Result<void> FilmWriter::writeDepth(const DepthPicture& picture, MediaTime time, bool key) {
  return impl_->depth.encode(impl_->depthPlanes(picture), time, key);
}

Result<void> FilmWriter::writeMaterial(const ColorPicture420& picture, MediaTime time, bool key) {
  return impl_->material.encode({picture.y.data(), picture.u.data(), picture.v.data()}, time, key);
}

Result<FilmTotals> FilmWriter::finish() {
  Impl& film = *impl_;
  if (auto drained = film.color.drain(); !drained) return std::unexpected(drained.error());
  if (auto drained = film.depth.drain(); !drained) return std::unexpected(drained.error());
  if (film.material.stream != nullptr) {
    if (auto drained = film.material.drain(); !drained) return std::unexpected(drained.error());
  }
  if (film.kept) {
    if (auto written = film.kept->writeRest(); !written) return std::unexpected(written.error());
  }
  const auto bytes = film.place->finish();
  if (!bytes) return std::unexpected(bytes.error());
  return FilmTotals{film.color.totals, film.depth.totals, film.material.totals, *bytes, film.place->latest()};
}

const KeptTracks* FilmWriter::kept() const noexcept {
  return impl_->kept.get();
}

}  // namespace relievo
