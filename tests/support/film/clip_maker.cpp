// SPDX-License-Identifier: Apache-2.0
// Encoders and a muxer of FFmpeg's libraries, fed by functions.
#include "tests/support/film/clip_maker.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "tests/support/film/clip_encoder.h"

extern "C" {
#include <libavutil/display.h>
#include <libavutil/pixdesc.h>
}

namespace relievo::test {
namespace {

constexpr AVRational kTimeBase{1, 90000};  // whole ticks for 24, 25, 30, 60 and 30000/1001 frames a second

struct Dictionary {
  explicit Dictionary(const std::map<std::string, std::string>& entries) {
    for (const auto& [key, value] : entries) av_dict_set(&dictionary, key.c_str(), value.c_str(), 0);
  }
  ~Dictionary() { av_dict_free(&dictionary); }
  Dictionary(const Dictionary&) = delete;
  Dictionary& operator=(const Dictionary&) = delete;
  AVDictionary* dictionary = nullptr;
};

std::uint32_t movingSlope(int component, int column, int row, int frame) {
  return static_cast<std::uint32_t>(16 + column * 3 + row * 2 + frame * 5 + component * 40);
}

std::int32_t* newDisplayMatrix(AVStream& stream) {
  constexpr std::size_t kBytes = 9 * sizeof(std::int32_t);
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(60, 15, 100)  // FFmpeg 6.1
  AVCodecParameters& parameters = *stream.codecpar;
  AVPacketSideData* const data = av_packet_side_data_new(&parameters.coded_side_data, &parameters.nb_coded_side_data,
                                                         AV_PKT_DATA_DISPLAYMATRIX, kBytes, 0);
  return data == nullptr ? nullptr : reinterpret_cast<std::int32_t*>(data->data);
#else
  return reinterpret_cast<std::int32_t*>(av_stream_new_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, kBytes));
#endif
}

// Pictures on their way into the file.
class PictureEncoder final : public Encoder {
 public:
  PictureEncoder(AVFormatContext& file, const ClipTrack& track) : file_(file), track_(track) {
    const AVCodec* const codec = avcodec_find_encoder_by_name(track.codec.c_str());
    if (codec == nullptr) give_up("no encoder " + track.codec);
    context_.reset(avcodec_alloc_context3(codec));
    context_->width = track.width;
    context_->height = track.height;
    context_->pix_fmt = av_get_pix_fmt(track.pix_fmt.c_str());
    context_->time_base = kTimeBase;
    context_->framerate = {track.fps_num, track.fps_den};
    context_->gop_size = track.gop;
    context_->max_b_frames = track.b_frames;
    context_->strict_std_compliance = FF_COMPLIANCE_EXPERIMENTAL;
    context_->thread_count = 1;
    if (track.sample_height > 0) context_->sample_aspect_ratio = {track.sample_width, track.sample_height};
    if (track.range == ColorRange::Full) context_->color_range = AVCOL_RANGE_JPEG;
    if (track.range == ColorRange::Limited) context_->color_range = AVCOL_RANGE_MPEG;
    context_->color_primaries = static_cast<AVColorPrimaries>(track.primaries);
    context_->color_trc = static_cast<AVColorTransferCharacteristic>(track.transfer);
    if ((file.oformat->flags & AVFMT_GLOBALHEADER) != 0) context_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    auto options = track.options;
    if (track.codec == "libx264") options.insert({{"preset", "veryfast"}, {"sc_threshold", "0"}});
    Dictionary words(options);
    check(avcodec_open2(context_.get(), codec, &words.dictionary), "encoder " + track.codec + " with " + track.pix_fmt);

    stream_ = avformat_new_stream(&file, nullptr);
    stream_->time_base = kTimeBase;
    stream_->avg_frame_rate = context_->framerate;
    stream_->sample_aspect_ratio = context_->sample_aspect_ratio;
    if (track.cover) stream_->disposition |= AV_DISPOSITION_ATTACHED_PIC;
    check(avcodec_parameters_from_context(stream_->codecpar, context_.get()), "parameters");
    if (track.rotation) av_display_rotation_set(newDisplayMatrix(*stream_), *track.rotation);
    Dictionary tags(track.tags);
    std::swap(stream_->metadata, tags.dictionary);
    packet_.reset(av_packet_alloc());
    skipLeftOut();
  }

  [[nodiscard]] bool done() const override { return frame_ >= track_.frames; }
  [[nodiscard]] Duration nextTime() const override { return *timeOf(frame_); }

  void encodeNext() override {
    Owned<AVFrame> picture(av_frame_alloc());
    picture->format = context_->pix_fmt;
    picture->width = track_.width;
    picture->height = track_.height;
    picture->color_range = context_->color_range;
    picture->pts = av_rescale_q(nextTime().count(), kNanosecond, kTimeBase);
    check(av_frame_get_buffer(picture.get(), 0), "picture");
    fill(*picture);
    check(avcodec_send_frame(context_.get(), picture.get()), "encode");
    write();
    ++frame_;
    skipLeftOut();
  }

  void finish() override {
    check(avcodec_send_frame(context_.get(), nullptr), "flush");
    write();
  }

 private:
  [[nodiscard]] std::optional<Duration> timeOf(int frame) const {
    if (track_.time) return track_.time(frame);
    return track_.start + Duration(av_rescale(frame, std::int64_t{1'000'000'000} * track_.fps_den, track_.fps_num));
  }
  void skipLeftOut() {
    while (!done() && !timeOf(frame_)) ++frame_;
  }

  void fill(AVFrame& picture) const {
    const AVPixFmtDescriptor& format = *av_pix_fmt_desc_get(context_->pix_fmt);
    const auto& sample = track_.sample ? track_.sample : movingSlope;
    for (int i = 0; i < format.nb_components; ++i) {
      const AVComponentDescriptor& c = format.comp[i];
      const bool chroma = (format.flags & AV_PIX_FMT_FLAG_RGB) == 0 && (i == 1 || i == 2);
      const int columns = chroma ? AV_CEIL_RSHIFT(track_.width, format.log2_chroma_w) : track_.width;
      const int rows = chroma ? AV_CEIL_RSHIFT(track_.height, format.log2_chroma_h) : track_.height;
      for (int row = 0; row < rows; ++row) {
        std::uint8_t* out = picture.data[c.plane] + row * picture.linesize[c.plane] + c.offset;
        for (int column = 0; column < columns; ++column, out += c.step) {
          const std::uint32_t code = (sample(i, column, row, frame_) & ((1u << c.depth) - 1)) << c.shift;
          put(out, code, c.depth > 8, (format.flags & AV_PIX_FMT_FLAG_BE) != 0);
        }
      }
    }
  }

  static void put(std::uint8_t* out, std::uint32_t code, bool two_bytes, bool big_endian) {
    const auto low = static_cast<std::uint8_t>(code & 0xff);
    const auto high = static_cast<std::uint8_t>(code >> 8);
    if (!two_bytes) {
      out[0] = low;
      return;
    }
    out[big_endian ? 1 : 0] = low;
    out[big_endian ? 0 : 1] = high;
  }

  void write() {
    while (avcodec_receive_packet(context_.get(), packet_.get()) >= 0) {
      if (packet_->duration == 0) packet_->duration = av_rescale_q(1, av_inv_q(context_->framerate), kTimeBase);
      av_packet_rescale_ts(packet_.get(), kTimeBase, stream_->time_base);
      packet_->stream_index = stream_->index;
      check(av_interleaved_write_frame(&file_, packet_.get()), "write");
    }
  }

  AVFormatContext& file_;
  ClipTrack track_;
  Owned<AVCodecContext> context_;
  AVStream* stream_ = nullptr;
  Owned<AVPacket> packet_;
  int frame_ = 0;
};

Owned<AVFormatContext> openFile(const std::string& path) {
  AVFormatContext* context = nullptr;
  check(avformat_alloc_output_context2(&context, nullptr, nullptr, path.c_str()), "format of " + path);
  Owned<AVFormatContext> file(context);
  if ((file->oformat->flags & AVFMT_NOFILE) == 0) {
    check(avio_open(&file->pb, path.c_str(), AVIO_FLAG_WRITE), "open " + path);
  }
  return file;
}

}  // namespace

void makeClip(const std::string& path, const std::vector<ClipTrack>& tracks,
              const std::map<std::string, std::string>& tags, const std::vector<ClipSound>& sounds) {
  av_log_set_level(AV_LOG_QUIET);
  const Owned<AVFormatContext> file = openFile(path);
  Dictionary words(tags);
  std::swap(file->metadata, words.dictionary);
  std::vector<std::unique_ptr<Encoder>> encoders;
  for (const ClipTrack& track : tracks) encoders.push_back(std::make_unique<PictureEncoder>(*file, track));
  for (const ClipSound& sound : sounds) encoders.push_back(makeSoundEncoder(*file, sound));

  // One picture without a number in its name; tags of one's own in MP4 (which then has no place for a cover).
  std::map<std::string, std::string> words_of_format{{"update", path.find('%') == std::string::npos ? "1" : "0"}};
  if (!tags.empty()) words_of_format["movflags"] = "+use_metadata_tags";
  Dictionary options(words_of_format);
  check(avformat_write_header(file.get(), &options.dictionary), "header");
  for (;;) {
    Encoder* first = nullptr;
    for (const auto& encoder : encoders) {
      if (!encoder->done() && (first == nullptr || encoder->nextTime() < first->nextTime())) first = encoder.get();
    }
    if (first == nullptr) break;
    first->encodeNext();
  }
  for (const auto& encoder : encoders) encoder->finish();
  check(av_write_trailer(file.get()), "trailer");
}

std::uint32_t sampleAt(const Frame& frame, int component, int column, int row) noexcept {
  const Component& c = frame.components[static_cast<std::size_t>(component)];
  const Plane& plane = frame.planes[c.plane];
  const std::uint8_t* const p = plane.data + row * plane.stride_bytes + c.offset_bytes + column * c.step_bytes;
  const std::uint32_t word = c.bits > 8 ? p[0] | std::uint32_t{p[1]} << 8 : p[0];
  return (word >> c.shift) & ((1u << c.bits) - 1);
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "relievo-test-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace relievo::test
