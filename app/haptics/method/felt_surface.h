// SPDX-License-Identifier: Apache-2.0
// The relief at the scale that a finger feels: smooth where it is smooth, an edge where there is an edge.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "app/depth_window/felt_scale.h"
#include "app/depth_window/surface_window.h"
#include "app/haptics/method/surface_level.h"
#include "hal/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// Of blocks, each in each frame. A tick that has read more leaves to the next ones what can wait.
inline constexpr std::uint64_t kBlocksOfTick = 256;

// S = N + c(W - N): N sees edges, W is calm, and c is a soft clamp, so that W may correct N's noise but not round an
// edge off by more than `clamp_mm`; away from edges S is W. Monotone: c never turns back, or a lip would be left at an
// edge. Where an edge moves, N moves with it from frame to frame instead of fading one into the other. Frames that
// repeat each other are one: a film that stands still costs what a picture does.
// A view for one moment of one window; reads depth where it is asked for.
class FeltSurface {
 public:
  explicit FeltSurface(const FeltScale& scale) noexcept;

  // False: there is no frame. Not later than the next call, every frame that was in the window may be gone.
  bool moveTo(const SurfaceWindow& window, MediaTime now) RELIEVO_RT;

  [[nodiscard]] SurfacePoint at(double x_mm, double y_mm) RELIEVO_RT;
  [[nodiscard]] double height(double x_mm, double y_mm) RELIEVO_RT;
  // The nearest sample as it is, the lower one of the present frame's and the next one's: two looks at the pictures for
  // hundreds. Below everything at a hole or outside.
  [[nodiscard]] double lowestSample(double x_mm, double y_mm) const RELIEVO_RT;

  // Half the narrow pitch: a path sampled so closely sees every crest that the surface has.
  [[nodiscard]] double sampleMm() const RELIEVO_RT { return sample_mm_; }
  [[nodiscard]] std::uint32_t shot() const RELIEVO_RT { return shot_; }
  [[nodiscard]] double volumeDepthMm() const RELIEVO_RT { return depth_mm_; }
  // Blocks of samples that were read so far: what the scene has cost.
  [[nodiscard]] std::uint64_t blocksRead() const RELIEVO_RT {
    return narrow_.grid().blocksRead() + wide_.grid().blocksRead();
  }
  // More than kBlocksOfTick since `moveTo`.
  [[nodiscard]] bool hasReadMuch() const RELIEVO_RT { return blocksRead() - read_before_ > kBlocksOfTick; }

  // After `moveTo`, on the same window: what can be done ahead of a tick that is likely to come at `next`, with the
  // proxy near (x, y). It holds as long as the frames that count are the same, though the window has gone on.
  void prepare(const SurfaceWindow& window, MediaTime next, double x_mm, double y_mm) RELIEVO_RT;
  // All but the control points: a tick that was prepared for needs none of them.
  void prefetch() const RELIEVO_RT;

 private:
  [[nodiscard]] SurfacePoint narrowAt(double x_mm, double y_mm) RELIEVO_RT;
  void followEdge(const SurfaceWindow& window, MediaTime next, const FrameMoment& moment, double x_mm,
                  double y_mm) RELIEVO_RT;
  void setPicture(const SurfaceWindow& window) RELIEVO_RT;
  void placeFrames(const SurfaceWindow& window) RELIEVO_RT;

  FeltScale scale_;
  SurfaceLevel narrow_, wide_;
  bool two_levels_;
  double sample_mm_ = 0.2;
  double depth_mm_ = 40;
  std::uint64_t read_before_ = 0;  // this moment

  std::uint32_t epoch_ = 0, shot_ = 0;
  int cols_ = 0, rows_ = 0;
  FrameSlots slots_;
  std::size_t present_ = 0, next_ = 0;  // of the window's frames
  std::array<MediaTime, ControlGrid::kFrames> time_of_slot_{};
  MediaTime first_time_, last_time_;
  int count_ = 0;

  // How the edge near a place moves from one frame to the next, and the narrow level with it.
  glm::dvec2 edge_way_mm_{0}, edge_place_mm_{0};
  MediaTime edge_from_ = MediaTime::min();  // the frame's time
  MediaTime edge_looked_;
  bool edge_moves_ = false;  // at this moment
  double share_ = 0;         // of the way, at this moment

  // The first and the last frame that have a weight at a moment, and the present one. Frames come in their order: where
  // these three are the same, so are all between.
  struct Weighed {
    MediaTime first, present, last;
    bool operator==(const Weighed&) const = default;
  };
  [[nodiscard]] static Weighed weighedAt(const SurfaceWindow& window, const FrameMoment& moment) RELIEVO_RT;

  // For which moment the levels are prepared, and on which frames.
  bool prepared_ = false;
  MediaTime prepared_for_;
  Weighed prepared_on_;
};

}  // namespace relievo
