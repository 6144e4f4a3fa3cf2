// SPDX-License-Identifier: Apache-2.0
// Two or three encoders, each on a thread of its own, and the destination of their packets.
#include "app/author/package/film_writer.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

extern "C" {
#include <libavutil/log.h>
}

#include "app/author/package/place/film_place.h"
#include "app/author/package/work_line.h"
#include "app/scene/material.h"

namespace relievo {
namespace {

constexpr std::int64_t kLongestHeldUs = 500'000;  // for so long pictures of a live film wait for a subtitle

void setTag(AVDictionary** tags, const std::string& key, const std::string& value) {
  av_dict_set(tags, key.c_str(), value.c_str(), 0);
}

// One track of the film. Its thread encodes pictures that are its own.
struct Track {
  using Line = WorkLine<Result<void>>;
  struct Picture {
    ColorPicture420 color;
    std::vector<std::uint8_t> depth;  // samples of one byte or two
    VideoEncoder::Planes planes{};
    MediaTime time;
    bool key = false;
  };

  Result<void> open(FilmPlace& place, const VideoEncoder::Settings& settings, const char* title);
  // What the next picture is to be written to.
  Picture& next() { return pictures[added % pictures.size()]; }
  // Hands that picture over.
  Result<void> add(MediaTime time, bool key) {
    Picture& picture = next();
    ++added;
    picture.time = time;
    picture.key = key;
    return line.add([this, &picture] { return encode(picture); });
  }
  Result<void> finish() {
    if (auto added_all = line.finish(); !added_all) return added_all;
    if (auto drained = encoder.drain(sink()); !drained) return drained;
    return check != nullptr ? check->decode(nullptr) : Result<void>{};
  }

  Result<void> encode(const Picture& picture);
  VideoEncoder::Sink sink() {
    return [this](AVPacket& packet) { return write(packet); };
  }
  Result<void> write(AVPacket& packet);

  VideoEncoder encoder;
  FilmPlace* film = nullptr;
  AVStream* stream = nullptr;
  TrackTotals totals;
  DepthCheck* check = nullptr;
  std::size_t added = 0;
  std::array<Picture, Line::kBuffers> pictures;
  Line line;  // the last member: it ends before what it uses
};

Result<void> Track::open(FilmPlace& place, const VideoEncoder::Settings& settings, const char* title) {
  film = &place;
  AVFormatContext& muxer = place.muxer();
  if (auto opened = encoder.open(settings, (muxer.oformat->flags & AVFMT_GLOBALHEADER) != 0); !opened) return opened;
  stream = avformat_new_stream(&muxer, nullptr);
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

Result<void> Track::encode(const Picture& picture) {
  if (auto encoded = encoder.encode(picture.planes, picture.time, picture.key, sink()); !encoded) return encoded;
  if (totals.frames == 0) totals.first = picture.time;
  totals.last = picture.time;
  ++totals.frames;
  return {};
}

Result<void> Track::write(AVPacket& packet) {
  totals.bytes += static_cast<std::uint64_t>(packet.size);
  if (check != nullptr) {
    if (auto decoded = check->decode(&packet); !decoded) return decoded;
  }
  packet.stream_index = stream->index;
  av_packet_rescale_ts(&packet, VideoEncoder::kTimeBase, stream->time_base);
  return film->write(packet);
}

}  // namespace

struct FilmWriter::Impl {
  Result<void> begin(const std::string& path, const FilmFormat& format, Existing existing);
  Result<void> openTracks(const FilmFormat& format);
  Result<void> openMaterial(const FilmFormat& format);
  void copy(const DepthPicture& from, Track::Picture& to);

  FilmKind kind = FilmKind::Matroska;
  std::unique_ptr<FilmPlace> place;
  std::unique_ptr<KeptTracks> kept;
  DepthCoding coding;
  std::vector<std::uint16_t> chroma;  // of a depth picture with flat chroma
  Track color, depth, material;
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
    if (auto added = kept->addTo(*place, kind); !added) return added;
  }
  return place->begin();
}

Result<void> FilmWriter::Impl::openTracks(const FilmFormat& format) {
  AVFormatContext& muxer = place->muxer();
  const bool live = kind == FilmKind::Live;
  auto opened = color.open(*place,
                           {.width = format.color_width,
                            .height = format.color_height,
                            .quick = true,
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
  opened = depth.open(*place,
                      {.codec = coding.codec,
                       .width = format.depth_width,
                       .height = format.depth_height,
                       .bits = coding.bits,
                       .gray = !coding.flat_chroma,
                       .to_touch = true,
                       .quick = true,
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
  const std::string line = std::string(kMaterialScaleTag) + "=" + format.material_scale + "\n";
  auto opened = material.open(*place,
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
  setTag(of_file ? &place->muxer().metadata : &material.stream->metadata, kMaterialScaleTag, format.material_scale);
  return {};
}

Result<void> addColor(const ColorPicture420& picture, Track& track, MediaTime time, bool key) {
  Track::Picture& own = track.next();
  if (&picture != &own.color) own.color = picture;
  own.planes = {own.color.y.data(), own.color.u.data(), own.color.v.data()};
  return track.add(time, key);
}

void FilmWriter::Impl::copy(const DepthPicture& from, Track::Picture& to) {
  const std::size_t count = from.codes.size();
  to.depth.resize(count * (coding.bits == 8 ? 1 : 2));
  if (coding.bits == 8) {
    std::transform(from.codes.begin(), from.codes.end(), to.depth.begin(),
                   [](std::uint16_t code) { return static_cast<std::uint8_t>(code); });
  } else {
    std::memcpy(to.depth.data(), from.codes.data(), to.depth.size());
  }
  to.planes = {to.depth.data(), nullptr, nullptr};
  if (!coding.flat_chroma) return;
  // The middle value, in one byte or two. It never changes, so that the encoder's thread may read it.
  if (chroma.empty()) {
    chroma.assign(count / 4, static_cast<std::uint16_t>(coding.bits == 8 ? 0x8080 : 1 << (coding.bits - 1)));
  }
  to.planes[1] = to.planes[2] = reinterpret_cast<const std::uint8_t*>(chroma.data());
}

FilmWriter::FilmWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FilmWriter::~FilmWriter() = default;

Result<std::unique_ptr<FilmWriter>> FilmWriter::create(const std::string& path, const FilmFormat& format,
                                                       Existing existing, std::unique_ptr<KeptTracks> kept,
                                                       DepthCheck* check) {
  av_log_set_level(AV_LOG_QUIET);  // the program prints its own error line
  auto impl = std::make_unique<Impl>();
  impl->kept = std::move(kept);
  if (auto begun = impl->begin(path, format, existing); !begun) return std::unexpected(begun.error());
  if (check != nullptr) {
    if (auto opened = check->open(impl->depth.encoder.context()); !opened) return std::unexpected(opened.error());
    impl->depth.check = check;
  }
  return std::unique_ptr<FilmWriter>(new FilmWriter(std::move(impl)));
}

ColorPicture420& FilmWriter::nextColor() noexcept {
  return impl_->color.next().color;
}

Result<void> FilmWriter::writeColor(const ColorPicture420& picture, MediaTime time, bool key) {
  if (impl_->kept) {
    if (auto written = impl_->kept->writeUntil(time); !written) return written;
  }
  return addColor(picture, impl_->color, time, key);
}

Result<void> FilmWriter::writeDepth(const DepthPicture& picture, MediaTime time, bool key) {
  impl_->copy(picture, impl_->depth.next());
  return impl_->depth.add(time, key);
}

Result<void> FilmWriter::writeMaterial(const ColorPicture420& picture, MediaTime time, bool key) {
  return addColor(picture, impl_->material, time, key);
}

Result<FilmTotals> FilmWriter::finish(bool whole) {
  Impl& film = *impl_;
  if (auto finished = film.color.finish(); !finished) return std::unexpected(finished.error());
  if (auto finished = film.depth.finish(); !finished) return std::unexpected(finished.error());
  if (film.material.stream != nullptr) {
    if (auto finished = film.material.finish(); !finished) return std::unexpected(finished.error());
  }
  if (film.kept) {
    const auto written = whole ? film.kept->writeRest() : film.kept->writeUntil(film.color.totals.last);
    if (!written) return std::unexpected(written.error());
  }
  const auto bytes = film.place->finish();
  if (!bytes) return std::unexpected(bytes.error());
  return FilmTotals{film.color.totals, film.depth.totals, film.material.totals, *bytes, film.place->latest()};
}

const KeptTracks* FilmWriter::kept() const noexcept {
  return impl_->kept.get();
}

}  // namespace relievo
