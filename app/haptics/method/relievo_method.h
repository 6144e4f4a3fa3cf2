// SPDX-License-Identifier: Apache-2.0
// The default method: a proxy on the true closest point of a moving surface at the scale that a finger feels.
#pragma once

#include <cstdint>

#include "app/haptics/method/closest_point.h"
#include "app/haptics/method/felt_surface.h"
#include "app/haptics/method/method.h"

namespace relievo {

// Coulomb friction between proxy and surface; 0: none.
struct Friction {
  double static_coefficient = 0, dynamic_coefficient = 0;
};

// Contact is a matter of inside and outside, not of crossing: a finger that was outside is in contact in the first tick
// in which it is inside the solid, whoever of the two moved, and its path within the tick is sampled closer than the
// surface has crests. So nothing passes through, however fast it rises. In contact the proxy slides to the closest
// point (see closestPoint) and is free when that point is no longer above the finger, or when the finger has gone out
// through a wall and no ridge is between them.
//
// At a cut, and wherever else the film is not continuous, a finger left inside the new solid is re-seated: the new
// surface is lowered under it until it is as deep as it was before, so that it feels the new shape at once and at no
// more force. The lowering leaves as the finger allows: while the force is no more than it was, and when it lifts.
class RelievoMethod final : public TouchMethod {
 public:
  struct Config {
    double stiffness_n_per_mm = 0.5;
    FeltScale scale;
    Friction friction;
    double jump_threshold_n = 0;   // the paper's guard (IV-C) on top; 0: none, the re-seating needs none
    double rise_mm_per_s = 100.0;  // how fast a lowered surface comes back: 50 N/s on 0.5 N/mm
    double tick_s = 0.001;         // the task's period
  };
  explicit RelievoMethod(const Config& config) noexcept : config_(config), surface_(config.scale) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void prefetch(const SurfaceWindow& window) const RELIEVO_RT override;
  void upkeep(const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override { state_ = State::Unknown; }

  // For tests, between `update` and `upkeep`: how far this tick's finger lies below the surface as it is felt, and
  // whether it is free because it has been inside from the beginning.
  [[nodiscard]] double depthMm() RELIEVO_RT;
  [[nodiscard]] bool buried() const RELIEVO_RT { return state_ == State::Buried; }
  // For tests: what all ticks so far have read.
  [[nodiscard]] std::uint64_t blocksRead() const RELIEVO_RT { return surface_.blocksRead(); }

 private:
  enum class State : std::uint8_t {
    Unknown,  // before the first tick
    Buried,   // inside from the beginning: free until it has been outside
    Free,     // outside
    Contact,
  };
  [[nodiscard]] bool inside(const glm::dvec3& place_mm) RELIEVO_RT;
  [[nodiscard]] bool isOtherScene(const SurfaceWindow& window) RELIEVO_RT;
  void changeState(const glm::dvec3& hip_mm, bool other_scene) RELIEVO_RT;
  void slideAlong(const glm::dvec3& hip_mm) RELIEVO_RT;
  [[nodiscard]] Touch touchAt(const glm::dvec3& hip_mm) RELIEVO_RT;
  void foresee(const glm::dvec3& hip_mm, const Contact& before, bool continues) RELIEVO_RT;
  void enterScene(const glm::dvec3& hip_mm) RELIEVO_RT;
  void slide(const glm::dvec3& hip_mm, SlideUntil until) RELIEVO_RT;
  [[nodiscard]] bool sweptAway(const glm::dvec3& hip_mm) RELIEVO_RT;
  [[nodiscard]] bool offTheEdge() RELIEVO_RT;
  void rub(const glm::dvec3& hip_mm) RELIEVO_RT;
  [[nodiscard]] bool enterOnPath(const glm::dvec3& from_mm, const glm::dvec3& hip_mm) RELIEVO_RT;
  void follow(glm::dvec3 from_mm, const glm::dvec3& hip_mm) RELIEVO_RT;
  void settleLowering(const glm::dvec3& hip_mm) RELIEVO_RT;
  [[nodiscard]] glm::dvec3 proxy() const RELIEVO_RT;

  Config config_;
  FeltSurface surface_;
  State state_ = State::Unknown;
  std::uint32_t epoch_ = 0, shot_ = 0;
  bool had_surface_ = false;
  MediaTime now_;  // of the last upkeep
  glm::dvec3 hip_mm_{0};
  Contact contact_;
  double rise_mm_ = 0;  // of the surface under the proxy in the last tick
  // Where proxy and finger were when the one had last gone no further than the other explains.
  glm::dvec2 own_place_mm_{0};
  glm::dvec3 own_hip_mm_{0};
  bool on_its_way_ = false;  // the proxy has not arrived yet where the finger has sent it
  bool rubbing_ = false, sliding_ = false;
  Contact stuck_;          // where friction last held the proxy
  double lowered_mm_ = 0;  // of the surface, after a cut
  double force_before_cut_n_ = 0;
  glm::dvec3 force_n_{0};
  glm::dvec2 ahead_mm_{0};  // where the proxy, or the free finger, will be in the next tick
};

}  // namespace relievo
