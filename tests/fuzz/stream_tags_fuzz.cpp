// SPDX-License-Identifier: Apache-2.0
// Any bytes as a picture with tags inside, and any text as tags: those that were written come back, and a reading of a
// depth picture by them has finite heights within the volume.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/media/reading/recording_place.h"
#include "app/scene/depth_calibration.h"
#include "drivers/ffmpeg/stream_tags.h"
#include "hal/media/stream_tags.h"

namespace relievo {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Tags = std::map<std::string, std::string>;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

// One SEI unit with the text (ITU-T H.264 7.3.1, 7.3.2.3; H.265 7.3.1.2), behind a length or a start code.
Bytes written(const std::string& text, bool hevc, bool lengths) {
  Bytes message{5};
  const std::size_t size = kStreamTagsUuid.size() + text.size();
  for (std::size_t left = size;
       message.push_back(static_cast<std::uint8_t>(std::min<std::size_t>(left, 255))), left >= 255; left -= 255) {
  }
  message.insert(message.end(), kStreamTagsUuid.begin(), kStreamTagsUuid.end());
  message.insert(message.end(), text.begin(), text.end());
  message.push_back(0x80);
  Bytes unit = hevc ? Bytes{39 << 1, 1} : Bytes{6};
  for (const std::uint8_t byte : message) {
    const std::size_t end = unit.size();
    if (end > 2 && unit[end - 1] == 0 && unit[end - 2] == 0 && byte <= 3) unit.push_back(3);
    unit.push_back(byte);
  }
  const auto bytes = static_cast<std::uint32_t>(unit.size());
  Bytes packet{0, 0, 0, 1};
  for (int i = 0; lengths && i < 4; ++i)
    packet[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(bytes >> 8 * (3 - i));
  packet.insert(packet.end(), unit.begin(), unit.end());
  return packet;
}

// A zero byte ends the text.
Tags linesOf(std::string text) {
  Tags tags;
  text.resize(std::min(text.find('\0'), text.size()));
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    if (const std::size_t equals = line.find('='); equals != std::string::npos) {
      for (std::size_t i = 0; i < equals; ++i) {
        line[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(line[i])));
      }
      tags[line.substr(0, equals)] = line.substr(equals + 1);
    }
    at = end + 1;
  }
  return tags;
}

// `sets`: the bytes are the container's parameter sets as well.
Tags tagsIn(Bytes& bytes, bool hevc, bool lengths, bool sets = false) {
  Bytes extra(23, 0);
  extra[0] = lengths ? 1 : 0;
  extra[hevc ? 21 : 4] = 3;
  if (sets) {
    extra[22] = 3;
    extra.insert(extra.end(), bytes.begin(), bytes.end());
  }
  AVCodecParameters parameters{};
  parameters.codec_id = hevc ? AV_CODEC_ID_HEVC : AV_CODEC_ID_H264;
  parameters.extradata = extra.data();
  parameters.extradata_size = static_cast<int>(extra.size());
  AVPacket packet{};
  packet.data = bytes.data();
  packet.size = static_cast<int>(bytes.size());
  return ffmpeg::streamTags(packet, parameters);
}

void readBy(const Tags& tags) {
  auto samples = std::make_shared<std::vector<std::uint16_t>>();
  for (int i = 0; i < 12 * 9; ++i) samples->push_back(static_cast<std::uint16_t>(600 * i));
  const Frame depth = grayFrame(std::move(samples), 12, 9);
  const CalibrationLayers layers{.tags = calibrationFromTags(tags), .beside = lookAtTags(tags).settings};
  const auto choice = chooseCalibration(layers, depth, DepthCode::Luma);
  if (!choice) return;
  constexpr double kDepthMm = 40, kRounding = 1e-6;
  for (const double s : {0.0, 0.25, 1.0}) {
    const double height = heightMm(choice->calibration, s, kDepthMm);
    require(height >= -kRounding && height <= kDepthMm + kRounding, "a height within the volume");
  }
}

void fuzz(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  const bool hevc = (data[0] & 1) != 0, lengths = (data[0] & 2) != 0, raw = (data[0] & 4) != 0,
             sets = (data[0] & 8) != 0;
  Bytes bytes(data + 1, data + size);
  if (raw) return readBy(tagsIn(bytes, hevc, lengths, sets));
  const std::string text(bytes.begin(), bytes.end());
  Bytes packet = written(text, hevc, lengths);
  const Tags tags = tagsIn(packet, hevc, lengths);
  require(tags == linesOf(text), "the tags that were written");
  readBy(tags);
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::fuzz(bytes, size);
  return 0;
}
