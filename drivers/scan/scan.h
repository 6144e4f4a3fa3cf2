// SPDX-License-Identifier: Apache-2.0
// Media source for scans in one file: ScanNet's and BundleFusion's .sens, Kintinuous' and ElasticFusion's .klg.
#pragma once

#include <memory>
#include <string>

#include "hal/media/media_source.h"

namespace relievo {

// True for a regular file that ends in .sens or .klg.
[[nodiscard]] bool isScan(const std::string& path);

// Colour and depth are a stream each, with the tag TITLE; a scan without colour has only depth. Depth has the tags
// DEPTH_UNIT and DEPTH_INVALID; its pictures are given out as "rawvideo" in gray16le, or as "tiff" around what the scan
// has deflated. Colour is "mjpeg", "png" or "rawvideo". All are key frames. Colour and depth of one frame have one
// time, that of the colour from the first frame on, or, where the scan has no rising times, 30 frames a second
// (`counted`).
//
// Opening reads the head of each frame, no picture but the first. A scan that was cut off ends with its last whole
// frame and says so. Refused: depth compressed by the Occipital codec, and scans without a whole frame.
[[nodiscard]] std::unique_ptr<MediaSource> makeScanSource();

// True for a regular file of the name depth.bin: ScanNet++'s depth of an iPhone, without its colour.
[[nodiscard]] bool isDepthBin(const std::string& path);

// One stream, as a scan's depth; 60 pictures a second (`counted`) unless a rate is set. An older file, which is one
// stream, has no duration, since nobody has counted its pictures; to seek in it unpacks what lies between.
[[nodiscard]] std::unique_ptr<MediaSource> makeDepthBinSource();

}  // namespace relievo
