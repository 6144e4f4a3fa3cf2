// SPDX-License-Identifier: Apache-2.0
// What the known layouts of recordings say about their depth.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace relievo::pictures {

// Tags of the depth's meaning, by the first pictures' paths.
//   TUM, ICL-NUIM   rgb/ and depth/ with seconds in names or a list (`listed`), PNG: kLayoutTag, since others record in
//                   mm so
//   KITTI           .._sync_groundtruth_depth_0000000005_image_02.png, its selection of pictures: 256 codes a metre
//   BOP             scene_camera.json beside rgb/ and depth/: its depth_scale, in mm
[[nodiscard]] std::map<std::string, std::string> depthTagsOf(const std::string& color, const std::string& depth,
                                                             bool listed);

// The pictures a second of layouts whose names give no times, by the first pictures' paths; 0 for pictures of different
// scenes; nullopt if nothing is known.
//   KITTI            image_02/data/0000000005.png, sequences/00/image_2/000000.png, Virtual KITTI's rgb/Camera_0: 10
//   KITTI 2012, 2015 image_2/000000_10.png: scenes
//                    .._sync_image_0000000005_image_02.png: its selection of depth
//   DIODE            00019_00183_indoors_040_010.png: scenes
//   Sintel           .dpt: 24
[[nodiscard]] std::optional<double> rateOf(const std::string& color, const std::string& depth);

// "d-1294886362.665769-3143787185.pgm": NYU's raw depth.
[[nodiscard]] bool isNyuDepth(const std::string& path);

// PGM stores the high byte of 16-bit samples first; NYU's files store the low byte first. Swaps the bytes if only then
// all codes are a Kinect's, at most 2047.
void mendByteOrder(std::vector<std::uint8_t>& pgm);

// States 65535 as the highest code of a 16-bit PGM. Decoders stretch codes to the whole range; a sensor's are not meant
// so, whatever its recorder states as the highest one.
void keepCodes(std::vector<std::uint8_t>& pgm);

}  // namespace relievo::pictures
