// SPDX-License-Identifier: Apache-2.0
// Writes EBML by Matroska's element list.
#include "tests/support/film/recording/kinect_mkv.h"

#include <algorithm>

namespace relievo::test {
namespace {

std::string bigEndian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i));
  return text;
}
// Identifiers are written as they are printed; every size takes eight bytes.
std::string element(std::uint32_t id, const std::string& data) {
  const int bytes = id > 0xffffff ? 4 : id > 0xffff ? 3 : id > 0xff ? 2 : 1;
  return bigEndian(id, bytes) + bigEndian(std::uint64_t{1} << 56 | data.size(), 8) + data;
}
std::string number(std::uint32_t id, std::uint64_t value) {
  return element(id, bigEndian(value, 8));
}
std::string littleEndian(std::uint64_t value, int bytes) {
  std::string text = bigEndian(value, bytes);
  std::ranges::reverse(text);
  return text;
}

constexpr std::uint64_t kFirstUid = 1000;

// BITMAPINFOHEADER
std::string bitmapHeader(const KinectTrack& track) {
  const auto cols = static_cast<std::uint64_t>(track.cols), rows = static_cast<std::uint64_t>(track.rows);
  return littleEndian(40, 4) + littleEndian(cols, 4) + littleEndian(rows, 4) + littleEndian(1, 2) +
         littleEndian(track.bits, 2) + track.fourcc + littleEndian(cols * rows * track.bits / 8, 4) +
         std::string(16, '\0');
}

std::string trackEntry(const KinectTrack& track, std::uint64_t index) {
  return element(0xAE, number(0xD7, index + 1) + number(0x73C5, kFirstUid + index) + number(0x83, 1) +
                           element(0x536E, track.name) + element(0x86, "V_MS/VFW/FOURCC") +
                           element(0x63A2, bitmapHeader(track)) +
                           element(0xE0, number(0xB0, static_cast<std::uint64_t>(track.cols)) +
                                             number(0xBA, static_cast<std::uint64_t>(track.rows))));
}
std::string trackTag(const KinectTrack& track, std::uint64_t index) {
  const std::string uid = std::to_string(kFirstUid + index);
  return element(0x7373, element(0x63C0, number(0x63C5, kFirstUid + index)) +
                             element(0x67C8, element(0x45A3, "K4A_" + track.name + "_TRACK") + element(0x4487, uid)));
}

}  // namespace

std::string kinectMkv(const std::vector<KinectTrack>& tracks, const std::string& calibration) {
  constexpr std::uint64_t kMicrosecond = 1000;
  std::string entries, tags, clusters;
  std::size_t pictures = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    entries += trackEntry(tracks[i], i);
    tags += trackTag(tracks[i], i);
    pictures = std::max(pictures, tracks[i].pictures.size());
  }
  for (std::size_t p = 0; p < pictures; ++p) {
    std::string blocks;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (p >= tracks[i].pictures.size()) continue;
      const std::string header = bigEndian(0x81 + i, 1) + bigEndian(0, 2) + bigEndian(0x80, 1);  // a key frame
      blocks += element(0xA3, header + tracks[i].pictures[p]);
    }
    clusters += element(0x1F43B675, number(0xE7, 1'000'000 * p / 30) + blocks);
  }
  std::string attachments;
  if (!calibration.empty()) {
    attachments = element(
        0x1941A469, element(0x61A7, element(0x466E, "calibration.json") + element(0x4660, "application/octet-stream") +
                                        element(0x465C, calibration) + number(0x46AE, 7)));
  }
  const std::string segment = element(0x1549A966, number(0x2AD7B1, kMicrosecond)) + element(0x1654AE6B, entries) +
                              attachments + element(0x1254C367, tags) + clusters;
  return element(0x1A45DFA3, number(0x4286, 1) + number(0x42F7, 1) + number(0x42F2, 4) + number(0x42F3, 8) +
                                 element(0x4282, "matroska") + number(0x4287, 2) + number(0x4285, 2)) +
         element(0x18538067, segment);
}

}  // namespace relievo::test
