// SPDX-License-Identifier: Apache-2.0
// The default method: a proxy at the closest point of a moving surface, at the scale that a finger feels.
#pragma once

#include <cstdint>

#include "app/haptics/method/carried_proxy.h"
#include "app/haptics/method/closest_point.h"
#include "app/haptics/method/felt_surface.h"
#include "app/haptics/method/finger_spring.h"
#include "app/haptics/method/method.h"
#include "app/haptics/method/place_material.h"
#include "app/scene/material.h"

namespace relievo {

// Contact depends on being inside or outside, not on crossing: a finger that was outside makes contact in the first
// tick in which it is inside the solid, no matter whether the finger or the surface moved. Its path within the tick is
// sampled more densely than the surface has crests, so that nothing passes through, however fast it rises. In contact
// the proxy slides to the closest point (see closestPoint). Contact ends when that point is no longer above the finger,
// or when the finger has left through a wall and no ridge is between them.
//
// At a cut, and at any other discontinuity of the film, a finger left inside the new solid is re-seated: the new
// surface is lowered under it until the finger is as deep as before, so that it feels the new shape at once and with no
// more force. The lowering is undone while the force does not exceed its previous value, and when the finger lifts.
//
// Friction and texture change where the finger's spring ends, not which point is the closest (FingerSpring). A film's
// material track is read where the proxy is (MaterialReader).
class RelievoMethod final : public TouchMethod {
 public:
  struct Config {
    double stiffness_n_per_mm = 0.5;
    FeltScale scale;
    Friction friction;
    Texture texture;
    HeldScale places;             // of the film's material track, if it has one
    double jump_threshold_n = 0;  // additionally the paper's guard (IV-C); 0: off, re-seating does not need it
    double tick_s = 0.001;        // the task's period
  };
  explicit RelievoMethod(const Config& config) noexcept
      : config_(config),
        surface_(config.scale, config.tick_s),
        material_({config.stiffness_n_per_mm, config.friction, config.texture.amplitude_mm}, config.places),
        spring_(config.friction, config.texture, config.places, config.tick_s) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void prefetch(const SurfaceWindow& window) const RELIEVO_RT override;
  void upkeep(const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override { state_ = State::Unknown; }

  // For tests, between `update` and `upkeep`: the finger's depth below the surface as it is felt, and whether the
  // finger is free because it started inside.
  [[nodiscard]] double depthMm() RELIEVO_RT;
  [[nodiscard]] bool buried() const RELIEVO_RT { return state_ == State::Buried; }
  // For tests: true while friction drags, and shortly afterwards.
  [[nodiscard]] bool slides() const RELIEVO_RT { return spring_.slides(); }
  // For tests: blocks read in all ticks so far.
  [[nodiscard]] std::uint64_t blocksRead() const RELIEVO_RT { return surface_.blocksRead(); }

 private:
  enum class State : std::uint8_t {
    Unknown,  // before the first tick
    Buried,   // started inside: free until it has been outside
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
  [[nodiscard]] bool offTheEdge(const SurfaceWindow& window, MediaTime now) RELIEVO_RT;
  [[nodiscard]] bool enterOnPath(const glm::dvec3& from_mm, const glm::dvec3& hip_mm) RELIEVO_RT;
  void follow(glm::dvec3 from_mm, const glm::dvec3& hip_mm) RELIEVO_RT;
  void settleLowering(const glm::dvec3& hip_mm) RELIEVO_RT;
  [[nodiscard]] glm::dvec3 proxy() const RELIEVO_RT;

  Config config_;
  FeltSurface surface_;
  State state_ = State::Unknown;
  std::uint32_t epoch_ = 0, shot_ = 0;
  bool had_surface_ = false;
  MediaTime now_;  // time of the last upkeep
  glm::dvec3 hip_mm_{0};
  Contact contact_;
  double rise_mm_ = 0;  // rise of the surface under the proxy in the last tick
  CarriedProxy carried_;
  MaterialReader material_;
  FingerSpring spring_;
  double lowered_mm_ = 0;  // how far the surface is lowered, after a cut
  double force_before_cut_n_ = 0;
  glm::dvec3 force_n_{0};
  glm::dvec2 ahead_mm_{0};  // predicted position of the proxy, or of the free finger, in the next tick
};

}  // namespace relievo
