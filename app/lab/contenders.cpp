// SPDX-License-Identifier: Apache-2.0
// The list of contenders.
#include "app/lab/contenders.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace relievo {
namespace {

constexpr MethodConfig parts(std::optional<SpaceLaw> space, std::optional<TimeLaw> time) {
  return {.space = space, .time = time, .jump_threshold = false};
}

constexpr MethodConfig oneWidth(double mm) {
  MethodConfig config{.jump_threshold = false};
  config.scale = FeltScale{.narrow_mm = mm, .wide_mm = mm};
  return config;
}

constexpr MethodConfig kOwn = parts({}, {});
constexpr MethodConfig kTriangles = parts(SpaceLaw::Triangles, {});

constexpr std::array kContenders{
    Contender{"relievo", "relievo", kOwn, "bspline", "own"},
    Contender{"god-object", "relievo", kTriangles, "triangles", "linear"},
    Contender{"modified-proxy-graph", "modified-proxy-graph", kOwn, "triangles", "linear"},
    Contender{"proxy-graph", "proxy-graph", kOwn, "triangles", "hold"},
    Contender{"proxy-blend", "proxy-blend", kOwn, "triangles", "hold"},
    Contender{"penalty", "penalty", kOwn, "triangles", "linear"},

    Contender{"quadratic", "relievo", parts(SpaceLaw::Quadratic, {}), "quadratic", "own", true},
    Contender{"time hold", "relievo", parts({}, TimeLaw::Hold), "bspline", "hold", true},
    Contender{"time linear", "relievo", parts({}, TimeLaw::Linear), "bspline", "linear", true},
    Contender{"time bspline", "relievo", parts({}, TimeLaw::BSpline), "bspline", "bspline", true},
    Contender{"time fitted", "relievo", parts({}, TimeLaw::Fitted), "bspline", "fitted", true},
    Contender{"width 0.28", "relievo", oneWidth(0.28), "bspline", "own", true},
    Contender{"width 0.43", "relievo", oneWidth(0.43), "bspline", "own", true},
    Contender{"width 0.72", "relievo", oneWidth(0.72), "bspline", "own", true},
    Contender{"width 1.0", "relievo", oneWidth(1.0), "bspline", "own", true},
    Contender{"god-object hold", "relievo", parts(SpaceLaw::Triangles, TimeLaw::Hold), "triangles", "hold", true},
    Contender{"proxy-graph linear", "proxy-graph", parts({}, TimeLaw::Linear), "triangles", "linear", true},
    Contender{"modified hold", "modified-proxy-graph", parts({}, TimeLaw::Hold), "triangles", "hold", true},
};

}  // namespace

std::span<const Contender> contenders() {
  return kContenders;
}

const Contender* contender(std::string_view label) {
  const auto found =
      std::find_if(kContenders.begin(), kContenders.end(), [&](const Contender& c) { return label == c.label; });
  return found == kContenders.end() ? nullptr : &*found;
}

}  // namespace relievo
