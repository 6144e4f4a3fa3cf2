// SPDX-License-Identifier: Apache-2.0
// The list of methods.
#include "app/haptics/methods.h"

#include "app/haptics/modified_proxy_graph.h"
#include "app/haptics/proxy_graph.h"

namespace relievo {

const char* const kMethodNames = "proxy-graph modified-proxy-graph";
const char* const kDefaultMethod = "modified-proxy-graph";

std::optional<TimeLaw> timeLaw(std::string_view name) noexcept {
  if (name == "hold") return TimeLaw::Hold;
  if (name == "linear") return TimeLaw::Linear;
  return std::nullopt;
}

std::unique_ptr<TouchMethod> makeMethod(std::string_view name, const MethodConfig& config) {
  const double stiffness = config.stiffness_n_per_mm;
  const auto threshold = [&](bool own) {
    return config.jump_threshold.value_or(own) ? ModifiedProxyGraph::kJumpThresholdN : 0.0;
  };
  if (name == "proxy-graph") {
    return std::make_unique<ProxyGraph>(stiffness, config.time.value_or(TimeLaw::Hold), threshold(false));
  }
  if (name == "modified-proxy-graph") {
    return std::make_unique<ModifiedProxyGraph>(stiffness, config.time.value_or(TimeLaw::Linear), threshold(true));
  }
  return nullptr;
}

}  // namespace relievo
