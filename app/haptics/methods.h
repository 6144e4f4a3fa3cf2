// SPDX-License-Identifier: Apache-2.0
// The methods of touch by name, and the parts that they are made of.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "app/haptics/method.h"

namespace relievo {

// How a surface lies between two frames.
enum class TimeLaw : std::uint8_t {
  Hold,    // the newest frame as it is
  Linear,  // between the frame before and the buffered next one (paper, eq. 1)
};
[[nodiscard]] std::optional<TimeLaw> timeLaw(std::string_view name) noexcept;  // hold linear

struct MethodConfig {
  double stiffness_n_per_mm = 0.5;
  std::optional<TimeLaw> time;         // nothing: the method's own
  std::optional<bool> jump_threshold;  // the paper's guard (IV-C); nothing: the method's own
};

extern const char* const kMethodNames;    // "proxy-graph modified-proxy-graph"
extern const char* const kDefaultMethod;  // what `relievo play` touches with

// Null for a name that is not known. Allocates: before the real-time task starts.
[[nodiscard]] std::unique_ptr<TouchMethod> makeMethod(std::string_view name, const MethodConfig& config);

}  // namespace relievo
