// SPDX-License-Identifier: Apache-2.0
// Makes small clips for tests, sample by sample, with FFmpeg's libraries.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hal/media/frame.h"
#include "platform/clock.h"

namespace relievo::test {

// One video track. Lossless with the default codec: what `sample` says is what a reader must find.
struct ClipTrack {
  std::string codec = "ffv1";  // an encoder of FFmpeg: ffv1, libx264, libvpx, png, tiff, ..
  std::string pix_fmt = "gray16le";
  int width = 64, height = 48;
  int fps_num = 30, fps_den = 1;
  int frames = 30;
  Duration start{0};  // of the first picture
  int gop = 12;       // key frame distance; codecs of key frames alone (ffv1) take it as well
  int b_frames = 0;
  ColorRange range = ColorRange::Unspecified;                                // as signalled
  std::uint8_t primaries = kUnspecifiedColor, transfer = kUnspecifiedColor;  // likewise
  int sample_width = 0, sample_height = 0;                                   // sample aspect ratio; 0: not signalled
  std::optional<double> rotation;  // degrees clockwise that a player is to turn it by (MP4, QuickTime)
  bool cover = false;              // a cover picture, not a film (MP4)
  // (component, column, row, frame): the code of one sample, cut to the format's bits. Default: a slope that moves.
  std::function<std::uint32_t(int, int, int, int)> sample;
  // The time of frame k, or nothing for one that is left out. Default: start + k / fps, none left out.
  std::function<std::optional<Duration>(int)> time;
  std::map<std::string, std::string> tags;     // title, handler_name, DEPTH_LAW, ..
  std::map<std::string, std::string> options;  // of the encoder: crf, ..
};

// One sound track.
struct ClipSound {
  std::string codec = "flac";  // an encoder of FFmpeg: aac, libopus, libmp3lame, pcm_s16le, ..
  int rate_hz = 48000;
  int channels = 2;
  Duration start{0};
  Duration length = std::chrono::seconds(1);
  // (seconds from 0, channel): a sample from -1 to 1. Default: 440 Hz.
  std::function<double(double, int)> sound;
};

// The path's ending chooses the format: .mkv .mp4 .mov .avi .ts .png ("%02d.png": numbered pictures) .. Tags are the
// container's. Throws std::runtime_error with the reason when it cannot be made.
void makeClip(const std::string& path, const std::vector<ClipTrack>& tracks,
              const std::map<std::string, std::string>& tags = {}, const std::vector<ClipSound>& sounds = {});

// The sample of component `component` at (column, row), read as hal/media/frame.h says.
[[nodiscard]] std::uint32_t sampleAt(const Frame& frame, int component, int column, int row) noexcept;

// A new folder for a test's files, removed with all that is in it when the object goes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace relievo::test
