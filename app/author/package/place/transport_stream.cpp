// SPDX-License-Identifier: Apache-2.0
// A transport stream in a file or over the network: FFmpeg's muxer, with the missing depth signalling added to its
// output.
#include <array>
#include <atomic>
#include <cerrno>

#include "app/author/package/place/film_io.h"
#include "app/author/package/place/film_place.h"
#include "app/author/package/place/ts_depth_signal.h"
#include "app/author/package/place/ts_pacer.h"
#include "platform/atomic_file.h"
#include "platform/files/file_system_answer.h"

namespace relievo {
namespace {

constexpr int kBuffer = 64 * static_cast<int>(TsPacer::kDatagram);  // whole packets

class TransportStream final : public FilmPlace {
 public:
  ~TransportStream() override {
    closeOut();
    freePackets();
  }

  Result<void> open(const std::string& path, bool live, Existing existing) {
    live_ = live;
    url_ = path;
    if (!live) {
      auto made = AtomicFile::create(path, existing);
      if (!made) return std::unexpected(made.error());
      place_ = std::move(*made);
      place_.output().cancelBy(CancelsAnswers::flag());
    }
    return makeMuxer("mpegts", url_);
  }

  Result<void> begin() override {
    if (!live_) {
      out_ = makeFilmIo(place_.output());
      if (out_ == nullptr) return fail(ErrorCode::Exhausted, "out of memory for a film", ENOMEM);
    } else if (const int code = openAddress(); code < 0) {
      return fail(ErrorCode::Io,
                  "cannot send to this address; write udp://HOST:PORT, or srt://HOST:PORT of a receiver that listens",
                  osErrorOf(code));
    }
    auto* const buffer = static_cast<std::uint8_t*>(av_malloc(kBuffer));
    packets_ = avio_alloc_context(buffer, kBuffer, 1, this, nullptr, takePackets, nullptr);
    if (packets_ == nullptr) {
      av_free(buffer);
      return fail(ErrorCode::Exhausted, "out of memory for a film", ENOMEM);
    }
    muxer().pb = packets_;
    muxer().flags |= AVFMT_FLAG_CUSTOM_IO;
    if (live_) muxer().flags |= AVFMT_FLAG_FLUSH_PACKETS;
    AVStream& depth = *muxer().streams[1];
    depth.id = TsDepthSignal::kDepthPid;
    signal_ = TsDepthSignal(depth.codecpar->codec_id == AV_CODEC_ID_HEVC ? VideoCodec::Hevc : VideoCodec::H264);
    AVDictionary* options = nullptr;
    av_dict_set_int(&options, "mpegts_pmt_start_pid", TsDepthSignal::kMapPid, 0);
    return writeHeader(options);
  }

  Result<std::uint64_t> finish() override {
    int code = av_write_trailer(&muxer());
    avio_flush(packets_);
    if (code >= 0) code = packets_->error;
    if (live_ && code >= 0 && !pacer_.finish()) code = out_->error;
    const int closed = closeOut();
    if (code >= 0) code = closed;
    if (code < 0 && live_) return fail(ErrorCode::Io, kLineFailed, osErrorOf(code));
    if (code < 0) return std::unexpected(failureOf(code));
    if (!live_) {
      if (auto committed = place_.commit(); !committed) return std::unexpected(committed.error());
    }
    return bytes_;
  }

  [[nodiscard]] Duration latest() const noexcept override { return pacer_.latest(); }

 private:
  // A receiver that does not answer must not keep the program from its end.
  [[nodiscard]] int openAddress() {
    const auto isCancelled = [](void* stream) {
      const std::atomic<bool>* const flag = static_cast<TransportStream*>(stream)->ends_opening_;
      return flag != nullptr && *flag ? 1 : 0;
    };
    const AVIOInterruptCB interrupt{.callback = isCancelled, .opaque = this};
    ends_opening_ = CancelsAnswers::flag();
    const int code = avio_open2(&out_, url_.c_str(), AVIO_FLAG_WRITE, &interrupt, nullptr);
    ends_opening_ = nullptr;  // a signal ends the film, and what was made of it is still sent
    return code;
  }

  static constexpr const char* kLineFailed =
      "sending failed: the receiver has gone, or the network; start again when it is back";

  // The library's call-back. Its buffer holds whole packets, which it may change.
#if LIBAVFORMAT_VERSION_MAJOR >= 61  // FFmpeg 7
  using PacketBytes = const std::uint8_t;
#else
  using PacketBytes = std::uint8_t;
#endif
  // FFmpeg passes the buffer that `begin` allocated, so its bytes may be modified.
  static int takePackets(void* self, PacketBytes* data, int bytes) {
    auto& film = *static_cast<TransportStream*>(self);
    if (film.take({const_cast<std::uint8_t*>(data), static_cast<std::size_t>(bytes)})) return bytes;
    return film.out_->error;
  }
  bool take(std::span<std::uint8_t> packets) {
    signal_.rewrite(packets);
    bytes_ += packets.size();
    return live_ ? pacer_.add(packets) : send(packets);
  }
  // Over the network each call is one datagram.
  bool send(std::span<const std::uint8_t> packets) {
    avio_write(out_, packets.data(), static_cast<int>(packets.size()));
    if (live_) avio_flush(out_);
    return out_->error >= 0;
  }
  // 0, or FFmpeg's code for what could not be sent or written.
  int closeOut() noexcept {
    if (live_) return avio_closep(&out_);
    if (out_ == nullptr) return 0;
    avio_flush(out_);
    const int code = out_->error;
    freeFilmIo(out_);
    return code;
  }
  [[nodiscard]] const char* usualFailure() const noexcept override { return live_ ? kLineFailed : kCannotWrite; }
  [[nodiscard]] std::optional<Error> fileError() override {
    return place_.output().valid() ? place_.output().error() : std::nullopt;
  }
  void freePackets() noexcept {
    if (packets_ == nullptr) return;
    av_free(packets_->buffer);
    avio_context_free(&packets_);
  }

  bool live_ = false;
  AtomicFile place_;
  std::string url_;
  const std::atomic<bool>* ends_opening_ = nullptr;
  AVIOContext* out_ = nullptr;
  AVIOContext* packets_ = nullptr;  // what the muxer writes to
  TsDepthSignal signal_{VideoCodec::H264};
  MonotonicClock clock_;
  TsPacer pacer_{clock_, [this](std::span<const std::uint8_t> datagram) { return send(datagram); }};
  std::uint64_t bytes_ = 0;
};

}  // namespace

Result<std::unique_ptr<FilmPlace>> makeTransportStream(const std::string& path, bool live, Existing existing) {
  auto stream = std::make_unique<TransportStream>();
  if (auto opened = stream->open(path, live, existing); !opened) return std::unexpected(opened.error());
  return stream;
}

}  // namespace relievo
