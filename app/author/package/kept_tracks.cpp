// SPDX-License-Identifier: Apache-2.0
// A second demuxer on the colour's file, and copies of its streams in the film's muxer.
#include "app/author/package/kept_tracks.h"

#include <strings.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <utility>

#include "app/author/package/held_tracks.h"
#include "app/author/package/place/film_place.h"
#include "platform/files/file_system_answer.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

constexpr AVRational kNanosecond{1, 1'000'000'000};
constexpr Duration kLongestGap = std::chrono::seconds(10);  // the same as for reading files, see ContinuousTime
constexpr Error kNoMemory{ErrorCode::Exhausted, ENOMEM, "out of memory for a track"};

const char* tag(const AVDictionary* tags, const char* key) noexcept {
  const AVDictionaryEntry* const found = av_dict_get(tags, key, nullptr, 0);
  return found == nullptr ? "" : found->value;
}

// "sound aac eng "Commentary"".
std::string describe(const AVStream& stream) {
  std::string text = stream.codecpar->codec_type == AVMEDIA_TYPE_AUDIO        ? "sound "
                     : stream.codecpar->codec_type == AVMEDIA_TYPE_ATTACHMENT ? "font "
                                                                              : "subtitles ";
  if (stream.codecpar->codec_type == AVMEDIA_TYPE_ATTACHMENT) return text + tag(stream.metadata, "filename");
  text += avcodec_get_name(stream.codecpar->codec_id);
  const std::string language = tag(stream.metadata, "language"), title = tag(stream.metadata, "title");
  if (!language.empty() && language != "und") text += " " + language;
  if (!title.empty()) text += " \"" + oneLine(title) + "\"";
  return text;
}

// How text is kept for a film that holds none: the player finds files beside it by its name.
std::string commandFor(const AVStream& stream, const std::string& path) {
  const std::string language = tag(stream.metadata, "language");
  const bool known = !language.empty() && language != "und";
  return ", and so can a file beside the film: ffmpeg -i \"" + path + "\" -map 0:" + std::to_string(stream.index) +
         " FILM" + (known ? "." + language : "") + ".srt";
}

// Leaves out tags that a muxer writes itself, and the source's depth tags: the film has its own.
void copyTags(AVDictionary** to, const AVDictionary* from) {
  constexpr std::array kOwn{"major_brand", "minor_version", "compatible_brands", "encoder", "DURATION"};
  const AVDictionaryEntry* entry = nullptr;
  while ((entry = av_dict_get(from, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr) {
    const bool own = std::ranges::any_of(kOwn, [&](const char* word) { return ::strcasecmp(entry->key, word) == 0; });
    if (own || ::strncasecmp(entry->key, "DEPTH_", 6) == 0) continue;
    av_dict_set(to, entry->key, entry->value, AV_DICT_DONT_OVERWRITE);
  }
}

// Of several programmes only the picture's own.
bool isOfProgramme(AVFormatContext& file, int picture, int stream) {
  const AVProgram* const programme = av_find_program_from_stream(&file, nullptr, picture);
  if (programme == nullptr) return true;
  const std::span<const unsigned> own(programme->stream_index, programme->nb_stream_indexes);
  return std::ranges::find(own, static_cast<unsigned>(stream)) != own.end();
}

}  // namespace

KeptTracks::Opened KeptTracks::openNow(const std::string& path) {
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "file,crypto,data", 0);
  AVFormatContext* file = nullptr;
  const int code = avformat_open_input(&file, ("file:" + path).c_str(), nullptr, &options);
  av_dict_free(&options);
  const Opened opened{std::shared_ptr<AVFormatContext>(file, Close{}), code};
  return code < 0 ? opened : Opened{opened.file, avformat_find_stream_info(file, nullptr)};
}

KeptTracks::Read KeptTracks::readNow(AVFormatContext& file) {
  Read read{.packet = PacketPtr(av_packet_alloc())};
  if (read.packet) read.code = av_read_frame(&file, read.packet.get());
  return read;
}

Result<std::unique_ptr<KeptTracks>> KeptTracks::open(const std::string& file, int picture, Duration start,
                                                     const KeptWishes& wishes) {
  const auto opened = answerOf(file, [file] { return openNow(file); });
  if (!opened) return std::unexpected(opened.error());
  if (opened->code < 0) {
    return fail(ErrorCode::Corrupt, "it cannot be read a second time for its sound", osErrorOf(opened->code));
  }
  auto tracks = std::make_unique<KeptTracks>();
  tracks->path_ = file;
  tracks->file_ = opened->file;
  tracks->picture_ = picture;
  tracks->start_ = start;
  if (tracks->jumps()) tracks->times_.begin(kLongestGap);
  tracks->wishes_ = wishes;
  return tracks;
}

bool KeptTracks::isWished(const AVStream& stream) const noexcept {
  switch (stream.codecpar->codec_type) {
    case AVMEDIA_TYPE_AUDIO:
      return wishes_.sound;
    case AVMEDIA_TYPE_SUBTITLE:
      return wishes_.subtitles;
    case AVMEDIA_TYPE_ATTACHMENT:  // fonts, in Matroska alone
      return wishes_.subtitles && kind_ == FilmKind::Matroska;
    default:
      return false;
  }
}

Result<void> KeptTracks::addTo(FilmPlace& film, FilmKind kind) {
  place_ = &film;
  film_ = &film.muxer();
  kind_ = kind;
  for (unsigned i = 0; i < file_->nb_streams; ++i) {
    AVStream& stream = *file_->streams[i];
    const bool own = isOfProgramme(*file_, picture_, stream.index);
    // Jumps can only be detected over all streams of the programme together.
    stream.discard = jumps() && own ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
    if (!own || !isWished(stream)) continue;
    if (auto added = addStream(stream); !added) return added;
    if (copies_.contains(stream.index)) stream.discard = AVDISCARD_DEFAULT;
  }
  addTitles();
  return addChapters();
}

Result<void> KeptTracks::addStream(const AVStream& stream) {
  const AVCodecID codec = stream.codecpar->codec_id;
  const bool held = stream.codecpar->codec_type == AVMEDIA_TYPE_ATTACHMENT || canHold(*film_, kind_, codec);
  Copy copy;
  if (!held && isTextSubtitle(codec) && textOf(kind_) != AV_CODEC_ID_NONE) {
    auto converter = TextSubtitles::create(*stream.codecpar, stream.time_base, textOf(kind_));
    if (converter) copy.converter = std::move(*converter);
  }
  if (!held && !copy.converter) {
    const bool is_file = kind_ == FilmKind::TransportStream || kind_ == FilmKind::Hls;
    left_out_.push_back(describe(stream) + ": left out, since " + nameOf(kind_) + " cannot hold it" +
                        (kind_ == FilmKind::Matroska ? "" : "; a .mkv can") +
                        (is_file && isTextSubtitle(codec) ? commandFor(stream, path_) : ""));
    return {};
  }
  copy.stream = avformat_new_stream(film_, nullptr);
  if (copy.stream == nullptr || avcodec_parameters_copy(copy.stream->codecpar, stream.codecpar) < 0) {
    return std::unexpected(kNoMemory);
  }
  copy.stream->codecpar->codec_tag = 0;  // the film's container has its own
  if (copy.converter) {
    if (auto described = copy.converter->describe(*copy.stream->codecpar); !described) return described;
  }
  copy.stream->time_base = stream.time_base;
  copy.stream->disposition = stream.disposition;
  copyTags(&copy.stream->metadata, stream.metadata);
  // MP4 has no titles of tracks; players show the handler's name.
  const std::string title = tag(stream.metadata, "title");
  if (isMp4(kind_) && !title.empty()) av_dict_set(&copy.stream->metadata, "handler_name", title.c_str(), 0);
  kept_.push_back(describe(stream) + (copy.converter ? std::string(" as ") + avcodec_get_name(textOf(kind_)) : ""));
  copies_.emplace(stream.index, std::move(copy));
  return {};
}

void KeptTracks::addTitles() {
  copyTags(&film_->metadata, file_->metadata);
  if (const std::string title = tag(file_->metadata, "title"); !title.empty())
    kept_.push_back("title \"" + oneLine(title) + "\"");
}

Result<void> KeptTracks::addChapters() {
  if (file_->nb_chapters == 0) return {};
  const std::string count = std::to_string(file_->nb_chapters) + (file_->nb_chapters == 1 ? " chapter" : " chapters");
  if (isTransport(kind_) || kind_ == FilmKind::Hls) {
    left_out_.push_back(count + ": left out, since " + nameOf(kind_) + " cannot hold them; a .mkv or .mp4 can");
    return {};
  }
  for (unsigned i = 0; i < file_->nb_chapters; ++i) {
    const AVChapter& from = *file_->chapters[i];
    auto* const chapter = static_cast<AVChapter*>(av_mallocz(sizeof(AVChapter)));
    int added = static_cast<int>(film_->nb_chapters);
    if (chapter != nullptr) av_dynarray_add(static_cast<void*>(&film_->chapters), &added, chapter);
    if (chapter == nullptr || film_->chapters == nullptr) return std::unexpected(kNoMemory);
    film_->nb_chapters = static_cast<unsigned>(added);  // the muxer frees them
    const std::int64_t shift = av_rescale_q(start_.count(), kNanosecond, from.time_base);
    chapter->id = from.id;
    chapter->time_base = from.time_base;
    chapter->start = std::max<std::int64_t>(from.start - shift, 0);
    chapter->end = std::max(from.end - shift, chapter->start);
    copyTags(&chapter->metadata, from.metadata);
  }
  kept_.push_back(count);
  return {};
}

// Null at the end. An unreadable rest counts as the end, as it does for the pictures.
Result<KeptTracks::PacketPtr> KeptTracks::next() {
  if (waiting_ || ended_) return std::move(waiting_);
  for (;;) {
    auto read = answerOf(path_, [file = file_] { return readNow(*file); });
    if (!read) return std::unexpected(read.error());
    if (!read->packet) return std::unexpected(kNoMemory);
    if (read->code < 0) {
      ended_ = true;
      return nullptr;
    }
    PacketPtr packet = std::move(read->packet);
    // Opening the file has read packets of other programmes too, whose clocks may be hours away.
    if (packet->size == 0 || file_->streams[packet->stream_index]->discard == AVDISCARD_ALL) continue;
    // What an edit list cuts off is read for the decoder alone. Without edit lists it would be heard before the film.
    const bool cut_off = (packet->flags & AV_PKT_FLAG_DISCARD) != 0;
    if (cut_off && kind_ != FilmKind::Mp4 && kind_ != FilmKind::Mov) continue;
    makeContinuous(*packet);
    if (copies_.contains(packet->stream_index)) return packet;
  }
}

// As the pictures' reader does, so that sound and pictures stay together where a broadcast's times jump.
void KeptTracks::makeContinuous(AVPacket& packet) {
  if (!jumps() || (packet.dts == AV_NOPTS_VALUE && packet.pts == AV_NOPTS_VALUE)) return;
  const Duration offset = times_.offsetFor(packet.stream_index, begins(packet));
  const std::int64_t ticks = av_rescale_q(offset.count(), kNanosecond, file_->streams[packet.stream_index]->time_base);
  if (packet.pts != AV_NOPTS_VALUE) packet.pts += ticks;
  if (packet.dts != AV_NOPTS_VALUE) packet.dts += ticks;
}

MediaTime KeptTracks::begins(const AVPacket& packet) const noexcept {
  const std::int64_t ticks = packet.dts != AV_NOPTS_VALUE ? packet.dts : packet.pts;
  if (ticks == AV_NOPTS_VALUE) return MediaTime{};
  const AVRational base = file_->streams[packet.stream_index]->time_base;
  return MediaTime(Duration(av_rescale_q(ticks, base, kNanosecond)) - start_);
}

Result<void> KeptTracks::writeUntil(MediaTime time) {
  while (!copies_.empty()) {
    auto packet = next();
    if (!packet) return std::unexpected(packet.error());
    const MediaTime now = *packet ? begins(**packet) : MediaTime::max();
    if (auto written = writeTextsBefore(now); !written) return written;
    if (!*packet) return {};
    if (now >= time) {
      waiting_ = std::move(*packet);
      return {};
    }
    if (auto written = write(std::move(*packet)); !written) return written;
  }
  return {};
}

Result<void> KeptTracks::write(PacketPtr packet) {
  Copy& copy = copies_.at(packet->stream_index);
  if (!copy.converter) return put(std::move(packet));
  const bool joins = copy.text && begins(*copy.text) == begins(*packet);
  const auto converted = copy.converter->convert(*packet, joins);
  if (!converted) return std::unexpected(converted.error());
  if (!*converted) return {};
  if (joins) packet->duration = std::max(packet->duration, copy.text->duration);
  copy.text.swap(packet);
  return joins || !packet ? Result<void>{} : put(std::move(packet));
}

Result<void> KeptTracks::writeTextsBefore(MediaTime time) {
  for (auto& [stream, copy] : copies_) {
    if (!copy.text || begins(*copy.text) >= time) continue;
    if (auto written = put(std::move(copy.text)); !written) return written;
  }
  return {};
}

Result<void> KeptTracks::put(PacketPtr packet) {
  Copy& copy = copies_.at(packet->stream_index);
  const AVRational base = file_->streams[packet->stream_index]->time_base;
  const std::int64_t shift = av_rescale_q(start_.count(), kNanosecond, base);
  if (packet->pts != AV_NOPTS_VALUE) packet->pts -= shift;
  if (packet->dts != AV_NOPTS_VALUE) packet->dts -= shift;
  av_packet_rescale_ts(packet.get(), base, copy.stream->time_base);
  const bool strict = (film_->oformat->flags & AVFMT_TS_NONSTRICT) == 0;
  if (packet->dts != AV_NOPTS_VALUE) {
    // In a source whose times jump back, packets are left out until the time before the jump is reached again.
    if (copy.last_dts != AV_NOPTS_VALUE && packet->dts < copy.last_dts) return {};
    copy.last_dts = packet->dts;
    // Packets shorter than a millisecond, as TrueHD's, may have the same time in Matroska.
    if (copy.least_dts != AV_NOPTS_VALUE) packet->dts = std::max(packet->dts, copy.least_dts);
    if (packet->pts != AV_NOPTS_VALUE) packet->pts = std::max(packet->pts, packet->dts);
    copy.least_dts = packet->dts + (strict ? 1 : 0);
  }
  packet->stream_index = copy.stream->index;
  packet->pos = -1;
  return place_->write(*packet);
}

}  // namespace relievo
