// SPDX-License-Identifier: Apache-2.0
// What a material takes from a scenario's figure by its own physics, whatever the method.
#pragma once

#include <optional>
#include <string_view>

#include "app/lab/scenario/judge.h"

namespace relievo {

struct MaterialTheory {
  Limit limit;            // of the figure that decided, on this material
  bool at_most = true;    // else at least
  bool explains = false;  // the verdict's figure is within it
};

// By the names of the map's row and of its scenario. Nullopt where the material changes nothing, where the scenario is
// passed, and where a figure of another unit decided.
[[nodiscard]] std::optional<MaterialTheory> theoryOf(std::string_view material, std::string_view scenario,
                                                     const Verdict& verdict);

}  // namespace relievo
