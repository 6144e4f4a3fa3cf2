// SPDX-License-Identifier: Apache-2.0
// How finely the relief is drawn: the levels of the chart of detail.
#pragma once

#include "app/render/gl/scene_renderer.h"

namespace relievo {

struct DrawnLevel {
  double error_px = SceneRenderer::kErrorPx;  // of the irregular network, as the player draws it
  int grid_step = 0;                          // more than 0: a uniform grid of every so many samples instead, uncut
};

}  // namespace relievo
