// SPDX-License-Identifier: Apache-2.0
// The list of methods, each a row of parts.
#include "app/haptics/methods.h"

#include "app/haptics/penalty.h"
#include "app/haptics/proxy_blend.h"
#include "app/haptics/relievo_method.h"
#include "app/haptics/triangle_proxy.h"

namespace relievo {

const char* const kMethodNames = "relievo modified-proxy-graph proxy-graph proxy-blend penalty";
const char* const kDefaultMethod = "relievo";

std::unique_ptr<TouchMethod> makeMethod(std::string_view name, const MethodConfig& config) {
  const double stiffness = config.stiffness_n_per_mm;
  const auto threshold = [&](bool own) {
    return config.jump_threshold.value_or(own) ? TriangleProxy::kJumpThresholdN : 0.0;
  };
  const auto onTriangles = [&](Walk walk, TimeLaw time, bool carry, bool guarded) {
    return std::make_unique<TriangleProxy>(stiffness,
                                           TriangleParts{walk, config.time.value_or(time), carry, threshold(guarded)});
  };
  if (name == "relievo" && config.space != SpaceLaw::Triangles) {
    RelievoMethod::Config own{.stiffness_n_per_mm = stiffness,
                              .scale = config.scale.value_or(FeltScale{}),
                              .jump_threshold_n = threshold(false)};
    if (config.time) own.scale.narrow_time = own.scale.wide_time = *config.time;
    own.scale.space = config.space.value_or(own.scale.space);
    return std::make_unique<RelievoMethod>(own);
  }
  if (config.time && *config.time != TimeLaw::Hold && *config.time != TimeLaw::Linear) return nullptr;
  if (name == "relievo") return onTriangles(Walk::Faces, TimeLaw::Linear, true, false);
  if (config.space.value_or(SpaceLaw::Triangles) != SpaceLaw::Triangles) return nullptr;
  if (name == "modified-proxy-graph") return onTriangles(Walk::Graph, TimeLaw::Linear, true, true);
  if (name == "proxy-graph") return onTriangles(Walk::Graph, TimeLaw::Hold, false, false);
  if (name == "proxy-blend") return std::make_unique<ProxyBlend>(stiffness, threshold(false));
  if (name == "penalty") return std::make_unique<Penalty>(stiffness, config.time.value_or(TimeLaw::Linear));
  return nullptr;
}

}  // namespace relievo
