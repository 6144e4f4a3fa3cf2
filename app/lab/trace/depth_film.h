// SPDX-License-Identifier: Apache-2.0
// A depth film on virtual time: the window of frames around any moment, for as long as time goes forward.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/depth_window/window_frames.h"
#include "app/media/pair_reader.h"
#include "app/scene/display_volume.h"
#include "platform/failure.h"

namespace relievo {

struct DepthFilmOptions {
  SourceOptions source;  // a single plain video track is read as depth; anything else as the player reads it
  std::optional<DisplayVolume> volume;  // nullopt: the default one, its height from the picture's shape
  std::optional<double> frames_per_s;   // for sources without timestamps; nullopt: the source's own times
};

// Reads ahead as far as a window reaches and drops what lies behind it, so that a film of any length fits into memory.
class DepthFilm {
 public:
  DepthFilm(const PairReader::Backends& backends, DepthFilmOptions options);
  ~DepthFilm();

  [[nodiscard]] Outcome<void> open();
  // The frames from two before the one at `t_s` to four after it; time 0 is the first frame's. Times must not go back.
  [[nodiscard]] Outcome<const SurfaceWindow*> windowAt(double t_s);
  [[nodiscard]] const DisplayVolume& volume() const noexcept { return volume_; }
  [[nodiscard]] const Material& material() const noexcept { return material_; }
  // Why the depth may be read wrongly, one line each.
  [[nodiscard]] const std::vector<std::string>& doubts() const noexcept { return doubts_; }

 private:
  struct Tracks;
  [[nodiscard]] Result<std::optional<Frame>> nextFrame();
  [[nodiscard]] Outcome<bool> append();

  DepthFilmOptions options_;
  std::unique_ptr<Tracks> tracks_;
  DisplayVolume volume_;
  DepthCalibration calibration_;
  Material material_;
  std::vector<std::string> doubts_;
  SampleOrder order_ = SampleOrder::AsStored;  // of a single track
  WindowFrames frames_;
  std::optional<TimedSurface> newest_;
  std::optional<MediaTime> first_pts_;
  std::int64_t frame_count_ = 0;
  bool ended_ = false;
  SurfaceWindow window_;
};

}  // namespace relievo
