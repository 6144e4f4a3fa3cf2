// SPDX-License-Identifier: Apache-2.0
// The methods of touch by name, and the parts that they are made of.
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
  std::optional<SpaceLaw> space;       // nothing: the method's own
  std::optional<TimeLaw> time;         // nothing: the method's own
  std::optional<bool> jump_threshold;  // the paper's guard (IV-C); nothing: the method's own
  Friction friction;                   // of `relievo` on a smooth surface alone, as is the texture
  Texture texture;
  HeldScale places;                // likewise
  std::optional<FeltScale> scale;  // of `relievo`: what the scene needs (see touch_plan.h)
};

extern const char* const kMethodNames;    // "relievo modified-proxy-graph .."
extern const char* const kDefaultMethod;  // what `relievo play` touches with

[[nodiscard]] const char* name(SpaceLaw law) noexcept;  // triangles quadratic bspline

// What a method is made of.
struct MethodParts {
  SpaceLaw space = SpaceLaw::Triangles;
  TimeLaw time = TimeLaw::Linear;  // of `scale` the wide level's
  std::optional<FeltScale> scale;  // of `relievo` on a smooth surface alone
};

// Nothing for a name that is not known, and for parts that do not go together: the methods on triangles have no space
// law but their own, and know the surface between two frames alone (hold, linear; proxy-blend blends what it holds).
// `relievo` with triangles in space is a converged god-object on the paper's surface.
[[nodiscard]] std::optional<MethodParts> partsOf(std::string_view method, const MethodConfig& config);

// Null where `partsOf` answers nothing. Allocates: before the real-time task starts.
[[nodiscard]] std::unique_ptr<TouchMethod> makeMethod(std::string_view method, const MethodConfig& config);

}  // namespace relievo
