// SPDX-License-Identifier: Apache-2.0
// The list of methods, each a row of parts.
#include "app/haptics/baseline/methods.h"

#include <algorithm>
#include <array>

#include "app/haptics/baseline/penalty.h"
#include "app/haptics/baseline/proxy_blend.h"
#include "app/haptics/baseline/triangle_proxy.h"
#include "app/haptics/method/relievo_method.h"

namespace relievo {

const char* const kMethodNames = "relievo modified-proxy-graph proxy-graph proxy-blend penalty";
const char* const kDefaultMethod = "relievo";

namespace {

struct Row {
  std::string_view method;
  TimeLaw time;  // on triangles
};
constexpr std::array kRows{
    Row{"relievo", TimeLaw::Linear},   Row{"modified-proxy-graph", TimeLaw::Linear},
    Row{"proxy-graph", TimeLaw::Hold}, Row{"proxy-blend", TimeLaw::Hold},
    Row{"penalty", TimeLaw::Linear},
};

}  // namespace

const char* name(SpaceLaw law) noexcept {
  switch (law) {
    case SpaceLaw::Triangles:
      return "triangles";
    case SpaceLaw::Quadratic:
      return "quadratic";
    case SpaceLaw::BSpline:
      return "bspline";
  }
  return "";
}

std::optional<MethodParts> partsOf(std::string_view method, const MethodConfig& config) {
  if (method == "relievo" && config.space != SpaceLaw::Triangles) {
    FeltScale scale = config.scale.value_or(FeltScale{});
    if (config.time) scale.narrow_time = scale.wide_time = *config.time;
    scale.space = config.space.value_or(scale.space);
    return MethodParts{scale.space, scale.wide_time, scale};
  }
  const auto row = std::find_if(kRows.begin(), kRows.end(), [&](const Row& r) { return r.method == method; });
  if (row == kRows.end() || config.space.value_or(SpaceLaw::Triangles) != SpaceLaw::Triangles) return std::nullopt;
  const TimeLaw time = config.time.value_or(row->time);
  const bool known = time == TimeLaw::Hold || (time == TimeLaw::Linear && method != "proxy-blend");
  return known ? std::optional(MethodParts{SpaceLaw::Triangles, time, {}}) : std::nullopt;
}

std::unique_ptr<TouchMethod> makeMethod(std::string_view method, const MethodConfig& config) {
  const auto parts = partsOf(method, config);
  if (!parts) return nullptr;
  const double stiffness = config.stiffness_n_per_mm;
  const auto threshold = [&](bool own) {
    return config.jump_threshold.value_or(own) ? TriangleProxy::kJumpThresholdN : 0.0;
  };
  const auto onTriangles = [&](Walk walk, bool carry, bool guarded) {
    return std::make_unique<TriangleProxy>(stiffness, TriangleParts{walk, parts->time, carry, threshold(guarded)});
  };
  if (parts->scale) {
    return std::make_unique<RelievoMethod>(RelievoMethod::Config{.stiffness_n_per_mm = stiffness,
                                                                 .scale = *parts->scale,
                                                                 .friction = config.friction,
                                                                 .texture = config.texture,
                                                                 .places = config.places,
                                                                 .jump_threshold_n = threshold(false),
                                                                 .tick_s = config.tick_s});
  }
  if (method == "relievo") return onTriangles(Walk::Faces, true, false);
  if (method == "modified-proxy-graph") return onTriangles(Walk::Graph, true, true);
  if (method == "proxy-graph") return onTriangles(Walk::Graph, false, false);
  if (method == "proxy-blend") return std::make_unique<ProxyBlend>(stiffness, threshold(false));
  return std::make_unique<Penalty>(stiffness, parts->time);
}

}  // namespace relievo
