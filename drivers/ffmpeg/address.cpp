// SPDX-License-Identifier: Apache-2.0
// The allowed protocols and formats, and the time-outs of each kind of address.
#include "drivers/ffmpeg/address.h"

#include <linux/magic.h>
#include <sys/statfs.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "platform/files/answered_place.h"
#include "platform/files/file_system_answer.h"

namespace relievo::ffmpeg {
namespace {

constexpr const char* kDevice =
    "it is a device or a file of the kernel, not a film; give a film's file (a camera is v4l2:/dev/videoN)";
constexpr const char* kUnknown =
    "this protocol is not supported; use a file, http, https, rtsp, rtsps, rtp, udp, srt or tcp";
constexpr const char* kNoPort =
    "this address needs a port from 1 to 65535, as in udp://@:1234; give the one that the sender sends to";

struct Protocol {
  std::string_view name;
  Way way;
};
constexpr std::array kProtocols{
    Protocol{"file", Way::File},   Protocol{"http", Way::Http},   Protocol{"https", Way::Http},
    Protocol{"rtsp", Way::Rtsp},   Protocol{"rtsps", Way::Rtsp},  Protocol{"rtp", Way::Packets},
    Protocol{"udp", Way::Packets}, Protocol{"srt", Way::Packets}, Protocol{"tcp", Way::Tcp},
};

// Containers and streams. Excluded: lists of other addresses (concat), sessions that open ports (sdp), image sequences.
constexpr const char* kFilms =
    "mov,mp4,matroska,webm,mpegts,mpeg,flv,live_flv,avi,ogg,asf,nut,ivf,h264,hevc,mpegvideo,m4v,obu,mjpeg,mpjpeg,"
    "yuv4mpegpipe,"
    "aac,ac3,eac3,mp3,flac,wav,webvtt,hls,dash,rtsp,rtp";

constexpr const char* kSilenceUs = "10000000";     // the longest wait for a byte
constexpr const char* kFlowSilenceUs = "3000000";  // the same for a real-time stream
constexpr const char* kFlowProbeUs = "1500000";    // of a real-time stream, since the viewer waits meanwhile
constexpr const char* kFlowProbeFrames = "3";

const char* protocolsOf(Way way) noexcept {
  switch (way) {
    case Way::File:
      return "file,crypto,rtp,udp";
    case Way::Pipe:
      return "pipe";
    case Way::Http:
      return "http,https,httpproxy,tls,tcp,crypto";
    case Way::Rtsp:
      return "rtsp,rtsps,rtp,srtp,udp,tcp,tls";
    case Way::Packets:
      return "rtp,udp,srt";
    case Way::Tcp:
      return "tcp";
  }
  return "";
}

// FFmpeg takes a missing port for 0: no port of that number receives anything. The query can name the port, too; what
// follows a "&" is an option that FFmpeg does not see.
bool hasPort(std::string_view url) noexcept {
  for (const char* const named : {"localport=", "localrtpport="}) {
    if (url.find(named) != url.npos) return true;
  }
  url.remove_prefix(url.find(':') + 1);
  url = url.substr(std::min(url.find_first_not_of('/'), url.size()));
  url = url.substr(0, url.find_first_of("/?#"));
  const std::size_t colon = url.find_last_of(":]");  // "[::1]" has none
  if (colon == url.npos || url[colon] == ']') return false;
  int port = 0;
  const char* const end = url.data() + url.size();
  const auto [last, failed] = std::from_chars(url.data() + colon + 1, end, port);
  return failed == std::errc() && (last == end || *last == '&') && port >= 1 && port <= 65535;
}

// Devices, sockets and files of /proc and the like: a read may block forever and cannot be interrupted.
bool mayNeverEnd(const std::string& path, const struct stat& status) noexcept {
  if (S_ISCHR(status.st_mode) || S_ISSOCK(status.st_mode)) return true;
  struct statfs system{};
  if (!S_ISREG(status.st_mode) || ::statfs(path.c_str(), &system) != 0) return false;
  constexpr std::array<long, 4> kKernels{PROC_SUPER_MAGIC, SYSFS_MAGIC, DEBUGFS_MAGIC, TRACEFS_MAGIC};
  return std::find(kKernels.begin(), kKernels.end(), static_cast<long>(system.f_type)) != kKernels.end();
}

}  // namespace

std::string_view schemeOf(std::string_view url) noexcept {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.";
  const std::size_t end = std::min(url.find_first_not_of(kLetters), url.size());
  const bool has_options = url.starts_with("subfile,") && url.find(':') != url.npos;
  return end < url.size() && (url[end] == ':' || has_options) ? url.substr(0, end) : std::string_view();
}

Result<Address> parseAddress(const std::string& url) {
  for (const std::string& path : {url, url.starts_with("file:") ? url.substr(5) : std::string()}) {
    const auto status = statusOf(path);
    if (!status && status.error().code != ErrorCode::NotFound) return std::unexpected(status.error());
    if (!status) continue;
    if (S_ISFIFO(status->st_mode)) return Address{path, Way::Pipe};
    const auto endless = answerOf(path, [path, status = *status] { return mayNeverEnd(path, status); });
    if (!endless) return std::unexpected(endless.error());
    if (*endless) return fail(ErrorCode::Unsupported, kDevice);
    return Address{"file:" + path, Way::File};
  }
  const std::string_view scheme = schemeOf(url);
  if (scheme.empty()) return Address{url, Way::File};
  const auto known = std::find_if(kProtocols.begin(), kProtocols.end(), [&](auto& p) { return p.name == scheme; });
  if (known == kProtocols.end()) return fail(ErrorCode::Unsupported, kUnknown);
  if (known->way == Way::Packets && !hasPort(url)) return fail(ErrorCode::Unsupported, kNoPort);
  return Address{url, known->way};
}

AVDictionary* optionsFor(const Address& address) {
  AVDictionary* options = nullptr;
  const auto set = [&](const char* key, const char* value) { av_dict_set(&options, key, value, 0); };
  set("protocol_whitelist", protocolsOf(address.way));
  if (address.remote()) set("format_whitelist", kFilms);
  set("rw_timeout", address.flows() ? kFlowSilenceUs : kSilenceUs);
  if (address.flows()) {
    set("timeout", kFlowSilenceUs);
    set("analyzeduration", kFlowProbeUs);
    set("fpsprobesize", kFlowProbeFrames);
  }
  if (address.way == Way::Http) {
    set("reconnect", "1");  // continue where the connection broke, at once or not at all
    set("reconnect_delay_max", "0");
  }
  if (address.way == Way::Rtsp) set("rtsp_flags", "prefer_tcp");  // an address that ends in "?udp" asks for UDP
  if (address.way == Way::Packets) set("overrun_nonfatal", "1");  // a late reader loses packets but keeps the stream
  return options;
}

}  // namespace relievo::ffmpeg
