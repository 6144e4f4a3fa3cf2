// SPDX-License-Identifier: Apache-2.0
// Queries the nodes (Documentation/userspace-api/media/v4l/dev-decoder.rst, "Querying Capabilities").
#include "drivers/v4l2/m2m_node.h"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include "drivers/v4l2/control.h"
#include "drivers/v4l2/m2m_picture.h"

namespace relievo::v4l2 {
namespace {

constexpr std::string_view kNode = "video";
constexpr std::uint32_t kFewestPacketBytes = 256 << 10;

struct Coding {
  const char* codec;
  std::uint32_t fourcc;
};
constexpr std::array kCodings{Coding{"h264", V4L2_PIX_FMT_H264}, Coding{"hevc", V4L2_PIX_FMT_HEVC},
                              Coding{"fwht", V4L2_PIX_FMT_FWHT}};  // FWHT: the kernel's virtual codec

std::vector<std::string> codecsOf(int fd, std::uint32_t queue) {
  std::vector<std::string> codecs;
  for (v4l2_fmtdesc each{.index = 0, .type = queue}; control(fd, VIDIOC_ENUM_FMT, &each) == 0; ++each.index) {
    const auto known = [&](const Coding& c) { return c.fourcc == each.pixelformat; };
    const auto found = std::find_if(kCodings.begin(), kCodings.end(), known);
    if (found != kCodings.end() && (each.flags & V4L2_FMT_FLAG_COMPRESSED) != 0) codecs.emplace_back(found->codec);
  }
  return codecs;
}

std::optional<M2mNode> lookAt(const std::string& path, int fd) {
  v4l2_capability is{};
  if (control(fd, VIDIOC_QUERYCAP, &is) < 0) return std::nullopt;
  const std::uint32_t can = (is.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? is.device_caps : is.capabilities;
  if ((can & (V4L2_CAP_VIDEO_M2M | V4L2_CAP_VIDEO_M2M_MPLANE)) == 0 || (can & V4L2_CAP_STREAMING) == 0) {
    return std::nullopt;
  }
  M2mNode node;
  node.path = path;
  node.planes = (can & V4L2_CAP_VIDEO_M2M_MPLANE) != 0;
  const auto* const card = reinterpret_cast<const char*>(is.card);
  node.card.assign(card, ::strnlen(card, sizeof is.card));
  node.codecs = codecsOf(fd, node.packetQueue());
  if (node.codecs.empty()) return std::nullopt;
  return node;
}

// The paths /dev/videoN, sorted by N.
std::vector<std::string> paths() {
  std::map<int, std::string> found;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", failed)) {
    const std::string name = entry.path().filename();
    int number = 0;
    const char* const end = name.data() + name.size();
    if (!name.starts_with(kNode)) continue;
    const auto read = std::from_chars(name.data() + kNode.size(), end, number);
    if (read.ec == std::errc() && read.ptr == end) found[number] = entry.path();
  }
  std::vector<std::string> all;
  all.reserve(found.size());
  for (auto& [number, path] : found) all.push_back(std::move(path));
  return all;
}

template <class Visit>
void visitNodes(Visit&& visit) {
  for (const std::string& path : paths()) {
    auto fd = std::make_shared<const UniqueFd>(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!fd->valid()) continue;
    if (auto node = lookAt(path, fd->get()); node && !visit(M2mDevice{std::move(*node), std::move(fd)})) return;
  }
}

// Why the driver does not take pictures of this size; null also if it does not report its sizes.
const char* refusalOfSize(int fd, std::uint32_t fourcc, int width, int height) noexcept {
  v4l2_frmsizeenum sizes{.index = 0, .pixel_format = fourcc};
  if (control(fd, VIDIOC_ENUM_FRAMESIZES, &sizes) < 0 || sizes.type == V4L2_FRMSIZE_TYPE_DISCRETE) return nullptr;
  const auto across = static_cast<std::uint32_t>(width), down = static_cast<std::uint32_t>(height);
  const v4l2_frmsize_stepwise& range = sizes.stepwise;
  if (across > range.max_width || down > range.max_height) return "the pictures are too large for the video hardware";
  if (across < range.min_width || down < range.min_height) return "the pictures are too small for the video hardware";
  return nullptr;
}

// False if the driver lists formats of pictures and none of them can be read, such as tiles. The packets' format is
// set.
bool givesReadable(int fd, std::uint32_t queue) noexcept {
  v4l2_fmtdesc each{.index = 0, .type = queue};
  for (; control(fd, VIDIOC_ENUM_FMT, &each) == 0; ++each.index) {
    if (isPictureFormat(each.pixelformat)) return true;
  }
  return each.index == 0;
}

// The kernel's menu items for profiles.
int menuItem(const std::string& codec, int profile) noexcept {
  if (codec == "hevc") return profile == 1 ? V4L2_MPEG_VIDEO_HEVC_PROFILE_MAIN : -1;
  switch (profile) {
    case 66:
      return V4L2_MPEG_VIDEO_H264_PROFILE_BASELINE;
    case 77:
      return V4L2_MPEG_VIDEO_H264_PROFILE_MAIN;
    case 88:
      return V4L2_MPEG_VIDEO_H264_PROFILE_EXTENDED;
    case 100:
      return V4L2_MPEG_VIDEO_H264_PROFILE_HIGH;
    default:
      return -1;
  }
}

// True also if the driver does not report its profiles. Baseline is accepted with the item of Constrained Baseline,
// since most Baseline streams are constrained.
bool takesProfile(int fd, const std::string& codec, int profile) noexcept {
  v4l2_queryctrl menu{};
  menu.id = codec == "hevc" ? V4L2_CID_MPEG_VIDEO_HEVC_PROFILE : V4L2_CID_MPEG_VIDEO_H264_PROFILE;
  const int item = menuItem(codec, profile);
  if (item < 0 || control(fd, VIDIOC_QUERYCTRL, &menu) < 0 || (menu.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return true;
  const auto has = [&](int index) {
    v4l2_querymenu entry{};
    entry.id = menu.id;
    entry.index = static_cast<std::uint32_t>(index);
    return control(fd, VIDIOC_QUERYMENU, &entry) == 0;
  };
  const bool baseline = codec == "h264" && item == V4L2_MPEG_VIDEO_H264_PROFILE_BASELINE;
  return has(item) || (baseline && has(V4L2_MPEG_VIDEO_H264_PROFILE_CONSTRAINED_BASELINE));
}

// A packet is at most half a raw picture of its level (MinCR, ISO/IEC 14496-10, A.3).
Result<void> setPacketFormat(const M2mNode& node, int fd, const StreamInfo& stream, std::uint32_t fourcc) noexcept {
  const auto width = static_cast<std::uint32_t>(stream.width), height = static_cast<std::uint32_t>(stream.height);
  const std::uint32_t bytes = std::max(kFewestPacketBytes, width * height * 3 / 4);
  v4l2_format format{};
  format.type = node.packetQueue();
  if (node.planes) {
    v4l2_pix_format_mplane& picture = format.fmt.pix_mp;
    picture.pixelformat = fourcc;
    picture.width = width;
    picture.height = height;
    picture.num_planes = 1;
    picture.plane_fmt[0].sizeimage = bytes;
  } else {
    v4l2_pix_format& picture = format.fmt.pix;
    picture.pixelformat = fourcc;
    picture.width = width;
    picture.height = height;
    picture.sizeimage = bytes;
  }
  const int answer = control(fd, VIDIOC_S_FMT, &format);
  if (answer < 0 && errno == EBUSY) return fail(ErrorCode::Io, "the video hardware is busy", errno);
  const std::uint32_t got = node.planes ? format.fmt.pix_mp.pixelformat : format.fmt.pix.pixelformat;
  if (answer < 0 || got != fourcc) return fail(ErrorCode::Unsupported, "the video hardware rejects the stream", errno);
  return {};
}

// The fourcc of a codec's packets; nullopt for an unsupported codec.
std::optional<std::uint32_t> packetFormatOf(const std::string& codec) noexcept {
  const auto found = std::find_if(kCodings.begin(), kCodings.end(), [&](const Coding& c) { return codec == c.codec; });
  return found == kCodings.end() ? std::nullopt : std::optional(found->fourcc);
}

}  // namespace

Result<M2mDevice> openM2mDevice(const StreamInfo& stream, const std::optional<CodingProfile>& profile) {
  const auto fourcc = packetFormatOf(stream.codec);
  if (!fourcc) return fail(ErrorCode::Unsupported, "the video hardware decodes only H.264 and HEVC");
  Result<M2mDevice> found = fail(ErrorCode::NotFound, "no video hardware here decodes this codec");
  visitNodes([&](M2mDevice device) {
    const M2mNode& node = device.node;
    const int fd = device.fd->get();
    if (std::find(node.codecs.begin(), node.codecs.end(), stream.codec) == node.codecs.end()) return true;
    if (const char* const refusal = refusalOfSize(fd, *fourcc, stream.width, stream.height)) {
      found = fail(ErrorCode::Unsupported, refusal);
    } else if (profile && (!profile->plain || !takesProfile(fd, stream.codec, profile->profile))) {
      found = fail(ErrorCode::Unsupported, "the video hardware decodes only 8-bit 4:2:0 of common profiles");
    } else if (auto set = setPacketFormat(node, fd, stream, *fourcc); !set) {
      found = std::unexpected(set.error());
    } else if (!givesReadable(fd, node.pictureQueue())) {
      found = fail(ErrorCode::Unsupported, kUnreadable);
    } else {
      found = std::move(device);
      return false;
    }
    return true;
  });
  return found;
}

int command(int fd, std::uint32_t command) noexcept {
  v4l2_decoder_cmd asked{};
  asked.cmd = command;
  return control(fd, VIDIOC_DECODER_CMD, &asked) < 0 ? errno : 0;
}

bool subscribeChanges(int fd) noexcept {
  v4l2_event_subscription wanted{};
  wanted.type = V4L2_EVENT_SOURCE_CHANGE;
  return control(fd, VIDIOC_SUBSCRIBE_EVENT, &wanted) == 0;
}

std::optional<bool> nextEvent(int fd) noexcept {
  v4l2_event event{};
  if (control(fd, VIDIOC_DQEVENT, &event) < 0) return std::nullopt;
  return event.type == V4L2_EVENT_SOURCE_CHANGE && (event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION) != 0;
}

}  // namespace relievo::v4l2

namespace relievo {

std::vector<V4l2M2mNode> lookAtV4l2M2mNodes() {
  std::vector<V4l2M2mNode> nodes;
  v4l2::visitNodes([&](const v4l2::M2mDevice& device) {
    nodes.push_back(device.node);
    return true;
  });
  return nodes;
}

}  // namespace relievo
