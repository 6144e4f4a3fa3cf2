// SPDX-License-Identifier: Apache-2.0
// The laboratory's truth: the exact god-object on a true surface at the exact time. Offline, double precision, slow.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/lab/truth/true_surface.h"

namespace relievo {

struct TrueTouch {
  glm::dvec3 proxy_mm{0};  // on the surface; the finger itself without contact
  bool contact = false;
};

// Between two calls the finger moves straight and at constant speed, and the surface moves by its formula.
// - A free finger comes into contact where it goes through the surface, or the surface through it, from outside.
// - In contact the proxy slides so that its distance to the finger falls, without unneeded jumps, to the local minimum
//   that it can reach from its position: within 1e-12 mm on a smooth sheet, exactly on a step's floors, wall and edges.
// - Contact ends when the finger is outside: z >= S at its own x, y and time.
// - A finger that begins inside, or that a cut puts inside, is free until it has been outside: a cut resets all state.
// It shares no code with app/haptics, so that one mistake cannot be on both sides of a comparison.
class Oracle {
 public:
  // `surface` must outlive it.
  explicit Oracle(const TrueSurface& surface) : surface_(surface) {}

  // Times must not go back.
  [[nodiscard]] TrueTouch update(const glm::dvec3& hip_mm, double t_s);
  void reset() { state_ = State::New; }

 private:
  enum class State : std::uint8_t { New, Buried, Free, Contact };

  void followSheet(const glm::dvec3& hip, double t);
  void passSheet(const glm::dvec3& hip, double t, double tolerance_mm);
  void followStep(const glm::dvec3& hip, const StepWall& before, const StepWall& now);
  [[nodiscard]] bool outside(const glm::dvec3& hip, double t) const {
    return hip.z >= surface_.height(hip.x, hip.y, t);
  }

  const TrueSurface& surface_;
  State state_ = State::New;
  glm::dvec3 hip_{0};  // of the moment before
  double t_ = 0;
  glm::dvec2 proxy_{0};    // x, y: in contact with a sheet
  glm::dvec2 section_{0};  // q, z: in contact with a step
};

}  // namespace relievo
