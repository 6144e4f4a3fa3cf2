// SPDX-License-Identifier: Apache-2.0
// The relief at the scale that a finger feels: smooth, with its edges kept.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "app/depth_window/felt_scale.h"
#include "app/depth_window/surface_window.h"
#include "app/haptics/method/smooth_level.h"
#include "app/haptics/method/surface_level.h"
#include "hal/media/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// Blocks counted per frame. A tick of a millisecond that has read more leaves optional work to later ticks, a shorter
// one after its share of them, but not before a frame's.
inline constexpr std::uint64_t kBlocksOfTick = 256;
[[nodiscard]] std::uint64_t mostBlocksOf(double tick_s) noexcept;
// A frame has 16 narrow blocks around one place, and 32, with their rims, of a smooth level. A tick that has read that
// many does not prepare the next tick, which may read more, of up to four levels. With a lower bound too few ticks of a
// moving finger would be prepared: with 24, one of 40 fingers at a noisy edge fell off it 2.5 mm early, with 48 none.
inline constexpr std::uint64_t kBlocksOfFrame = 48;

// S = N + c(W - N): the narrow level N keeps edges, the smooth level W has little noise, and c is a soft clamp, so that
// W can remove N's noise but cannot round an edge by more than `clamp_mm`. Away from edges S equals W. c is monotone,
// since otherwise an edge would get a lip. A moving edge is displaced in N from frame to frame instead of being
// cross-faded. Frames that repeat each other count as one, so that a still film costs no more than a picture.
// A view of one window at one moment; reads depth on demand.
class FeltSurface {
 public:
  explicit FeltSurface(const FeltScale& scale, double tick_s = 0.001) noexcept;

  // False if there is no frame. Frames of the window must stay valid until the next call only.
  bool moveTo(const SurfaceWindow& window, MediaTime now) RELIEVO_RT;

  [[nodiscard]] SurfacePoint at(double x_mm, double y_mm) RELIEVO_RT;
  [[nodiscard]] double height(double x_mm, double y_mm) RELIEVO_RT;
  // The nearest unsmoothed sample: the lower of the present frame's and the next one's. Reads two samples where the
  // smooth surface needs hundreds. At a hole or outside the picture it is below every height.
  [[nodiscard]] double lowestSample(double x_mm, double y_mm) const RELIEVO_RT;
  // Prefetches those two samples.
  void prefetchSample(double x_mm, double y_mm) const RELIEVO_RT;

  // Half the narrow pitch: a path sampled this densely misses no crest of the surface.
  [[nodiscard]] double sampleMm() const RELIEVO_RT { return sample_mm_; }
  [[nodiscard]] std::uint32_t shot() const RELIEVO_RT { return shot_; }
  [[nodiscard]] double volumeDepthMm() const RELIEVO_RT { return depth_mm_; }
  // Blocks of samples read so far, in total.
  [[nodiscard]] std::uint64_t blocksRead() const RELIEVO_RT {
    return narrow_.grid().blocksRead() + smooth_.blocksRead();
  }
  // More than mostBlocksOf the tick, or at least kBlocksOfFrame, since `moveTo`.
  [[nodiscard]] bool hasReadMuch() const RELIEVO_RT { return blocksRead() - read_before_ > most_blocks_; }
  [[nodiscard]] bool hasReadAFrame() const RELIEVO_RT { return blocksRead() - read_before_ >= kBlocksOfFrame; }

  // True if `prepare` was called for this moment and these frames.
  [[nodiscard]] bool asPrepared() const RELIEVO_RT { return as_prepared_; }

  // Call after `moveTo` with the same window: prepares for a tick expected at `next`, with the proxy near (x, y). The
  // preparation stays valid while the contributing frames are the same, even in a newer window. `mm_per_s`: the proxy's
  // velocity; the frame that gets a weight next is read where the proxy will then be.
  void prepare(const SurfaceWindow& window, MediaTime next, double x_mm, double y_mm,
               const glm::dvec2& mm_per_s = glm::dvec2(0)) RELIEVO_RT;
  // Prefetches everything except the control points, which a prepared tick does not need.
  void prefetch() const RELIEVO_RT;

 private:
  [[nodiscard]] bool sampleAt(double x_mm, double y_mm, int& c, int& r) const RELIEVO_RT;
  [[nodiscard]] SurfacePoint narrowAt(double x_mm, double y_mm) RELIEVO_RT;
  void followEdge(const SurfaceWindow& window, MediaTime next, const FrameMoment& moment, double x_mm,
                  double y_mm) RELIEVO_RT;
  void readAhead(const SurfaceWindow& window, MediaTime next, const FrameMoment& moment, const glm::dvec2& place_mm,
                 const glm::dvec2& mm_per_s) RELIEVO_RT;
  void setPicture(const SurfaceWindow& window) RELIEVO_RT;
  void placeFrames(const SurfaceWindow& window) RELIEVO_RT;

  FeltScale scale_;
  std::uint64_t most_blocks_;
  SurfaceLevel narrow_;
  SmoothLevel smooth_;
  bool two_levels_;
  double sample_mm_ = 0.2;
  double depth_mm_ = 40;
  std::uint64_t read_before_ = 0;  // before this moment

  std::uint32_t epoch_ = 0, shot_ = 0;
  int cols_ = 0, rows_ = 0;
  FrameSlots slots_;
  std::size_t present_ = 0, next_ = 0;  // indices of frames in the window
  std::array<MediaTime, ControlGrid::kFrames> time_of_slot_{};
  MediaTime first_time_, last_time_;
  int count_ = 0;

  // How the edge near a place moves from one frame to the next, and the narrow level with it.
  struct FollowedEdge {
    glm::dvec2 way_mm{0}, place_mm{0};
    MediaTime from = MediaTime::min();  // time of the frame it starts from
    MediaTime looked;
    bool moves = false;  // at this moment
    double share = 0;    // of the displacement, at this moment
  };
  FollowedEdge edge_;

  // The first and last frame with a weight at a moment, and the present one. Since frames are in order, equality of
  // these three implies that all frames between are equal.
  struct Weighed {
    MediaTime first, present, last;
    bool operator==(const Weighed&) const = default;
  };
  [[nodiscard]] static Weighed weighedAt(const SurfaceWindow& window, const FrameMoment& moment) RELIEVO_RT;

  // The moment that the levels are prepared for, and the frames used.
  bool prepared_ = false, as_prepared_ = false;
  MediaTime prepared_for_;
  Weighed prepared_on_;
};

}  // namespace relievo
