// SPDX-License-Identifier: Apache-2.0
// The surfaces that the laboratory measures against: known exactly at every place and every moment.
#pragma once

#include <glm/vec2.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "app/scene/display_volume.h"

namespace relievo {

// S(x, y, t) and its derivatives by mm and s.
struct SurfaceJet {
  double z = 0;
  double zx = 0, zy = 0;
  double zxx = 0, zxy = 0, zyy = 0;
  double zt = 0;
};

// Two level floors with an upright wall between them. The high floor is where q = normal . (x, y) - offset < 0; the
// wall is part of the surface, from the low floor up to the high one.
struct StepWall {
  glm::dvec2 normal{1, 0};  // unit, from the high floor to the low one
  double offset_mm = 0;
  double high_mm = 0, low_mm = 0;

  [[nodiscard]] double distance(double x_mm, double y_mm) const {
    return normal.x * x_mm + normal.y * y_mm - offset_mm;
  }
};

// Immutable, double precision, in the scene frame of kVolume with heights in [0, 40] mm from time 0 to `duration_s`.
// The formula goes on beyond the picture's rim.
class TrueSurface {
 public:
  static constexpr DisplayVolume kVolume{160, 108, 40};

  struct Traits {
    // Twice differentiable in space and time, and no convex place is tighter than 6 mm: what counts for accuracy.
    bool smooth = true;
    double max_speed_mm_per_s = 0;  // bound of |dS/dt| in the picture; with a wall: the wall's own speed
    double duration_s = std::numeric_limits<double>::infinity();  // after that it leaves the volume
  };

  explicit TrueSurface(const Traits& traits) : traits_(traits) {}
  virtual ~TrueSurface() = default;
  TrueSurface(const TrueSurface&) = delete;
  TrueSurface& operator=(const TrueSurface&) = delete;

  [[nodiscard]] const Traits& traits() const { return traits_; }
  [[nodiscard]] virtual double height(double x_mm, double y_mm, double t_s) const = 0;
  // The heights at (x_mm[i], y_mm) at one moment, for whole pictures; `out` is as long as `x_mm`.
  virtual void heights(std::span<const double> x_mm, double y_mm, double t_s, std::span<double> out) const = 0;
  // On a step: the jet of the floor at that place; `wallAt` describes the wall.
  [[nodiscard]] virtual SurfaceJet jet(double x_mm, double y_mm, double t_s) const = 0;
  // Set if the scene is a step and not one smooth sheet: its edges and its wall are not differentiable. A wall moves at
  // constant speed along its normal.
  [[nodiscard]] virtual std::optional<StepWall> wallAt(double /*t_s*/) const { return std::nullopt; }
  // The shot that the moment belongs to; the surface changes from shot to shot.
  [[nodiscard]] virtual int shotAt(double /*t_s*/) const { return 0; }

 private:
  Traits traits_;
};

struct SceneOptions {
  double speed_mm_per_s = 20;     // of `rise` and `step-moving`, either sign
  double cut_s = 0.5 + 0.5 / 30;  // of the cuts; between two frames of 30 and of 15 frames/s
};

// plane, shallow-plane (slope 0.033), sphere, face; each of plane, sphere, face also -sliding (4 mm at 0.53 Hz, to the
// sides) and -heaving (2 mm at 0.67 Hz, to the viewer); face-nodding (3 mm at 0.71 Hz to the viewer and 4 mm at 0.53 Hz
// to the sides); ridge, groove; step, step-moving (15 mm, slanted by 0.3); rise (a nearly level plane); cut (face, then
// sphere), cut-up (by 18 mm), cut-down (by 9 mm).
[[nodiscard]] std::span<const std::string_view> trueSurfaceNames();
// Null for an unknown name.
[[nodiscard]] std::unique_ptr<TrueSurface> makeTrueSurface(std::string_view name, const SceneOptions& options = {});

}  // namespace relievo
