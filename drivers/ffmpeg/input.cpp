// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/input.h"

#include <fcntl.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/ffmpeg/container.h"
#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/local_file.h"
#include "drivers/ffmpeg/network_error.h"
#include "drivers/ffmpeg/opening/later_parts.h"
#include "drivers/ffmpeg/opening/lists.h"
#include "drivers/ffmpeg/opening/part_languages.h"
#include "drivers/ffmpeg/pictures/photo_size.h"
#include "drivers/ffmpeg/refusal.h"
#include "platform/log.h"
#include "platform/told_count.h"

namespace relievo::ffmpeg {
namespace {

constexpr std::int64_t kAllBytes = std::numeric_limits<std::int64_t>::max();
constexpr int kMostOpens = 200;  // files and addresses that a container opens at once
constexpr Error kIndexBehind{
    ErrorCode::Unsupported, 0,
    "its index is at its end, and a pipe, or a server that gives only whole files, cannot go back to its pictures; "
    "save it to a file, or write it with its index first: ffmpeg -i FILE -map 0 -c copy -movflags +faststart film.mp4"};
constexpr Error kNoParts{ErrorCode::NotFound, 0,
                         "it is a list, and none of its parts can be opened; get them, or the whole film in one file"};

// FFmpeg decodes pictures to analyse a stream: it must skip those that are too large for the decoder.
int findStreams(AVFormatContext& context) {
  std::vector<AVDictionary*> options(context.nb_streams, nullptr);
  const bool photo = isOfPhotos(*context.iformat);
  for (std::size_t i = 0; i < options.size(); ++i) {
    av_dict_set_int(&options[i], "max_pixels", mostSamples(context.streams[i]->codecpar->codec_id, photo), 0);
  }
  const int found = avformat_find_stream_info(&context, options.empty() ? nullptr : options.data());
  for (AVDictionary*& of_stream : options) av_dict_free(&of_stream);
  return found;
}

// Whether the pictures of an MP4 or QuickTime film that cannot be sought lie before all that is still held of it.
bool hasPassedPictures(const AVFormatContext& context) {
  AVIOContext* const in = context.pb;
  if (in == nullptr || (in->seekable & AVIO_SEEKABLE_NORMAL) != 0) return false;
  if (!std::string_view(context.iformat->name).starts_with("mov")) return false;
  const std::int64_t held = avio_tell(in) - (in->buf_ptr - in->buffer);
  return std::ranges::any_of(std::span(context.streams, context.nb_streams), [held](AVStream* stream) {
    const AVIndexEntry* const first = avformat_index_get_entry(stream, 0);
    return first != nullptr && first->pos < held;
  });
}

// A list that another list names is no part of the film.
bool namesList(std::string_view url) noexcept {
  url = url.substr(0, url.find_first_of("?#"));
  return url.ends_with(".m3u8") || url.ends_with(".m3u");
}

// FFmpeg passes over a part that a busy server refuses. So it is asked for again, at once and after a second.
void askBusyServerAgain(AVDictionary*& options) {
  av_dict_set(&options, "reconnect_on_http_error", "5xx", 0);
  av_dict_set(&options, "reconnect_delay_max", "1", AV_DICT_DONT_OVERWRITE);
}

// FFmpeg does not close what was opened here.
bool isOpenedHere(const AVIOContext* file) noexcept {
  return isLocalFile(file) || isLaterParts(file);
}

void closeOpenedHere(AVIOContext* file) noexcept {
  if (isLocalFile(file)) closeLocalFile(file);
  else if (isLaterParts(file)) closeLaterParts(file);
}

}  // namespace

void FormatCloser::operator()(AVFormatContext* context) const noexcept {
  AVIOContext* const file = isOpenedHere(context->pb) ? context->pb : nullptr;
  avformat_close_input(&context);
  closeOpenedHere(file);
  user.reset();
}

Result<Input::Opened> Input::open(const std::string& url, Duration parts_from) {
  watch_.begin(kOpenPatience);
  parts_from_ = parts_from;
  auto address = parseAddress(url);
  if (!address) return std::unexpected(address.error());
  const Error late = lateOpening(address->way);
  watch_.begin(kOpenPatience, late);
  if (address->way == Way::Pipe) {
    if (auto piped = openPipe(*address); !piped) return std::unexpected(piped.error());
  }
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) return std::unexpected(openError(AVERROR(ENOMEM)));
  context->interrupt_callback = {Watch::callback, &watch_};
  context->opaque = this;
  open_file_ = std::exchange(context->io_open, openCounted);
  close_file_ = std::exchange(context->io_close2, closeAny);
  url_ = url;
  AVIOContext* file = nullptr;
  if (const auto opened = openFile(*address, file); !opened) {
    avformat_free_context(context);
    return std::unexpected(watch_.explain(opened.error()));
  }
  if (file != nullptr && parts_from > Duration(0) && shorten(context, file) < 0) {
    avformat_free_context(context);
    return std::unexpected(openError(AVERROR(ENOMEM)));
  }
  context->pb = file;
  AVDictionary* options = optionsFor(*address);
  // FFmpeg would ask for the next list on the connection of one that was read here.
  if (parts_from > Duration(0)) av_dict_set(&options, "http_persistent", "0", 0);
  LibraryWords words;
  const int opened = avformat_open_input(&context, address->url.c_str(), nullptr, &options);
  av_dict_free(&options);
  if (opened < 0) closeOpenedHere(file == nullptr ? first_list_ : file);
  if (opened < 0) {
    noteLost();
    if (lost_ > 0 && !watch_.cancelled()) tellLost(first_lost_);
    const bool no_part = lost_ > 0 && !any_part_;
    return std::unexpected(watch_.explain(no_part ? kNoParts : refusal(*address, opened, words.last())));
  }
  const MonotonicTime arrival = watch_.now();
  opened_ = true;
  if (lost_ > 0) tellLost(first_lost_);

  FormatPtr owned(context);
  // A list of which no part came is no failure to FFmpeg.
  if (owned->nb_streams == 0 && (watch_.givesUp() || (is_list_ && !any_part_)))
    return std::unexpected(watch_.explain(kNoParts));
  if (hasPassedPictures(*owned)) return std::unexpected(kIndexBehind);
  if (!reads_files_) watch_.begin(kOpenPatience, late);
  words.listenTo(*context);
  const int found = findStreams(*context);
  const bool gave_up = reads_files_ ? watch_.givesUp() : watch_.cancelled();  // a slow stream may be known enough
  if (words.containerWarned()) doubtful_until_ = context->pb == nullptr ? kAllBytes : avio_tell(context->pb);
  if (found < 0 || gave_up) return std::unexpected(watch_.explain(refusal(*address, found, words.last())));
  readLanguages(*owned);
  if (isTextArt(*context)) return std::unexpected(refusal(*address, AVERROR_INVALIDDATA, {}));
  return Opened{.container = std::move(owned), .address = std::move(*address), .arrival = arrival};
}

int Input::readFrame(AVFormatContext& container, AVPacket& packet) {
  LibraryWords words;
  words.listenTo(container);
  const int got = av_read_frame(&container, &packet);
  if (got == AVERROR_EOF) noteLost();
  doubtful_ = words.containerWarned() || (got < 0 ? doubtful_ : isUnsure(packet.pos));
  if (got >= 0 && doubtful_) packet.opaque = this;
  return got;
}

// Packets without a place are as sure as those beside them.
bool Input::isUnsure(std::int64_t place) const noexcept {
  return doubtful_until_ == kAllBytes || (place >= 0 && place < doubtful_until_);
}

Doubt Input::doubtOf(const AVPacket& packet, const AVStream& stream) const noexcept {
  const bool broken = (packet.flags & AV_PKT_FLAG_CORRUPT) != 0;
  if (broken || packet.opaque != nullptr) return Doubt::Damaged;
  const bool steady = stream.avg_frame_rate.num > 0 && av_cmp_q(stream.avg_frame_rate, stream.r_frame_rate) == 0;
  return steady && kindOf(stream) == StreamKind::Video ? Doubt::Steady : Doubt::None;
}

// `file` stays null for sources that FFmpeg opens itself: remote ones, and names that are patterns.
Result<void> Input::openFile(const Address& address, AVIOContext*& file) {
  reads_files_ = address.way == Way::File;
  if (!reads_files_) return {};
  const std::string path = localPathOf(address.url);
  if (const auto unread = unreadFormat(path)) return std::unexpected(*unread);
  const auto opened = openLocalFile(path, watch_);
  if (opened) file = *opened;
  if (opened || opened.error().code == ErrorCode::NotFound) return {};
  const Error& error = opened.error();
  return std::unexpected(error.os_error == 0 ? error : openError(AVERROR(error.os_error)));
}

// Bounds the opens of a playlist that names itself, or of endlessly nested lists.
int Input::openCounted(AVFormatContext* context, AVIOContext** file, const char* url, int flags,
                       AVDictionary** options) {
  auto& self = *static_cast<Input*>(context->opaque);
  if (++self.opens_ > kMostOpens) return AVERROR(ELOOP);
  self.is_list_ = self.is_list_ || self.url_ != url;
  if (self.missing_ != url) self.noteLost();
  int opened = self.openAny(context, file, url, flags, options);
  if (opened >= 0 && !self.opened_ && self.url_ != url && self.first_part_.empty() && isEmptyList(**file)) {
    static_cast<void>(closeAny(context, std::exchange(*file, nullptr)));
    if (self.parts_from_ == Duration(0))  // not again for a seek
      log(LogLevel::Warning, "media", "%s: its list %s has no parts and is left out", self.url_.c_str(), url);
    return AVERROR_INVALIDDATA;
  }
  const bool early = opened >= 0 && self.url_ != url && self.first_part_.empty();  // lists come before parts
  const bool is_list = namesList(url) || (early && isList(**file));
  if (opened >= 0 && self.parts_from_ > Duration(0) && (is_list || self.url_ == url)) {
    opened = self.shorten(context, *file);
    if (file == &context->pb) {  // FFmpeg would take it for its own
      context->flags |= AVFMT_FLAG_CUSTOM_IO;
      self.first_list_ = *file;
    }
  }
  if (opened >= 0) {
    if (early && !is_list) self.first_part_ = url;
    self.any_part_ = self.any_part_ || (self.url_ != url && !is_list);
    self.in_gap_ = false;
    self.missing_.clear();
  } else if (!self.watch_.cancelled() && self.url_ != url) self.missing_ = url;
  return opened;
}

int Input::openAny(AVFormatContext* context, AVIOContext** file, const char* url, int flags, AVDictionary** options) {
  const std::string path = reads_files_ ? localPathOf(url) : "";
  if (path.empty()) {
    if (options != nullptr) askBusyServerAgain(*options);
    for (const auto& [name, value] : of_lists_) {
      if (options != nullptr) av_dict_set(options, name.c_str(), value.c_str(), AV_DICT_DONT_OVERWRITE);
    }
    return open_file_(context, file, url, flags, options);
  }
  const auto opened = openLocalFile(path, watch_);
  if (opened) *file = *opened;
  return opened ? 0 : codeOf(opened.error());
}

// FFmpeg skips segments of a list that it cannot open. One that it has asked for ahead it asks for again in time, so a
// missing part is lost when FFmpeg goes on to another or to the end.
void Input::noteLost() {
  if (missing_.empty()) return;
  const std::string part = std::exchange(missing_, {});
  if (any_part_ && !in_gap_) ++losses_;  // before the first part there is no gap
  in_gap_ = true;
  ++lost_;
  if (lost_ == 1) first_lost_ = part;
  if (opened_ && isTold(lost_)) tellLost(part);
}

void Input::tellLost(const std::string& part) const {
  if (lost_ == 1)
    log(LogLevel::Warning, "media", "%s: its part %s cannot be opened and is left out", url_.c_str(), part.c_str());
  else
    log(LogLevel::Warning, "media", "%s: %u of its parts, such as %s, cannot be opened and are left out", url_.c_str(),
        lost_, part.c_str());
}

// FFmpeg takes from its own context where the list is, and what the next requests need.
int Input::shorten(AVFormatContext* context, AVIOContext*& list) {
  for (const char* const name : {"cookies", "rw_timeout", "user_agent"}) {
    if (auto value = isOpenedHere(list) ? "" : optionOf(*list, name); !value.empty()) of_lists_[name] = value;
  }
  AVIOContext* const later = openLaterParts(*list, parts_from_, isOpenedHere(list) ? "" : optionOf(*list, "location"));
  static_cast<void>(closeAny(context, std::exchange(list, later)));
  return later == nullptr ? AVERROR(ENOMEM) : 0;
}

void Input::readLanguages(AVFormatContext& list) {
  if (first_part_.empty() || parts_from_ > Duration(0) || !lacksLanguages(list)) return;
  AVIOContext* part = nullptr;
  if (openAny(&list, &part, first_part_.c_str(), AVIO_FLAG_READ, nullptr) < 0) return;
  takeLanguages(list, *part);
  static_cast<void>(closeAny(&list, part));
}

int Input::closeAny(AVFormatContext* context, AVIOContext* file) {
  if (!isOpenedHere(file)) return static_cast<Input*>(context->opaque)->close_file_(context, file);
  closeOpenedHere(file);
  return 0;
}

// Without blocking: a blocking open(2) waits for the writer and could not be interrupted.
Result<void> Input::openPipe(Address& address) {
  pipe_.reset(::open(address.url.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!pipe_.valid()) return std::unexpected(openError(AVERROR(errno)));
  pollfd wait{.fd = pipe_.get(), .events = POLLIN, .revents = 0};
  while (::poll(&wait, 1, 50) <= 0) {
    if (watch_.givesUp()) return std::unexpected(watch_.explain({}));
  }
  address.url = "pipe:" + std::to_string(pipe_.get());
  return {};
}

}  // namespace relievo::ffmpeg
