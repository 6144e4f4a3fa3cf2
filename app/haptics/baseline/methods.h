// SPDX-License-Identifier: Apache-2.0
// The touch methods by name, and the parts that they are made of.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "app/depth_window/parts.h"
#include "app/haptics/method/felt_surface.h"
#include "app/haptics/method/method.h"
#include "app/scene/material.h"

namespace relievo {

struct MethodConfig {
  double stiffness_n_per_mm = 0.5;
  double tick_s = 0.001;               // the task's period
  std::optional<SpaceLaw> space;       // nullopt: the method's own
  std::optional<TimeLaw> time;         // nullopt: the method's own
  std::optional<bool> jump_threshold;  // the paper's guard (IV-C); nullopt: the method's own
  Friction friction;                   // only for `relievo` on a smooth surface, as is the texture
  Texture texture;
  HeldScale places;                // likewise
  std::optional<FeltScale> scale;  // for `relievo`: the widths that the film needs (see touch_plan.h)
};

extern const char* const kMethodNames;    // "relievo modified-proxy-graph .."
extern const char* const kDefaultMethod;  // the method of `relievo play`

[[nodiscard]] const char* name(SpaceLaw law) noexcept;  // triangles quadratic bspline

// The parts of a method.
struct MethodParts {
  SpaceLaw space = SpaceLaw::Triangles;
  TimeLaw time = TimeLaw::Linear;  // for `relievo`: of the wide level
  std::optional<FeltScale> scale;  // only for `relievo` on a smooth surface
};

// Nullopt for an unknown name, and for parts that cannot be combined: the methods on triangles have a space law of
// their own, and use only the surface between two frames (hold, linear; proxy-blend blends held frames). `relievo` with
// triangles in space is a converged god-object on the paper's surface.
[[nodiscard]] std::optional<MethodParts> partsOf(std::string_view method, const MethodConfig& config);

// Null if `partsOf` returns nullopt. Allocates: call before the real-time task starts.
[[nodiscard]] std::unique_ptr<TouchMethod> makeMethod(std::string_view method, const MethodConfig& config);

}  // namespace relievo
