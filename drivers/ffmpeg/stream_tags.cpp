// SPDX-License-Identifier: Apache-2.0
// Parses a packet's NAL units, a unit's SEI messages, a message's lines (ITU-T H.264 7.3.1, 7.3.2.3;
// H.265 7.3.1, 7.3.5).
#include "drivers/ffmpeg/stream_tags.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/ffmpeg/container.h"
#include "drivers/ffmpeg/views/view_layers.h"
#include "hal/media/media_names.h"
#include "hal/media/stream_tags.h"

namespace relievo::ffmpeg {
namespace {

using Tags = std::map<std::string, std::string>;
constexpr unsigned kUserDataUnregistered = 5;

// Bytes of the length field before each unit (MP4, Matroska); 0: the stream has start codes.
std::size_t lengthBytes(const AVCodecParameters& parameters) noexcept {
  const Bytes extra(parameters.extradata, static_cast<std::size_t>(std::max(parameters.extradata_size, 0)));
  if (extra.size() < 7 || extra[0] != 1) return 0;
  if (parameters.codec_id == AV_CODEC_ID_H264) return (extra[4] & 3u) + 1;
  return extra.size() > 21 ? (extra[21] & 3u) + 1 : 0;
}

void eachUnitByLength(Bytes data, std::size_t length_bytes, const std::function<void(Bytes)>& visit) {
  while (data.size() > length_bytes) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < length_bytes; ++i) size = size << 8 | data[i];
    data = data.subspan(length_bytes);
    size = std::min(size, data.size());
    visit(data.first(size));
    data = data.subspan(size);
  }
}

// An SEI unit's payload, without its header and the emulation prevention bytes; empty for any other unit.
std::vector<std::uint8_t> messagesOf(Bytes unit, AVCodecID codec) {
  const bool hevc = codec == AV_CODEC_ID_HEVC;
  const std::size_t header = hevc ? 2 : 1;
  if (unit.size() <= header) return {};
  const bool supplemental = hevc ? (unit[0] >> 1 & 0x3f) == 39 : (unit[0] & 0x1f) == 6;
  return supplemental ? withoutPrevention(unit.subspan(header)) : std::vector<std::uint8_t>{};
}

void addLines(std::string_view text, Tags& tags) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    std::string key(line.substr(0, equals));
    std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return std::toupper(c); });
    tags.insert_or_assign(std::move(key), std::string(line.substr(equals + 1)));
  }
}

// Reads a number as the sum of bytes, the last of them below 255; false if the data end before that.
bool takeNumber(Bytes& data, std::size_t& number) noexcept {
  number = 0;
  while (!data.empty()) {
    const std::uint8_t byte = data[0];
    data = data.subspan(1);
    number += byte;
    if (byte != 0xff) return true;
  }
  return false;
}

void addMessages(Bytes data, Tags& tags) {
  std::size_t kind = 0, size = 0;
  while (takeNumber(data, kind) && takeNumber(data, size) && size <= data.size()) {
    const Bytes payload = data.first(size);
    data = data.subspan(size);
    if (kind != kUserDataUnregistered) continue;
    // libx265 3.5 puts its own UUID before the given one.
    const Bytes uuids = payload.first(std::min(payload.size(), 2 * kStreamTagsUuid.size()));
    const auto own = std::search(uuids.begin(), uuids.end(), kStreamTagsUuid.begin(), kStreamTagsUuid.end());
    if (own == uuids.end()) continue;
    // FFmpeg's h264_metadata ends it with a zero byte.
    const Bytes text(own + kStreamTagsUuid.size(), std::find(own + kStreamTagsUuid.size(), payload.end(), 0));
    addLines({reinterpret_cast<const char*>(text.data()), text.size()}, tags);
  }
}

bool saysDepth(const AVDictionary* tags) noexcept {
  return av_dict_get(tags, "DEPTH_", nullptr, AV_DICT_IGNORE_SUFFIX) != nullptr;
}

bool mayCarryTags(AVCodecID codec) noexcept {
  return codec == AV_CODEC_ID_H264 || codec == AV_CODEC_ID_HEVC;
}

}  // namespace

void eachUnitByStartCode(Bytes data, const std::function<void(Bytes)>& visit) {
  constexpr std::array<std::uint8_t, 3> kStartCode{0, 0, 1};
  auto at = std::search(data.begin(), data.end(), kStartCode.begin(), kStartCode.end());
  while (at != data.end()) {
    const auto begin = at + kStartCode.size();
    at = std::search(begin, data.end(), kStartCode.begin(), kStartCode.end());
    visit(Bytes(begin, at));
  }
}

void eachUnit(const AVPacket& packet, const AVCodecParameters& parameters, const std::function<void(Bytes)>& visit) {
  const Bytes data(packet.data, static_cast<std::size_t>(std::max(packet.size, 0)));
  const std::size_t length_bytes = lengthBytes(parameters);
  if (length_bytes > 0) eachUnitByLength(data, length_bytes, visit);
  else eachUnitByStartCode(data, visit);
}

std::vector<std::uint8_t> withoutPrevention(Bytes bytes) {
  std::vector<std::uint8_t> plain;
  int zeros = 0;
  for (const std::uint8_t byte : bytes) {
    const bool kept_out = zeros >= 2 && byte == 3;
    zeros = byte == 0 ? zeros + 1 : 0;
    if (!kept_out) plain.push_back(byte);
  }
  return plain;
}

std::map<int, const AVStream*> streamsWithTags(const AVFormatContext& container) {
  std::map<int, const AVStream*> found;
  if (saysDepth(container.metadata)) return found;
  for (const AVStream* const stream : std::span(container.streams, container.nb_streams)) {
    if (saysDepth(stream->metadata)) return {};
    if (kindOf(*stream) == StreamKind::Video && mayCarryTags(stream->codecpar->codec_id)) found[stream->index] = stream;
  }
  return found;
}

Tags streamTags(const AVPacket& packet, const AVCodecParameters& parameters) {
  Tags tags;
  if (!mayCarryTags(parameters.codec_id) || packet.size <= 0) return tags;
  eachUnit(packet, parameters, [&](Bytes unit) { addMessages(messagesOf(unit, parameters.codec_id), tags); });
  if (const int layers = viewLayers(packet, parameters); layers > 0) tags[kLayersTag] = std::to_string(layers);
  return tags;
}

}  // namespace relievo::ffmpeg
