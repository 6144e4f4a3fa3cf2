// SPDX-License-Identifier: Apache-2.0
// Who is measured against whom: methods and the parts that they can be made of, with their names on the charts.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "app/haptics/methods.h"

namespace relievo {

struct Contender {
  const char* label;  // on a chart
  const char* method;
  MethodConfig config;  // without the jump threshold: the guard would hide what is measured
  const char* space;
  const char* time;
  bool fixed_choice = false;  // one part swapped: for the chart of parts

  [[nodiscard]] std::unique_ptr<TouchMethod> make() const { return makeMethod(method, config); }
};

// The methods as they are, `relievo` first; then the same with one part swapped.
[[nodiscard]] std::span<const Contender> contenders();
// Null for a label that is not known.
[[nodiscard]] const Contender* contender(std::string_view label);

}  // namespace relievo
