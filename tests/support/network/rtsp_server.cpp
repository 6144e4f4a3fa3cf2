// SPDX-License-Identifier: Apache-2.0
// The RTSP methods (RFC 2326) that a player needs; FFmpeg's muxer makes the RTP.
#include "tests/support/network/rtsp_server.h"

#include <array>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "tests/support/network/loopback.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace relievo::test {
namespace {

constexpr Duration kSlice = std::chrono::milliseconds(10);
constexpr int kPacketBytes = 1400;

// One track: sends the muxer's output in frames of "$", channel, length (RFC 2326, 10.12).
struct Channel {
  AVFormatContext* muxer = nullptr;
  const UniqueFd* viewer = nullptr;
  std::uint8_t number = 0;
  bool broken = false;

#if LIBAVFORMAT_VERSION_MAJOR >= 61  // FFmpeg 7
  using PacketBytes = const std::uint8_t;
#else
  using PacketBytes = std::uint8_t;
#endif
  static int write(void* self, PacketBytes* data, int bytes) {
    auto& channel = *static_cast<Channel*>(self);
    const bool rtcp = bytes > 1 && data[1] >= 200 && data[1] <= 204;
    std::string frame{'$', static_cast<char>(channel.number + (rtcp ? 1 : 0)), static_cast<char>(bytes >> 8),
                      static_cast<char>(bytes & 0xff)};
    frame.append(reinterpret_cast<const char*>(data), static_cast<std::size_t>(bytes));
    if (channel.viewer != nullptr && !sendAll(*channel.viewer, frame)) channel.broken = true;
    return bytes;
  }
};

// The clip and a muxer for each of its tracks.
class Session {
 public:
  Session(const std::string& clip, const UniqueFd* viewer) {
    if (avformat_open_input(&clip_, clip.c_str(), nullptr, nullptr) < 0 ||
        avformat_find_stream_info(clip_, nullptr) < 0) {
      throw std::runtime_error("rtsp server: no clip " + clip);
    }
    channels_.resize(clip_->nb_streams);
    for (unsigned i = 0; i < clip_->nb_streams; ++i) {
      Channel& channel = channels_[i];
      channel.viewer = viewer;
      channel.number = static_cast<std::uint8_t>(2 * i);
      avformat_alloc_output_context2(&channel.muxer, nullptr, "rtp", nullptr);
      AVStream* const stream = avformat_new_stream(channel.muxer, nullptr);
      avcodec_parameters_copy(stream->codecpar, clip_->streams[i]->codecpar);
      stream->codecpar->codec_tag = 0;
      stream->time_base = clip_->streams[i]->time_base;
      channel.muxer->packet_size = kPacketBytes;
      auto* const buffer = static_cast<std::uint8_t*>(av_malloc(kPacketBytes));
      channel.muxer->pb = avio_alloc_context(buffer, kPacketBytes, 1, &channel, nullptr, Channel::write, nullptr);
      channel.muxer->pb->max_packet_size = kPacketBytes;
      if (avformat_write_header(channel.muxer, nullptr) < 0)
        throw std::runtime_error("rtsp server: no RTP of this clip");
    }
    packet_ = av_packet_alloc();
  }
  ~Session() {
    for (Channel& channel : channels_) {
      av_write_trailer(channel.muxer);  // needed to free what av_write_header allocated
      av_freep(&channel.muxer->pb->buffer);
      avio_context_free(&channel.muxer->pb);
      avformat_free_context(channel.muxer);
    }
    av_packet_free(&packet_);
    avformat_close_input(&clip_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] std::string description() {
    std::array<char, 8192> text{};
    std::vector<AVFormatContext*> muxers;
    for (Channel& channel : channels_) muxers.push_back(channel.muxer);
    av_sdp_create(muxers.data(), static_cast<int>(muxers.size()), text.data(), static_cast<int>(text.size()));
    return text.data();
  }

  // Gets the time of the next packet since the first; false at the end.
  [[nodiscard]] bool next(Duration& time) {
    av_packet_unref(packet_);
    if (av_read_frame(clip_, packet_) < 0) return false;
    const AVStream& stream = *clip_->streams[packet_->stream_index];
    const std::int64_t ns = av_rescale_q(packet_->dts, stream.time_base, {1, 1'000'000'000});
    if (first_ns_ < 0) first_ns_ = ns;
    time = Duration(ns - first_ns_);
    return true;
  }
  // False if the viewer has disconnected.
  [[nodiscard]] bool send() {
    Channel& channel = channels_[static_cast<std::size_t>(packet_->stream_index)];
    av_packet_rescale_ts(packet_, clip_->streams[packet_->stream_index]->time_base,
                         channel.muxer->streams[0]->time_base);
    packet_->stream_index = 0;
    av_write_frame(channel.muxer, packet_);
    avio_flush(channel.muxer->pb);
    return !channel.broken;
  }

 private:
  AVFormatContext* clip_ = nullptr;
  std::vector<Channel> channels_;
  AVPacket* packet_ = nullptr;
  std::int64_t first_ns_ = -1;
};

std::string headerOf(const std::string& request, const std::string& name) {
  const std::size_t at = request.find(name + ": ");
  if (at == request.npos) return "";
  const std::size_t begin = at + name.size() + 2;
  return request.substr(begin, request.find("\r\n", begin) - begin);
}

}  // namespace

RtspServer::RtspServer(std::string clip) : clip_(std::move(clip)), listener_(bindLoopback(SOCK_STREAM)) {
  port_ = portOf(listener_);
  thread_ = std::thread([this] { serve(); });
}

RtspServer::~RtspServer() {
  ending_ = true;
  thread_.join();
}

std::string RtspServer::url() const {
  return "rtsp://127.0.0.1:" + std::to_string(port_) + "/camera";
}

void RtspServer::cut(Duration away) {
  away_until_ = clock_.now() + away;
}

void RtspServer::serve() {
  while (!ending_) {
    if (!readable(listener_, kSlice)) continue;
    const UniqueFd viewer(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!away()) answer(viewer);
  }
}

void RtspServer::answer(const UniqueFd& viewer) {
  while (!away()) {
    if (!readable(viewer, kSlice)) continue;
    const std::string request = receiveHead(viewer);
    const std::string verb = request.substr(0, request.find(' '));
    if (verb.empty() || verb == "TEARDOWN") return;
    std::string head = "RTSP/1.0 200 OK\r\nCSeq: " + headerOf(request, "CSeq") + "\r\n";
    std::string body;
    if (verb == "OPTIONS") head += "Public: DESCRIBE, SETUP, PLAY, TEARDOWN\r\n";
    if (verb == "DESCRIBE") {
      body = Session(clip_, nullptr).description();
      head += "Content-Type: application/sdp\r\nContent-Base: " + url() +
              "/\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
    }
    if (verb == "SETUP") head += "Session: 1\r\nTransport: " + headerOf(request, "Transport") + "\r\n";
    if (verb == "PLAY") head += "Session: 1\r\n";
    if (!sendAll(viewer, head + "\r\n" + body)) return;
    if (verb == "PLAY") return play(viewer);
  }
}

void RtspServer::play(const UniqueFd& viewer) {
  Session session(clip_, &viewer);
  ++sessions_;
  const MonotonicTime start = clock_.now();
  for (Duration time; session.next(time);) {
    while (clock_.now() < start + time && !away()) clock_.sleepUntil(std::min(start + time, clock_.now() + kSlice));
    if (away() || !session.send()) return;
  }
  while (!away() && !readable(viewer, kSlice)) {
  }
}

}  // namespace relievo::test
